#include "sensitivity/initial_sensitivity.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/rotation_vector.hpp"
#include "core/integration/damped_start.hpp"
#include "core/integration/repetition.hpp"
#include "core/integration/step_differentiation.hpp"
#include "core/mechanism/linear_solver.hpp"
#include "core/mechanism/mechanism.hpp"
#include "core/scene/scene_rules.hpp"
#include "core/start/equilibrium.hpp"
#include "core/system/linear_forces.hpp"

namespace pleuel {

namespace {

class InitialDifferentiation {
 public:
  InitialDifferentiation(Mechanism& mechanism, const InitialState& initial)
      : mechanism_(mechanism),
        system_(*mechanism.system),
        initial_(initial),
        n_(system_.coordinates()),
        m_(system_.multipliers()),
        matrix_(system_.make_matrix()),
        solver_(matrix_, mechanism.elastic) {}

  StateSensitivity run() {
    if (initial_.is_equilibrium) {
      return of_equilibrium();
    }
    differentiate_positions();
    differentiate_velocities();
    differentiate_accelerations();
    sensitivity_.w = sensitivity_.a;
    return std::move(sensitivity_);
  }

 private:
  StateSensitivity of_equilibrium() {
    Equilibrium equilibrium(mechanism_);
    if (!jumps_at_start(mechanism_, initial_.state)) {
      auto z = equilibrium.differentiate(initial_);
      return {std::move(z.q), std::move(z.v), z.a, z.a, std::move(z.lambda)};
    }
    // Equilibrium before t = 0; accelerations after.
    InitialState settled = initial_;
    settled.state.time = just_before_start;
    settled = equilibrium.solve(std::move(settled));
    auto z = equilibrium.differentiate(settled);
    sensitivity_.q = std::move(z.q);
    sensitivity_.v = std::move(z.v);
    differentiate_accelerations();
    sensitivity_.w = sensitivity_.a;
    return std::move(sensitivity_);
  }

  /// The derivatives of Φ_qᵀ μ: (Φ_qᵀ μ)_q and (Φ_qᵀ μ)_x.
  struct Curvature {
    System::Matrix q;
    Eigen::MatrixXd x;
  };
  Curvature curvature(const State& state, const Eigen::VectorXd& multipliers) {
    LinearForces forces(system_);
    forces.set(state, multipliers);
    Curvature result{system_.make_matrix(), forces.design_derivative()};
    forces.tangent(result.q);
    const Eigen::Index of_multipliers = result.q.nonZeros() - result.q.outerIndexPtr()[n_];
    result.q.coeffs().tail(of_multipliers).setZero();
    return result;
  }

  /// W_x d, one column a design variable.
  Eigen::MatrixXd changed_weights(const Eigen::VectorXd& d) const {
    Eigen::MatrixXd forces = Eigen::MatrixXd::Zero(n_, system_.variables());
    for (const BentStart& bent : mechanism_.bent_starts) {
      const Eigen::Index size = bent.weight.cols();
      for (const auto& [variable, change] : bent.weight_x) {
        forces.col(variable).segment(bent.offset, size) += change * d.segment(bent.offset, size);
      }
    }
    return forces;
  }

  void solve(Eigen::MatrixXd& rhs) {
    if (!solver_.factorize(matrix_)) {
      throw SimulationError("the derivatives of the initial state are singular");
    }
    solver_.solve(rhs);
    if (!solver_.is_accurate()) {
      throw SimulationError(fmt::format(
          "the equations of the derivatives of the initial state are met to {:.1e} only",
          solver_.backward_error()));
    }
  }

