#include "core/trust/sudden_jumps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include "core/base/eager_matrices.hpp"
#include "core/integration/period_map.hpp"

namespace pleuel {

namespace {

/// What is shortly before and behind a jump, in steps.
constexpr double shortly = 1e-6;
/// Few jumps; and of a window at least so many.
constexpr std::size_t few = 16, least_of_window = 2;
/// What a jump before a window counts shortly one within it.
constexpr double earlier_weight = 0.5;
/// A jump that changes at least this share of the largest change of a force is one of that force.
constexpr double similar_share = 0.5;

class JumpFinder {
 public:
  explicit JumpFinder(const Analysis& analysis)
      : system_(*analysis.model.mechanism.system), trajectory_(analysis.trajectory) {}

  /// The first instant: nothing is accelerated yet, and nothing holds.
  SuddenJump start() const {
    State state = trajectory_.state_at(0);
    state.time += shortly * step_behind(0);
    state.a.setZero();
    state.lambda.setZero();
    return {0, state, state, residual(state)};
  }

  /// Between the end of a motion that repeats itself and its beginning.
  SuddenJump seam() const {
    const State at = trajectory_.state_at(0);
    return jump_of(0, at, at, trajectory_.time(trajectory_.steps()), at.time);
  }

  SuddenJump jump_at(int step) const {
    const State before = trajectory_.state_at(step - 1), at = trajectory_.state_at(step);
    return jump_of(step, before, at, at.time, at.time);
  }

 private:
  double step_behind(int step) const { return trajectory_.time(step + 1) - trajectory_.time(step); }

  /// @param end, begin  the same instant, as one before and one behind it
  SuddenJump jump_of(int step, const State& before, State at, double end, double begin) const {
    const double close = shortly * step_behind(step);
    at.time = end - close;
    const Eigen::VectorXd sooner = residual(at);
    at.time = begin + close;
    return {step, before, at, residual(at) - sooner};
  }

  Eigen::VectorXd residual(const State& state) const {
    Eigen::VectorXd residual;
    system_.residual(state, ConstraintLevel::acceleration, residual);
    return residual;
  }

  System& system_;
  const Trajectory& trajectory_;
};

/// What a jump changes of each equation, of the largest change.
Eigen::ArrayXd shares_of(const SuddenJump& jump, const Eigen::ArrayXd& largest) {
  return (largest > 0.0)
      .select(jump.change.array().abs() / largest, Eigen::ArrayXd::Zero(largest.size()));
}

/// Those that change a force by the most, each force in turn; of equal ones the latest.
std::set<std::size_t> different_jumps_of(const std::vector<SuddenJump>& jumps,
                                         const Eigen::ArrayXd& largest, const StepRange& window,
                                         std::size_t count) {
  Eigen::ArrayXd times = Eigen::ArrayXd::Ones(largest.size());
  std::set<std::size_t> chosen;
  while (chosen.size() < count) {
    std::optional<std::size_t> best;
    double most = 0.0;
    for (std::size_t i = 0; i < jumps.size() && jumps[i].step < window.last; ++i) {
      if (chosen.contains(i)) continue;
      const double weight = jumps[i].step < window.first ? earlier_weight : 1.0;
      const double score = weight * (shares_of(jumps[i], largest) / times).maxCoeff();
      if (score < most) continue;
      best = i;
      most = score;
    }
    if (!best) break;
    times += (shares_of(jumps[*best], largest) >= similar_share).cast<double>();
    chosen.insert(*best);
  }
  return chosen;
}

}  // namespace

std::vector<SuddenJump> sudden_jumps(const Analysis& analysis) {
  const JumpFinder finder(analysis);
  const BrokenInstants& breaks = analysis.breaks;
  std::vector<SuddenJump> jumps = {analysis.trajectory.periodic ? finder.seam() : finder.start()};
  for (int step = 1; step < analysis.trajectory.steps(); ++step) {
    if (!breaks.empty() && breaks[step]) jumps.push_back(finder.jump_at(step));
  }
  std::erase_if(jumps, [](const SuddenJump& jump) { return jump.change.isZero(0.0); });
  return jumps;
}

std::vector<SuddenJump> different_jumps(std::vector<SuddenJump> jumps,
                                        const std::vector<StepRange>& windows) {
  if (jumps.size() <= few || windows.empty()) return jumps;
  std::set<std::pair<int, int>> different;
  for (const StepRange& window : windows) different.insert({window.first, window.last});
  Eigen::ArrayXd largest = Eigen::ArrayXd::Zero(jumps.front().change.size());
  for (const SuddenJump& jump : jumps) largest = largest.max(jump.change.array().abs());
  std::set<std::size_t> chosen;
  for (const auto& [first, last] : different) {
    chosen.merge(different_jumps_of(jumps, largest, {first, last},
                                    std::max(least_of_window, few / different.size())));
  }
  std::vector<SuddenJump> those;
  for (const std::size_t i : chosen) those.push_back(std::move(jumps[i]));
  return those;
}

namespace {

/// From one step to the next. Where they change by more than 30 %, the scheme takes up the motion
/// anew.
constexpr double growth_of_steps = 0.25;
/// Of a number of steps.
constexpr double round_off_of_parts = 1e-6;

/// @param last  the step that ends there
double wanted_step(const std::vector<ShorterSteps>& stretches, double time, double last) {
  double step = std::numeric_limits<double>::infinity();
  for (const ShorterSteps& one : stretches) {
    if (time < one.begin) continue;
    step = std::min(step, one.step + growth_of_steps * std::max(0.0, time - one.end));
  }
  return std::isinf(step) ? step : std::min(step, (1.0 + growth_of_steps) * last);
}

int instant_of(const Trajectory& trajectory, double time) {
  const Eigen::VectorXd& all = trajectory.time;
  if (time == all(0) && trajectory.periodic) return trajectory.periodic->steps;
  return static_cast<int>(std::ranges::lower_bound(all, time) - all.begin());
}

/// Those of the trajectory, and one shortly before each jump.
std::vector<double> fixed_instants(const Trajectory& trajectory,
                                   const std::vector<ShorterSteps>& stretches) {
  std::vector<double> instants(trajectory.time.begin(), trajectory.time.end());
  for (const ShorterSteps& one : stretches) {
    const int at = instant_of(trajectory, one.begin);
    if (at == 0) continue;
    const double step = trajectory.time(at) - trajectory.time(at - 1);
    instants.push_back(trajectory.time(at) - std::min(one.step, 0.5 * step));
  }
  std::ranges::sort(instants);
  return instants;
}

}  // namespace

std::vector<double> instants_with(const Trajectory& trajectory,
                                  const std::vector<ShorterSteps>& stretches) {
  const std::vector<double> fixed = fixed_instants(trajectory, stretches);
  std::vector<double> instants = {fixed.front()};
  double last = std::numeric_limits<double>::infinity();
  for (const double end : fixed) {
    while (instants.back() < end) {
      const double begin = instants.back(), left = end - begin;
      const double parts =
          std::ceil(left / wanted_step(stretches, begin, last) - round_off_of_parts);
      instants.push_back(parts <= 1.0 ? end : begin + left / parts);
      last = instants.back() - begin;
    }
  }
  return instants;
}

}  // namespace pleuel
