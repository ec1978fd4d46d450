#include "core/integration/damped_start.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/base/error.hpp"
#include "core/integration/newton_corrector.hpp"
#include "core/mechanism/linear_solver.hpp"
#include "core/mechanism/mechanism.hpp"
#include "core/system/linear_forces.hpp"

namespace pleuel {

namespace {

/// The part j of the jerk q⃛ at initial values that the constraints prescribe,
///     M j + Φ_qᵀ μ = 0,   Φ_q j + D = 0
/// with D what the motion makes of Φ̈ while a stays as it is, by a difference over an interval τ:
///     D = (Φ̈(q ⊕ τv, v + τa, a, t + τ) − Φ̈(q, v, a, t)) / τ
/// As q⁺ errs by c h³ q⃛ in a step, Φ(q⁺) = 0 of index 3 keeps the velocities off the other
/// constraints by −c h² j all the time, so that they have to start there for multipliers without a
/// transient of O(h) (Arnold, Brüls & Cardona 2015). Motion along the constraints is left as it is.
class ConstrainedJerk {
 public:
  /// @param step  of the scheme [s]; τ is a thousandth of it
  /// @throws SimulationError if the equations are singular
  ConstrainedJerk(Mechanism& mechanism, const State& start, double step);

  /// j, n entries.
  const Eigen::VectorXd& value() const { return value_; }

  /// ∂j/∂x, n × variables, from the derivatives of q, v, a of the start.
  Eigen::MatrixXd differentiate(const Eigen::MatrixXd& q, const Eigen::MatrixXd& v,
                                const Eigen::MatrixXd& a) const;

 private:
  State moved() const;
  void solve(Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>> rhs) const;