  void differentiate_positions() {
    State state = initial_.state;
    state.v.setZero();
    state.a.setZero();
    const Curvature curved = curvature(state, initial_.position_multipliers);
    Eigen::MatrixXd rhs;
    system_.design_derivative(state, ConstraintLevel::position, rhs);
    rhs *= -1.0;
    // The pull is W d, d = q ⊖ guess: δd = T(d)⁻¹ δq − T(d)⁻ᵀ δ(guess).
    const Rotations& rotations = mechanism_.rotations;
    const Eigen::VectorXd d = difference(rotations, state.q, mechanism_.guess.q);
    Eigen::MatrixXd guess_x = mechanism_.guess_q_x;
    pull_back(rotations, d, guess_x);
    rhs.topRows(n_) =
        assembly_forces(mechanism_, guess_x) - changed_weights(d) - curved.x.topRows(n_);
    assembly_matrix(mechanism_, state, matrix_);
    for (int i : rotations) {
      const Eigen::Matrix3d pull = inverse_tangent_operator(d.segment<3>(i));
      for (int row = 0; row < 3; ++row) {
        for (int col = 0; col < 3; ++col) {
          matrix_.coeffRef(i + row, i + col) = mechanism_.assembly_weight(i + row) * pull(row, col);
        }
      }
    }
    matrix_ += curved.q;
    solve(rhs);
    sensitivity_.q = rhs.topRows(n_);
  }

  void differentiate_velocities() {
    State state = initial_.state;
    state.a.setZero();
    const Curvature curved = curvature(state, initial_.velocity_multipliers);
    Eigen::MatrixXd rhs;
    system_.design_derivative(state, ConstraintLevel::velocity, rhs);
    rhs.topRows(n_) = curved.x.topRows(n_) + (curved.q.leftCols(n_) * sensitivity_.q).topRows(n_) +
                      changed_weights(state.v - mechanism_.guess.v) -
                      assembly_forces(mechanism_, mechanism_.guess_v_x);
    system_.tangent(state, {.q = 1.0}, ConstraintLevel::velocity, matrix_);
    rhs.bottomRows(m_) += (matrix_.leftCols(n_) * sensitivity_.q).bottomRows(m_);
    rhs *= -1.0;
    assembly_matrix(mechanism_, state, matrix_);
    solve(rhs);
    sensitivity_.v = rhs.topRows(n_);
  }

  void differentiate_accelerations() {
    const State& state = initial_.state;
    Eigen::MatrixXd rhs;
    system_.design_derivative(state, ConstraintLevel::acceleration, rhs);
    system_.tangent(state, {.q = 1.0}, ConstraintLevel::acceleration, matrix_);
    rhs += matrix_.leftCols(n_) * sensitivity_.q;
    system_.tangent(state, {.v = 1.0}, ConstraintLevel::acceleration, matrix_);
    rhs += matrix_.leftCols(n_) * sensitivity_.v;
    rhs *= -1.0;
    system_.tangent(state, {.a = 1.0}, ConstraintLevel::acceleration, matrix_);
    solve(rhs);
    sensitivity_.a = rhs.topRows(n_);
    sensitivity_.lambda = rhs.bottomRows(m_);
  }

