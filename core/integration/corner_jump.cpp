#include "core/integration/corner_jump.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.hpp"
#include "core/integration/damped_start.hpp"

namespace pleuel {

namespace {

constexpr auto of_accelerations = ConstraintLevel::acceleration;
/// Of the step: the jumps follow from accelerations of the constraints so far apart.
constexpr double corner_interval = 1e-4;
/// What an acceleration changes by within a step through a jump, beside what it changes by anyway, and
/// beside all accelerations (round-off): less is none.
constexpr double least_jump = 1e-3, least_share = 1e-9;

void clear_rows(const std::vector<int>& rows, Eigen::MatrixXd& matrix) {
  for (const int row : rows) matrix.row(row).setZero();
}

}  // namespace

CornerJump::CornerJump(const Mechanism& mechanism)
    : mechanism_(mechanism),
      system_(*mechanism.system),
      constraints_(system_),
      forces_(system_, of_accelerations),
      matrix_(system_.make_matrix()),
      rows_(matrix_),
      solver_(matrix_, mechanism.elastic) {}

CornerJump::TimeWeights CornerJump::weights_of_jerk() const {
  const double rate = 1.0 / interval_;
  return {rate, -rate, -rate, rate};
}

template <class Visit>
void CornerJump::at_each_time(const Visit& visit) {
  constexpr std::array sides = {-2.0, -1.0, 1.0, 2.0};
  const double corner = state_.time;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    state_.time = corner + sides[i] * interval_;
    visit(i);
  }
  state_.time = corner;
}

bool CornerJump::find(const State& state, double step) {
  const int n = system_.coordinates(), m = system_.multipliers();
  if (m == 0) return false;
  state_ = state;
  interval_ = corner_interval * step;
  Eigen::MatrixXd accelerations(m, 4);
  Eigen::VectorXd residual;
  at_each_time([&](std::size_t i) {
    constraints_.residual(state_, of_accelerations, residual);
    accelerations.col(static_cast<Eigen::Index>(i)) = residual.tail(m);
  });
  const auto combined = [&](const TimeWeights& weights) -> Eigen::VectorXd {
    return accelerations * Eigen::Map<const Eigen::Vector4d>(weights.data());
  };
  const Eigen::VectorXd of_acceleration = combined(weights_of_acceleration()),
                        of_jerk = combined(weights_of_jerk());
  const double share = 1.0 / corner_interval,  // of a step
      round_off = least_share *
                  (state.a.lpNorm<Eigen::Infinity>() + accelerations.lpNorm<Eigen::Infinity>());
  const Eigen::ArrayXd change = of_acceleration.array().abs() + step * of_jerk.array().abs(),
                       before = share * (accelerations.col(1) - accelerations.col(0)).array().abs(),
                       behind = share * (accelerations.col(3) - accelerations.col(2)).array().abs();
  if ((change <= least_jump * (before + behind) + round_off).all()) return false;
  held_ = stiffly_damped(mechanism_, state_, step);
  if (!factorize(held_) && !factorize(held_ = {})) {
    throw SimulationError("the equations at a corner of the motion are singular");
  }
  Eigen::MatrixXd rhs = Eigen::MatrixXd::Zero(n + m, 2);
  rhs.bottomRows(m) << -of_acceleration, -of_jerk;
  solver_.solve(rhs);
  jumps_ = {rhs.col(0).head(n), rhs.col(1).head(n)};
  multipliers_ = {rhs.col(0).tail(m), rhs.col(1).tail(m)};
  return true;
}

bool CornerJump::factorize(const std::vector<int>& held) {
  system_.tangent(state_, {.a = 1.0}, of_accelerations, matrix_);
  std::vector<bool> is_held(static_cast<std::size_t>(system_.size()), false);
  for (const int i : held) is_held[static_cast<std::size_t>(i)] = true;
  for (int k = 0; k < matrix_.outerSize() && !held.empty(); ++k) {
    for (System::Matrix::InnerIterator entry(matrix_, k); entry; ++entry) {
      const bool is_off = is_held[static_cast<std::size_t>(entry.row())] ||
                          is_held[static_cast<std::size_t>(entry.col())];
      if (is_off) entry.valueRef() = entry.row() == entry.col() ? 1.0 : 0.0;
    }
  }
  return solver_.factorize(matrix_);
}

