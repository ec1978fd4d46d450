#include "core/integration/repetition.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "core/integration/stacked_states.hpp"

namespace pleuel {

namespace {

/// What a term changes by in a period, relative to the most that it does.
constexpr double small_deviation = 1e-7;
constexpr double golden_share = 0.381966;
/// Instants that are looked at, at most.
constexpr int most_samples = 500, most_samples_of_derivatives = 16;

/// Forces and constraints of a term at a state.
struct TermSize {
  double forces = 0.0, constraints = 0.0;

  void include(const TermSize& other) {
    forces = std::max(forces, other.forces);
    constraints = std::max(constraints, other.constraints);
  }
};

/// What is compared: the residual of a term, or its derivatives by the design, a column each.
enum class Compared { residual, design_derivatives };

class RepetitionCheck {
 public:
  RepetitionCheck(Mechanism& mechanism, double period, Compared compared)
      : system_(*mechanism.system), period_(period), compared_(compared) {
    const auto columns = compared == Compared::residual
                             ? std::size_t{1}
                             : static_cast<std::size_t>(system_.variables());
    changes_.assign(system_.terms().size(), std::vector<TermSize>(columns));
    largest_ = changes_;
  }

  void see(State state, const Eigen::VectorXd& turns) {
    std::vector<Eigen::MatrixXd> before, loaded_before;
    for (const auto& term : system_.terms()) before.push_back(evaluate(*term, state));
    // What joints bear in no direction is round-off of what they bear in others.
    State loaded = state;
    if (loaded.lambda.size() > 0) loaded.lambda.setConstant(state.lambda.lpNorm<Eigen::Infinity>());
    for (const auto& term : system_.terms()) loaded_before.push_back(evaluate(*term, loaded));
    state.q += turns;
    state.time += period_;
    for (std::size_t i = 0; i < before.size(); ++i) {
      const Eigen::MatrixXd after = evaluate(*system_.terms()[i], state);
      for (std::size_t k = 0; k < changes_[i].size(); ++k) {
        changes_[i][k].include(size_of(after.col(k) - before[i].col(k)));
        largest_[i][k].include(size_of(before[i].col(k)));
        largest_[i][k].include(size_of(loaded_before[i].col(k)));
        largest_[i][k].include(size_of(after.col(k)));
      }
    }
  }

  /// The first term that does not repeat itself.
  const Term* find() const {
    for (std::size_t i = 0; i < changes_.size(); ++i) {
      for (std::size_t k = 0; k < changes_[i].size(); ++k) {
        if (!repeats(changes_[i][k], largest_[i][k])) return system_.terms()[i].get();
      }
    }
    return nullptr;
  }

  /// The columns that some term does not repeat.
  std::vector<int> unrepeated_columns() const {
    std::vector<int> columns;
    for (int k = 0; k < system_.variables(); ++k) {
      for (std::size_t i = 0; i < changes_.size(); ++i) {
        if (repeats(changes_[i][k], largest_[i][k])) continue;
        columns.push_back(k);
        break;
      }
    }
    return columns;
  }

 private:
  bool repeats(const TermSize& change, const TermSize& largest) const {
    const double constraints = compared_ == Compared::residual ? 1.0 : largest.constraints;
    return change.forces <= small_deviation * largest.forces &&
           change.constraints <= small_deviation * constraints;
  }

  Eigen::MatrixXd evaluate(Term& term, const State& state) const {
    if (compared_ == Compared::design_derivatives) {
      Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(system_.size(), system_.variables());
      term.add_design_derivative(state, ConstraintLevel::position, columns);
      return columns;
    }
    Eigen::VectorXd residual = Eigen::VectorXd::Zero(system_.size());
    term.add_residual(state, ConstraintLevel::position, residual);
    return residual;
  }
  TermSize size_of(const Eigen::VectorXd& residual) const {
    const auto largest = [](const auto& part) {
      return part.size() > 0 ? part.template lpNorm<Eigen::Infinity>() : 0.0;
    };
    return {largest(residual.head(system_.coordinates())),
            largest(residual.tail(system_.multipliers()))};
  }

  System& system_;
  double period_;
  Compared compared_;
  std::vector<std::vector<TermSize>> changes_, largest_;  ///< by term and column
};

/// Between the instants of a period, as laws may jump at them, and at no simple share of it, where
/// they may all be zero.
/// @param samples  at most
RepetitionCheck check_repetition(Mechanism& mechanism, const Trajectory& trajectory, int steps,
                                 double period, Compared compared, int samples) {
  RepetitionCheck check(mechanism, period, compared);
  const Eigen::VectorXd turns =
      whole_turns(mechanism.angles, trajectory.state_at(0).q, trajectory.state_at(steps).q);
  const int stride = 1 + steps / samples;
  for (int step = 1; step <= steps; step += stride) {
    State state = trajectory.state_at(step);
    state.time -= golden_share * trajectory.step_size(step);
    check.see(state, turns);
  }
  return check;
}

}  // namespace

std::string advice_to_be_exact(const Mechanism& mechanism, const Trajectory& trajectory) {
  constexpr double nearly = 1e-2, degree = std::numbers::pi / 180.0;
  const State start = trajectory.state_at(0), end = trajectory.state_at(trajectory.steps());
  const Eigen::VectorXd turns = whole_turns(mechanism.angles, start.q, end.q);
  for (const int angle : mechanism.angles) {
    const double turned = end.q(angle) - start.q(angle);
    if (turns(angle) == 0.0 || std::abs(turned - turns(angle)) > nearly) continue;
    return fmt::format(
        ". What turns goes through {:.9g} deg: if that is to be {:.9g}, write the period as a "
        "formula, as in \"= 1 rev/(900 rpm)\"",
        turned / degree, turns(angle) / degree);
  }
  return "";
}

std::string complaint_about_repetition(Mechanism& mechanism, const Trajectory& trajectory,
                                       double period) {
  const Term* term = check_repetition(mechanism, trajectory, trajectory.steps(), period,
                                      Compared::residual, most_samples)
                         .find();
  if (term == nullptr) return "";
  return fmt::format(
      "/simulation/initial_state: the motion cannot repeat itself after {:.9g} s: {} does not. "
      "Laws of time must repeat with the period, drives make whole turns in it "
      "(a constant speed of 2 pi over the period), and what counts turns act alike in each",
      period, term->name());
}

std::string complaint_about_repeated_derivatives(Mechanism& mechanism, const Trajectory& trajectory,
                                                 int steps, double period) {
  const Term* term = check_repetition(mechanism, trajectory, steps, period,
                                      Compared::design_derivatives, most_samples_of_derivatives)
                         .find();
  if (term == nullptr) return "";
  return fmt::format(
      "/simulation/initial_state: a motion that repeats itself after {:.6g} s has no derivatives: "
      "at other values of the design variables {} no longer repeats itself with this "
      "period. A speed, a frequency or a duration that sets the period cannot be a design variable",
      period, term->name());
}

std::vector<int> variables_of_unrepeated_derivatives(Mechanism& mechanism,
                                                     const Trajectory& trajectory, int steps,
                                                     double period) {
  return check_repetition(mechanism, trajectory, steps, period, Compared::design_derivatives,
                          most_samples_of_derivatives)
      .unrepeated_columns();
}

}  // namespace pleuel
