#include "core/integration/repetition.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/integration/stacked_states.hpp"

namespace pleuel {

namespace {

/// What a term changes by in a period, relative to the most that it does.
constexpr double small_deviation = 1e-7;
/// Instants that are looked at, at most.
constexpr int most_samples = 500;

/// Forces and constraints of a term at a state.
struct Share {
  double forces = 0.0, constraints = 0.0;

  void include(const Share& other) {
    forces = std::max(forces, other.forces);
    constraints = std::max(constraints, other.constraints);
  }
};

class RepetitionCheck {
 public:
  RepetitionCheck(Mechanism& mechanism, double period)
      : system_(*mechanism.system), period_(period), changes_(system_.terms().size()) {
    largest_ = changes_;
  }

  void see(State state, const Eigen::VectorXd& turns) {
    std::vector<Eigen::VectorXd> before;
    for (const auto& term : system_.terms()) before.push_back(evaluate(*term, state));
    state.q += turns;
    state.time += period_;
    for (std::size_t i = 0; i < before.size(); ++i) {
      const Eigen::VectorXd after = evaluate(*system_.terms()[i], state);
      changes_[i].include(size_of(after - before[i]));
      largest_[i].include(size_of(before[i]));
      largest_[i].include(size_of(after));
    }
  }

  std::string complaint() const {
    for (std::size_t i = 0; i < changes_.size(); ++i) {
      const bool repeats = changes_[i].forces <= small_deviation * largest_[i].forces &&
                           changes_[i].constraints <= small_deviation;
      if (repeats) continue;
      return fmt::format(
          "the motion cannot repeat itself after {:.6g} s, as /simulation/initial_state asks for: "
          "{} does not. Laws of time must repeat with the period, drives make whole turns in it "
          "(a constant speed of 2 pi over the period), and what counts turns act alike in each",
          period_, system_.terms()[i]->name());
    }
    return "";
  }

 private:
  Eigen::VectorXd evaluate(Term& term, const State& state) const {
    Eigen::VectorXd residual = Eigen::VectorXd::Zero(system_.size());
    term.add_residual(state, ConstraintLevel::position, residual);
    return residual;
  }
  Share size_of(const Eigen::VectorXd& residual) const {
    const auto largest = [](const auto& part) {
      return part.size() > 0 ? part.template lpNorm<Eigen::Infinity>() : 0.0;
    };
    return {largest(residual.head(system_.coordinates())),
            largest(residual.tail(system_.multipliers()))};
  }

  System& system_;
  double period_;
  std::vector<Share> changes_, largest_;
};

}  // namespace

std::string complaint_about_repetition(Mechanism& mechanism, const Trajectory& trajectory,
                                       double period) {
  RepetitionCheck check(mechanism, period);
  State state, end;
  trajectory.states->load(0, state);
  trajectory.states->load(trajectory.steps(), end);
  const Eigen::VectorXd turns = whole_turns(mechanism.angles, state.q, end.q);
  const int stride = 1 + trajectory.steps() / most_samples;
  for (int step = 1; step <= trajectory.steps(); step += stride) {
    trajectory.states->load(step, state);
    state.time -= 0.5 * trajectory.step_size(step);  // laws may jump at instants
    check.see(state, turns);
  }
  return check.complaint();
}

}  // namespace pleuel