// d depends on the state, too, where what a drive prescribes is multiplied with it (lengths).
Eigen::MatrixXd CornerJump::differentiate(const Eigen::VectorXd& jump,
                                          const Eigen::VectorXd& multipliers,
                                          const TimeWeights& weights, const StateSensitivity& state,
                                          DerivativesOf of) {
  const int n = system_.coordinates(), m = system_.multipliers();
  Eigen::MatrixXd rhs = Eigen::MatrixXd::Zero(n + m, state.q.cols()), columns;
  const bool is_of_design = of == DerivativesOf::design;
  at_each_time([&](std::size_t i) {
    const auto add = [&](const Weights& by, const Eigen::MatrixXd& change) {
      constraints_.tangent(state_, by, of_accelerations, rows_);
      rhs.bottomRows(m) -= weights[i] * (rows_.leftCols(n) * change).bottomRows(m);
    };
    add({.q = 1.0}, state.q);
    add({.v = 1.0}, state.v);
    add({.a = 1.0}, state.a);
    if (!is_of_design) return;
    constraints_.design_derivative(state_, of_accelerations, columns);
    rhs.bottomRows(m) -= weights[i] * columns.bottomRows(m);
  });
  forces_.set(state_, jump, multipliers);
  if (is_of_design) rhs -= forces_.design_derivative();
  forces_.tangent(rows_);
  rhs -= rows_.leftCols(n) * state.q;
  clear_rows(held_, rhs);
  solver_.solve(rhs);
  return rhs.topRows(n);
}

CornerJump::Jumps<Eigen::MatrixXd> CornerJump::differentiate(const StateSensitivity& state,
                                                             DerivativesOf of) {
  return {differentiate(jumps_.acceleration, multipliers_.acceleration, weights_of_acceleration(),
                        state, of),
          differentiate(jumps_.jerk, multipliers_.jerk, weights_of_jerk(), state, of)};
}

void CornerJump::differentiate_transposed(const Eigen::VectorXd& jump,
                                          const Eigen::VectorXd& multipliers,
                                          const TimeWeights& weights, const Eigen::MatrixXd& jumps,
                                          Adjoint adjoint) {
  const int n = system_.coordinates(), m = system_.multipliers();
  Eigen::MatrixXd mu = Eigen::MatrixXd::Zero(n + m, jumps.cols());
  mu.topRows(n) = -jumps;
  clear_rows(held_, mu);
  solver_.solve_transposed(mu);
  clear_rows(held_, mu);
  forces_.set(state_, jump, multipliers);
  forces_.tangent(rows_);
  adjoint.q += rows_.leftCols(n).transpose() * mu;
  forces_.add_parameter_adjoints(mu, adjoint.sums);
  Eigen::MatrixXd constraints = Eigen::MatrixXd::Zero(n + m, jumps.cols());
  at_each_time([&](std::size_t i) {
    constraints.bottomRows(m) = weights[i] * mu.bottomRows(m);
    const auto add = [&](const Weights& by, Columns& sum) {
      constraints_.tangent(state_, by, of_accelerations, rows_);
      sum += rows_.leftCols(n).transpose() * constraints;
    };
    add({.q = 1.0}, adjoint.q);
    add({.v = 1.0}, adjoint.v);
    add({.a = 1.0}, adjoint.a);
    constraints_.add_parameter_adjoints(state_, of_accelerations, constraints, adjoint.sums);
  });
}

void CornerJump::differentiate_transposed(const Jumps<Eigen::MatrixXd>& jumps, Adjoint adjoint) {
  differentiate_transposed(jumps_.acceleration, multipliers_.acceleration,
                           weights_of_acceleration(), jumps.acceleration, adjoint);
  differentiate_transposed(jumps_.jerk, multipliers_.jerk, weights_of_jerk(), jumps.jerk, adjoint);
}

}  // namespace pleuel