  Mechanism& mechanism_;
  System& system_;
  const InitialState& initial_;
  int n_, m_;
  System::Matrix matrix_;
  LinearSolver solver_;
  StateSensitivity sensitivity_;
};

/// Variables that change forces only, as the mass of a counterweight that a drive turns, have
/// derivatives of the motion that are round-off from end to end. Those of the size at which the
/// motion would change by this share of what the forces change count as such.
constexpr double next_to_nothing = 1e-6;

/// What is left of derivatives is compared with, one a variable.
/// @param end     of the states at the end of the period, stacked
/// @param lambda  of the multipliers there
Eigen::RowVectorXd compared_sizes(const Eigen::MatrixXd& end, const Eigen::MatrixXd& lambda,
                                  const Eigen::VectorXd& multipliers) {
  const Eigen::RowVectorXd sizes = sizes_of(end);
  const double forces = multipliers.lpNorm<Eigen::Infinity>();
  if (!(forces > 0.0)) return sizes;
  return sizes.cwiseMax(next_to_nothing / forces * sizes_of(lambda));
}

}  // namespace

StateSensitivity zero_sensitivity(const System& system, Eigen::Index columns) {
  const Eigen::MatrixXd zero = Eigen::MatrixXd::Zero(system.coordinates(), columns);
  return {zero, zero, zero, zero, Eigen::MatrixXd::Zero(system.multipliers(), columns)};
}

StateSensitivity initial_sensitivity(Mechanism& mechanism, const InitialState& initial) {
  return InitialDifferentiation(mechanism, initial).run();
}

StateSensitivity first_step_sensitivity(Mechanism& mechanism, const Trajectory& trajectory,
                                        const State& start, StateSensitivity initial) {
  DampedStart damped(mechanism, start, trajectory.scheme_of(1), trajectory.weight_of_jerk(1));
  auto derivatives = damped.differentiate(initial.q, initial.v, initial.a);
  initial.v = std::move(derivatives.v);
  initial.a = std::move(derivatives.a);
  initial.w = std::move(derivatives.w);
  return initial;
}

std::vector<std::string> unknown_derivatives(const ProblemFile& problem, const Design<double>& x) {
  std::vector<std::string> sentences;
  for (std::size_t i = 0; i < problem.variables.size(); ++i) {
    const DesignVariable& variable = problem.variables[i];
    if (variable.lower < variable.upper) continue;
    if (const auto moved = find_point_moved_along(problem.scene, x, i)) {
      sentences.push_back(fmt::format(
          "the derivatives with respect to \"{}\" are not those of the mechanism: it {}",
          variable.name, *moved));
    }
  }
  return sentences;
}

void require_repeated_derivatives(Mechanism& mechanism, const Trajectory& trajectory) {
  const PeriodicStart& periodic = *trajectory.periodic;
  const std::string complaint =
      complaint_about_repeated_derivatives(mechanism, trajectory, periodic.steps, periodic.period);
  if (!complaint.empty()) throw SimulationError(complaint);
}

StateSensitivity periodic_sensitivity(Mechanism& mechanism, const Trajectory& trajectory) {
  const PeriodicStart& periodic = *trajectory.periodic;
  require_repeated_derivatives(mechanism, trajectory);
  const StackedStates& states = periodic.map->states();
  StateSensitivity start = zero_sensitivity(*mechanism.system, mechanism.system->variables());
  StepDifferentiation motion(mechanism, trajectory, DerivativesOf::design);
  PeriodicCorrection progress;
  const State last = trajectory.state_at(periodic.steps);
  while (true) {
    motion.begin(start);
    while (motion.step() < periodic.steps) motion.advance();
    const Eigen::MatrixXd end = states.stack(motion.sensitivity()), gap = end - states.stack(start);
    start.lambda = motion.sensitivity().lambda;
    if (progress.is_done(gap, compared_sizes(end, start.lambda, last.lambda))) return start;
    const StateSensitivity step = states.unstack(progress.map(mechanism, trajectory).solve(gap));
    start.q += step.q;
    start.v += step.v;
    start.a += step.a;
    start.w += step.w;
  }
}

namespace {

constexpr double left_at_the_end = 1e-13;
/// What no longer shrinks is round-off below this.
constexpr double left_of_round_off = 1e-8;
constexpr int most_corrections = 30;

double largest_share(const Eigen::MatrixXd& left, const Eigen::RowVectorXd& sizes) {
  double largest = 0.0;
  for (Eigen::Index j = 0; j < left.cols(); ++j) {
    const double size = left.col(j).lpNorm<Eigen::Infinity>();
    if (size > 0.0) largest = std::max(largest, size / sizes(j));
  }
  return largest;
}

}  // namespace

bool PeriodicCorrection::is_done(const Eigen::MatrixXd& left, const Eigen::RowVectorXd& sizes) {
  const double share = largest_share(left, sizes);
  if (share <= left_at_the_end) return true;
  const bool shrinks = count_++ == 0 || share < 0.5 * before_;
  before_ = share;
  if (shrinks && count_ < most_corrections) return false;
  if (share <= left_of_round_off) return true;
  if (!needs_own_map_) {
    needs_own_map_ = true;
    count_ = 0;
    return false;
  }
  throw SimulationError(
      fmt::format("the derivatives of the motion that repeats itself do not converge: {:.1e} of "
                  "them is left after {} periods. Try a smaller /simulation/newton_tolerance, or "
                  "/sensitivity/method \"central-difference\"",
                  share, count_));
}

const PeriodMap& PeriodicCorrection::map(Mechanism& mechanism, const Trajectory& trajectory) {
  const PeriodicStart& periodic = *trajectory.periodic;
  if (!needs_own_map_) return *periodic.map;
  if (!own_map_) own_map_ = std::make_shared<PeriodMap>(mechanism, trajectory, periodic.steps);
  return *own_map_;
}

}  // namespace pleuel
