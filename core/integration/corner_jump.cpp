#include "core/integration/corner_jump.hpp"

#include <algorithm>

#include "core/base/error.hpp"

namespace pleuel {

namespace {

constexpr auto of_accelerations = ConstraintLevel::acceleration;
/// Of the step: the jumps follow from accelerations of the constraints so far apart.
constexpr double corner_interval = 1e-3;
/// What the acceleration changes by within a step through a jump, beside what it changes by anyway,
/// and beside itself: less is none.
constexpr double least_jump = 1e-2, least_share = 1e-10;

}  // namespace

CornerJump::CornerJump(const Mechanism& mechanism)
    : system_(*mechanism.system),
      forces_(system_, of_accelerations),
      matrix_(system_.make_matrix()),
      forces_q_(matrix_),
      solver_(matrix_, mechanism.elastic) {}

CornerJump::Weights CornerJump::weights_of_jerk() const {
  const double rate = 1.0 / interval_;
  return {rate, -rate, -rate, rate};
}

template <class Add>
void CornerJump::for_each_part(const Weights& weights, const Add& add) const {
  constexpr std::array sides = {-2.0, -1.0, 1.0, 2.0};
  for (std::size_t i = 0; i < sides.size(); ++i) {
    State state = state_;
    state.time += sides[i] * interval_;
    add(state, weights[i]);
  }
}

bool CornerJump::find(const State& state, double step) {
  const int n = system_.coordinates(), m = system_.multipliers();
  if (m == 0) return false;
  state_ = state;
  interval_ = corner_interval * step;
  const auto combined = [&](const Weights& weights) {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(m), residual;
    for_each_part(weights, [&](const State& at, double weight) {
      system_.residual(at, of_accelerations, residual);
      sum += weight * residual.tail(m);
    });
    return sum;
  };
  const auto largest = [](const Eigen::VectorXd& of) { return of.lpNorm<Eigen::Infinity>(); };
  const double rate = 1.0 / interval_;
  const Eigen::VectorXd of_acceleration = combined(weights_of_acceleration()),
                        of_jerk = combined(weights_of_jerk());
  const double before = largest(combined({-rate, rate, 0.0, 0.0})),
               behind = largest(combined({0.0, 0.0, -rate, rate})),
               acceleration = largest(combined({0.0, 1.0, 0.0, 0.0}));
  const double change = largest(of_acceleration) + step * largest(of_jerk);
  if (!(change > least_jump * step * (before + behind) + least_share * acceleration)) return false;
  system_.tangent(state_, {.a = 1.0}, of_accelerations, matrix_);
  if (!solver_.factorize(matrix_)) {
    throw SimulationError("the equations at a corner of the motion are singular");
  }
  Eigen::MatrixXd rhs = Eigen::MatrixXd::Zero(n + m, 2);
  rhs.bottomRows(m) << -of_acceleration, -of_jerk;
  solver_.solve(rhs);
  jumps_ = {rhs.col(0).head(n), rhs.col(1).head(n)};
  multipliers_ = {rhs.col(0).tail(m), rhs.col(1).tail(m)};
  return true;
}

Eigen::MatrixXd CornerJump::differentiate(const Eigen::VectorXd& jump,
                                          const Eigen::VectorXd& multipliers,
                                          const Weights& weights, const Eigen::MatrixXd& q,
                                          DerivativesOf of) {
  const int n = system_.coordinates(), m = system_.multipliers();
  Eigen::MatrixXd rhs = Eigen::MatrixXd::Zero(n + m, q.cols()), columns;
  forces_.set(state_, jump, multipliers);
  if (of == DerivativesOf::design) {
    for_each_part(weights, [&](const State& state, double weight) {
      system_.design_derivative(state, of_accelerations, columns);
      rhs.bottomRows(m) -= weight * columns.bottomRows(m);
    });
    rhs -= forces_.design_derivative();
  }
  forces_.tangent(forces_q_);
  rhs -= forces_q_.leftCols(n) * q;
  solver_.solve(rhs);
  return rhs.topRows(n);
}

CornerJump::Jumps<Eigen::MatrixXd> CornerJump::differentiate(const Eigen::MatrixXd& q,
                                                             DerivativesOf of) {
  return {differentiate(jumps_.acceleration, multipliers_.acceleration, weights_of_acceleration(),
                        q, of),
          differentiate(jumps_.jerk, multipliers_.jerk, weights_of_jerk(), q, of)};
}

void CornerJump::differentiate_transposed(const Eigen::VectorXd& jump,
                                          const Eigen::VectorXd& multipliers,
                                          const Weights& weights, const Eigen::MatrixXd& adjoint,
                                          Columns q, Columns sums) {
  const int n = system_.coordinates(), m = system_.multipliers();
  Eigen::MatrixXd mu = Eigen::MatrixXd::Zero(n + m, adjoint.cols());
  mu.topRows(n) = -adjoint;
  solver_.solve_transposed(mu);
  forces_.set(state_, jump, multipliers);
  forces_.tangent(forces_q_);
  q += forces_q_.leftCols(n).transpose() * mu;
  forces_.add_parameter_adjoints(mu, sums);
  Eigen::MatrixXd constraints = Eigen::MatrixXd::Zero(n + m, adjoint.cols());
  for_each_part(weights, [&](const State& state, double weight) {
    constraints.bottomRows(m) = weight * mu.bottomRows(m);
    system_.add_parameter_adjoints(state, of_accelerations, constraints, sums);
  });
}

void CornerJump::differentiate_transposed(const Jumps<Eigen::MatrixXd>& jumps, Columns q,
                                          Columns sums) {
  differentiate_transposed(jumps_.acceleration, multipliers_.acceleration,
                           weights_of_acceleration(), jumps.acceleration, q, sums);
  differentiate_transposed(jumps_.jerk, multipliers_.jerk, weights_of_jerk(), jumps.jerk, q, sums);
}

}  // namespace pleuel