  Mechanism& mechanism_;
  System& system_;
  State start_;
  double interval_;
  Eigen::VectorXd value_, multipliers_;
};

constexpr auto level = ConstraintLevel::acceleration;
/// D errs by O(τ) with the squares of accelerations, which are large where members start to ring.
constexpr double interval_share = 1e-3;

ConstrainedJerk::ConstrainedJerk(Mechanism& mechanism, const State& start, double step)
    : mechanism_(mechanism),
      system_(*mechanism.system),
      start_(start),
      interval_(step * interval_share) {
  const int n = system_.coordinates(), m = system_.multipliers();
  Eigen::VectorXd before, after;
  system_.residual(start_, level, before);
  system_.residual(moved(), level, after);
  Eigen::MatrixXd rhs = Eigen::MatrixXd::Zero(n + m, 1);
  rhs.bottomRows(m) = (before - after).tail(m) / interval_;
  solve(rhs);
  value_ = rhs.topRows(n);
  multipliers_ = rhs.bottomRows(m);
}

/// A little later.
State ConstrainedJerk::moved() const {
  State moved = start_;
  moved.time += interval_;
  advance(mechanism_.rotations, start_.q, interval_ * start_.v, moved.q);
  moved.v += interval_ * start_.a;
  return moved;
}

void ConstrainedJerk::solve(Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>> rhs) const {
  System::Matrix matrix = system_.make_matrix();
  system_.tangent(start_, {.a = 1.0}, level, matrix);
  LinearSolver solver(matrix, mechanism_.elastic);
  if (!solver.factorize(matrix)) {
    throw SimulationError("the equations of the start are singular");
  }
  solver.solve(rhs);
}

Eigen::MatrixXd ConstrainedJerk::differentiate(const Eigen::MatrixXd& q, const Eigen::MatrixXd& v,
                                               const Eigen::MatrixXd& a) const {
  const int n = system_.coordinates(), m = system_.multipliers();
  System::Matrix matrix = system_.make_matrix();
  Eigen::MatrixXd rhs = Eigen::MatrixXd::Zero(n + m, system_.variables()), columns;

  // Dx
  const State later = moved();
  const Eigen::VectorXd increment = interval_ * start_.v;
  Eigen::MatrixXd later_q = q;
  pull_back(mechanism_.rotations, increment, later_q);
  later_q += interval_ * v;
  push_forward(mechanism_.rotations, increment, later_q);
  system_.design_derivative(later, level, columns);
  system_.tangent(later, {.q = 1.0}, level, matrix);
  columns += matrix.leftCols(n) * later_q;
  system_.tangent(later, {.v = 1.0}, level, matrix);
  columns += matrix.leftCols(n) * (v + interval_ * a);
  system_.tangent(later, {.a = 1.0}, level, matrix);
  columns += matrix.leftCols(n) * a;
  rhs.bottomRows(m) = columns.bottomRows(m) / -interval_;
  system_.design_derivative(start_, level, columns);
  system_.tangent(start_, {.q = 1.0}, level, matrix);
  columns += matrix.leftCols(n) * q;
  system_.tangent(start_, {.v = 1.0}, level, matrix);
  columns += matrix.leftCols(n) * v;
  system_.tangent(start_, {.a = 1.0}, level, matrix);
  columns += matrix.leftCols(n) * a;
  rhs.bottomRows(m) += columns.bottomRows(m) / interval_;

  // The change of M j + Φ_qᵀ μ and Φ_q j
  LinearForces forces(system_, level);
  forces.set(start_, value_, multipliers_);
  forces.tangent(matrix);
  rhs -= forces.design_derivative();
  rhs -= matrix.leftCols(n) * q;
  solve(rhs);
  return rhs.topRows(n);
}

/// Of the probes: to round-off.
constexpr double correction_tolerance = 1e-15;
/// Probes that do not converge are made so often half as long.
constexpr int max_halvings = 6;
/// Probes agree with the acceleration of the start up to this share of the largest one.
constexpr double resolved = 0.1;
/// h d/m from which on a start forgets its acceleration well within a step. Below it a₀ serves: the
/// balance of energy keeps its order in all samples; a torque that rang by 8 % had more.
constexpr double stiff = 1000.0;
/// Of the first step: loads may jump at its end.
constexpr double just_before_the_end = 1.0 - 1e-9;

constexpr Formulation on_acceleration_level{ConstraintForm::index_1, 0.0, false};

/// Whether a scheme makes anything of old accelerations.
bool uses_accelerations(const Scheme& scheme) {
  return !scheme.history.rightCols(2).isZero(0.0);
}

}  // namespace

std::vector<int> stiffly_damped(const Mechanism& mechanism, const State& state, double step) {
  System& system = *mechanism.system;
  System::Matrix mass = system.make_matrix(), damping = system.make_matrix();
  system.tangent(state, {.a = 1.0}, ConstraintLevel::acceleration, mass);
  system.tangent(state, {.v = 1.0}, ConstraintLevel::acceleration, damping);
  std::vector<int> all;
  std::ranges::copy_if(mechanism.elastic, std::back_inserter(all), [&](int i) {
    return step * damping.coeff(i, i) > stiff * mass.coeff(i, i);
  });
  return all;
}

DampedStart::DampedStart(Mechanism& mechanism, const State& start, const Scheme& first_step,
                         double weight_of_jerk)
    : mechanism_(mechanism),
      start_(start),
      step_(first_step.step),
      delay_(first_step.delay),
      weight_of_jerk_(weight_of_jerk),
      is_needed_(uses_accelerations(first_step)),
      v_(start.v),
      a_(start.a),
      w_(start.a) {
  if (!is_needed_) return;
  if (stiffly_damped(mechanism_, start_, step_).empty()) {
    set_exact();
    return;
  }
  double step = first_step.step * just_before_the_end;
  for (int halvings = 0;; ++halvings, step *= 0.5) {
    probes_[0].step = 0.5 * step;
    probes_[1].step = step;
    if (make_probe(probes_[0]) && make_probe(probes_[1])) break;
    if (halvings == max_halvings) {
      throw SimulationError(
          "the first step is too long: the equations of motion cannot be solved within it. Try a "
          "smaller /simulation/step");
    }
  }
  const auto at = [this](double time) -> Eigen::VectorXd {
    const auto [first, second] = weights_at(time);
    return first * probes_[0].state.a + second * probes_[1].state.a;
  };
  a_ = at(0.0);
  if (is_resolved(a_)) {
    set_exact();
    return;
  }
  w_ = at(delay_);
  if (weight_of_jerk_ == 0.0) return;
  State filtered = start_;
  filtered.a = a_;
  v_ += weight_of_jerk_ * ConstrainedJerk(mechanism_, filtered, step_).value();
}

bool DampedStart::is_resolved(const Eigen::VectorXd& found) const {
  const auto size = [this](const Eigen::VectorXd& a) {
    return a.cwiseQuotient(mechanism_.scale).lpNorm<Eigen::Infinity>();
  };
  return size(found - start_.a) <= resolved * std::max(size(start_.a), size(probes_[1].state.a));
}

void DampedStart::set_exact() {
  is_exact_ = true;
  a_ = w_ = start_.a;
  if (mechanism_.system->multipliers() == 0) return;
  const Eigen::VectorXd jerk = ConstrainedJerk(mechanism_, start_, step_).value();
  v_ += weight_of_jerk_ * jerk;
  w_ += delay_ * jerk;
}

std::array<double, 2> DampedStart::weights_at(double time) const {
  const double width = probes_[1].step - probes_[0].step;
  return {(probes_[1].step - time) / width, (time - probes_[0].step) / width};
}

bool DampedStart::make_probe(Probe& probe) {
  StepEquations equations(mechanism_, implicit_euler(probe.step), on_acceleration_level);
  equations.begin(start_);
  StepState& state = probe.state = equations.make_state(start_);
  state.time = start_.time + probe.step;
  state.a.setZero();
  state.increment = probe.step * start_.v;
  equations.apply(Eigen::VectorXd::Zero(equations.size()), state);
  TimeIntegration options;
  options.newton_tolerance = correction_tolerance;
  NewtonCorrector newton(mechanism_, equations, options);
  return !newton.correct(equations, state, NewtonCorrector::Trust::none);
}

Eigen::MatrixXd DampedStart::differentiate(const Probe& probe, const Eigen::MatrixXd& q,
                                           const Eigen::MatrixXd& v) {
  const double h = probe.step;
  StepEquations equations(mechanism_, implicit_euler(h), on_acceleration_level);
  equations.begin(start_);
  System::Matrix matrix = equations.make_matrix();
  equations.linearize_sensitivities(probe.state, matrix);
  // Unknown is the derivative s of the new q, turned back: v⁺ and a⁺ follow from it by
  // v⁺ = (q⁺ − q)/h, a⁺ = (v⁺ − v)/h.
  Eigen::MatrixXd old_q = q, rhs;
  pull_back(mechanism_.rotations, probe.state.increment, old_q);
  const Eigen::MatrixXd of_v = -old_q / h, of_a = (of_v - v) / h;
  equations.differentiate(probe.state, of_v, of_a, q, rhs);
  LinearSolver solver(matrix, mechanism_.elastic);
  if (!solver.factorize(matrix)) {
    throw SimulationError("the derivatives of the first step's start are singular");
  }
  solver.solve(rhs);
  if (!solver.is_accurate()) {
    throw SimulationError("the derivatives of the first step's start are inaccurate");
  }
  return of_a + rhs.topRows(mechanism_.system->coordinates()) / (h * h);
}

DampedStart::Derivatives DampedStart::differentiate(const Eigen::MatrixXd& q,
                                                    const Eigen::MatrixXd& v,
                                                    const Eigen::MatrixXd& a) {
  if (!is_needed_ || (is_exact_ && mechanism_.system->multipliers() == 0)) return {v, a, a};
  if (is_exact_) {
    const Eigen::MatrixXd jerk = ConstrainedJerk(mechanism_, start_, step_).differentiate(q, v, a);
    return {v + weight_of_jerk_ * jerk, a, a + delay_ * jerk};
  }
  const Eigen::MatrixXd one = differentiate(probes_[0], q, v),
                        other = differentiate(probes_[1], q, v);
  const auto at = [&](double time) -> Eigen::MatrixXd {
    const auto [first, second] = weights_at(time);
    return first * one + second * other;
  };
  Derivatives derivatives{v, at(0.0), at(delay_)};
  if (weight_of_jerk_ == 0.0) return derivatives;
  State filtered = start_;
  filtered.a = a_;
  const ConstrainedJerk jerk(mechanism_, filtered, step_);
  derivatives.v += weight_of_jerk_ * jerk.differentiate(q, v, derivatives.a);
  return derivatives;
}

}  // namespace pleuel
