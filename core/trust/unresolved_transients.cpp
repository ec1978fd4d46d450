#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/number_text.hpp"
#include "core/integration/fast_vibration.hpp"
#include "core/response/fatigue.hpp"
#include "core/trust/check_list.hpp"
#include "core/trust/refined_runs.hpp"
#include "core/trust/round_off.hpp"
#include "core/trust/sudden_jumps.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

namespace {

/// Share of a history that may be unseen.
constexpr double small_missing_share = 0.1;
/// Angular frequency from which on a mode is fast, times the step: three steps a period.
constexpr double fast_angle = 2.0;
/// Steps behind a jump of which the longest counts: some may end early, where something else
/// begins.
constexpr int steps_behind_a_jump = 3;
/// Steps a period that see a peak; and, where there is no room for more, that see most of it.
constexpr double good_steps = 20.0, fair_steps = 12.0;
/// A transient is followed for so many of its longest periods, with so many samples of its shortest.
constexpr double followed_periods = 1.5, samples_of_period = 12.0;
constexpr int most_samples = 80;
/// The transients are simulated with so many more steps at most, or as many as the run has: fewer of
/// large mechanisms, by their coordinates.
constexpr int coordinates_in_steps = 60000, least_more_steps = 200, enough_more_steps = 2000;

/// A jump whose transient may be unseen, as it would be without damping.
struct JumpTransient {
  int step;                           ///< where
  double share = 0.0;                 ///< what is missing, of the largest of all
  double until = 0.0;                 ///< as long as it matters behind the jump [s]
  double main = 0.0, shortest = 0.0;  ///< periods [s]
  struct Predicted {
    double share = 0.0, factor = 1.0;
  };
  std::map<std::size_t, Predicted> predicted = {};  ///< of each response that misses some
  bool is_simulated = false;                        ///< with short steps
};

/// What the steps leave unseen of a response.
struct MissedPeak {
  std::size_t response;
  double factor;  ///< by which its number would be larger
  double share;   ///< what is missing, of the largest of all
  JumpTransient suspect;
  bool is_predicted;  ///< as if nothing damped it; else of a run with short steps there
};

class UnresolvedTransients {
 public:
  explicit UnresolvedTransients(const TrustedRun& run)
      : run_(run), mechanism_(run.analysis.model.mechanism), trajectory_(run.analysis.trajectory) {
    for (const std::size_t i : asked_parts(run.problem)) {
      if (is_judged(run.analysis.responses[i])) judged_.push_back(i);
    }
  }

  /// The worst first.
  std::vector<MissedPeak> find() {
    if (judged_.empty() || (mechanism_.elastic.empty() && mechanism_.springs.empty())) return {};
    std::vector<StepRange> windows;
    for (const std::size_t i : judged_) windows.push_back(window(i));
    for (const SuddenJump& jump : different_jumps(sudden_jumps(run_.analysis), windows)) {
      look_at(jump);
    }
    if (suspects_.empty()) return {};
    std::ranges::stable_sort(suspects_, [](const JumpTransient& a, const JumpTransient& b) {
      return a.share > b.share;
    });
    const std::optional<RefinedRun> fine = simulate_transients();
    if (fine) run_.shared->with_short_steps = fine->values;
    const std::vector<bool> is_round_off = find_round_off(run_);
    std::vector<MissedPeak> found;
    for (const std::size_t i : judged_) {
      if (is_round_off[i]) continue;
      if (const auto unseen = unseen_of(i, fine)) found.push_back(*unseen);
    }
    std::ranges::stable_sort(
        found, [](const MissedPeak& a, const MissedPeak& b) { return a.share > b.share; });
    return found;
  }

 private:
  static bool is_judged(const Response& response) {
    if (!response.history() || response.history()->map) return false;
    return response.is_fatigue() || response.is_peak_over_time();
  }

  double end() const { return trajectory_.time(trajectory_.steps()); }
  double step_at(int step) const { return trajectory_.time(step + 1) - trajectory_.time(step); }
  double longest_step_behind(int step) const {
    double longest = 0.0;
    const int last = std::min(step + steps_behind_a_jump, trajectory_.steps());
    for (int k = step; k < last; ++k) longest = std::max(longest, step_at(k));
    return longest;
  }
  StepRange window(std::size_t response) const {
    return run_.analysis.responses[response].steps(trajectory_.time);
  }

  void look_at(const SuddenJump& jump) {
    const FastVibration fast(mechanism_, jump.behind, jump.change,
                             fast_angle / longest_step_behind(jump.step));
    if (fast.is_empty()) return;
    JumpTransient suspect{jump.step, 0.0, 0.0, fast.main_period(), fast.shortest_period()};
    for (const std::size_t i : judged_) look_at(jump, fast, i, suspect);
    if (suspect.share > 0.0) suspects_.push_back(suspect);
  }

  /// What a response is in a state, measured as its history is.
  Eigen::VectorXd observed(std::size_t response, const State& state) const {
    Signal& signal = *run_.analysis.responses[response].history()->signal;
    Eigen::VectorXd values(signal.channels());
    signal.observe(state, values);
    return values;
  }

  /// A transient as it goes on within the window of a response.
  struct Transient {
    Eigen::VectorXd time;    ///< behind the jump [s]
    Eigen::MatrixXd values;  ///< channels × samples
  };

  /// Where the window begins behind a jump [s]; of a motion that repeats itself, also in the next
  /// period.
  double way_to(const StepRange& range, const SuddenJump& jump) const {
    const double from = trajectory_.time(range.first) - trajectory_.time(jump.step);
    return std::max(0.0, range.last <= jump.step ? from + end() : from);
  }

  Transient transient_of(const SuddenJump& jump, const FastVibration& fast, std::size_t response,
                         const StepRange& range) const {
    const double from = way_to(range, jump);
    const bool is_later = from > 0.0;
    const double window =
        trajectory_.time(range.last) - trajectory_.time(is_later ? range.first : jump.step);
    const double length = std::min(followed_periods * fast.longest_period(), window);
    const int samples =
        std::clamp(static_cast<int>(std::ceil(length / fast.shortest_period() * samples_of_period)),
                   3, most_samples);
    const State base = is_later ? trajectory_.state_at(range.first) : jump.before;
    Transient transient;
    transient.time = Eigen::VectorXd::LinSpaced(samples, from, from + length);
    const Eigen::VectorXd offset = offset_of(response, is_later ? range.first : before(jump), base);
    for (int k = 0; k < samples; ++k) {
      State state = base;
      if (is_later) {
        fast.add_swing(transient.time(k), state);
      } else {
        fast.add(transient.time(k), state);
      }
      const Eigen::VectorXd values = observed(response, state) + offset;
      if (k == 0) transient.values.resize(values.size(), samples);
      transient.values.col(k) = values;
    }
    return transient;
  }

  static int before(const SuddenJump& jump) { return std::max(0, jump.step - 1); }

  /// What is taken off what is observed: the mechanism without elasticity.
  Eigen::VectorXd offset_of(std::size_t response, int step, const State& state) const {
    const ResponseHistory& history = *run_.analysis.responses[response].history();
    if (!history.rigid_response) return Eigen::VectorXd::Zero(history.signal->channels());
    return run_.analysis.histories[response].col(step) - observed(response, state);
  }

  /// The number of a response from a stretch of its history; of a cycle with all of the history.
  double number_of(std::size_t response, const StepRange& range, const Eigen::VectorXd& time,
                   const Eigen::MatrixXd& values) const {
    const ResponseHistory& history = *run_.analysis.responses[response].history();
    if (!history.fatigue) {
      return reduce(history.over_time, time, values, whole_range(time), {}, history.among).value;
    }
    const Eigen::MatrixXd& known = run_.analysis.histories[response];
    Eigen::MatrixXd all(known.rows(), range.steps() + values.cols());
    all << known.middleCols(range.first, range.steps()), values;
    const Eigen::VectorXd instants = Eigen::VectorXd::LinSpaced(all.cols(), 0.0, 1.0);
    return reduce_cycle(history.fatigue->criterion, instants, all, whole_range(instants)).value;
  }

  void look_at(const SuddenJump& jump, const FastVibration& fast, std::size_t response,
               JumpTransient& suspect) const {
    const StepRange range = window(response);
    if (range.last <= jump.step && !trajectory_.periodic) return;
    // So far behind it that the run has no room for the way there.
    if (way_to(range, jump) * fair_steps > more_steps() * fast.main_period()) return;
    const Transient transient = transient_of(jump, fast, response, range);
    const double value = run_.analysis.responses[response].is_fatigue()
                             ? number_of(response, range, {}, {})
                             : run_.analysis.reductions[response].value;
    const double vibrating = number_of(response, range, transient.time, transient.values);
    const double share = missing_share(response, value, vibrating);
    if (!(share > small_missing_share)) return;
    suspect.share = std::max(suspect.share, share);
    suspect.predicted[response] = {share, vibrating / value};
    suspect.until =
        std::max(suspect.until, way_to(range, jump) + followed_periods * fast.longest_period());
  }

  /// What a peak is short of another one, of the largest within the window.
  double missing_share(std::size_t response, double value, double vibrating) const {
    const StepRange range = window(response);
    const double sign = run_.analysis.responses[response].is_reduced_by(OverTime::min) ? -1.0 : 1.0;
    double size = std::max(std::abs(value), std::abs(vibrating));
    if (!run_.analysis.responses[response].is_fatigue()) {
      size = std::max(size, run_.analysis.histories[response]
                                .middleCols(range.first, range.steps())
                                .lpNorm<Eigen::Infinity>());
    }
    return sign * (vibrating - value) / size;
  }

  /// A transient goes on into the next jump if that is close: how both add up depends on every period.
  double end_of(const JumpTransient& suspect) const {
    const double begin = trajectory_.time(suspect.step), end = begin + suspect.until;
    double last = end;
    for (const JumpTransient& other : suspects_) {
      const double next = trajectory_.time(other.step);
      if (next > begin && next - end < suspect.until) last = std::max(last, next);
    }
    return last;
  }

  int more_steps() const {
    return std::clamp(coordinates_in_steps / std::max(1, mechanism_.system->coordinates()),
                      least_more_steps, enough_more_steps);
  }

  /// Short steps behind a jump, and where a motion that repeats itself goes on at its beginning.
  std::vector<ShorterSteps> stretches_of(const JumpTransient& suspect, double step) const {
    const double begin = trajectory_.time(suspect.step), last = end_of(suspect);
    std::vector<ShorterSteps> stretches = {{begin, last, step}};
    if (trajectory_.periodic && last > end()) stretches.push_back({0.0, last - end(), step});
    return stretches;
  }

  /// The instants of the run, with more of them behind jumps, the worst first, while there is room.
  std::vector<double> refined_instants() {
    const double room = trajectory_.steps() + std::max(more_steps(), trajectory_.steps());
    std::vector<ShorterSteps> stretches;
    std::vector<double> instants;
    for (JumpTransient& suspect : suspects_) {
      const double step =
          std::max(suspect.shortest / good_steps, 1.5 * suspect.until / more_steps());
      if (step > suspect.main / fair_steps) continue;
      std::vector<ShorterSteps> all = stretches;
      for (const ShorterSteps& one : stretches_of(suspect, step)) all.push_back(one);
      std::vector<double> more = instants_with(trajectory_, all);
      if (static_cast<double>(more.size()) > room) continue;
      suspect.is_simulated = true;
      stretches = std::move(all);
      instants = std::move(more);
    }
    return instants;
  }

  /// What the run would have seen with short steps there; nothing if there is no room for them, or
  /// no step converges.
  std::optional<RefinedRun> simulate_transients() {
    ProblemFile fine = run_.problem;
    fine.simulation.instants = refined_instants();
    if (fine.simulation.instants.empty()) return std::nullopt;
    // Whose multipliers have no transient where the size of steps changes.
    ConstraintForm& form = fine.simulation.formulation.constraints;
    if (form == ConstraintForm::index_3) form = ConstraintForm::stabilized_index_2;
    RefinedRun run = make_refined_run(fine, run_.x, {}, &trajectory_);
    if (run.has_failed()) return std::nullopt;
    return run;
  }

  std::optional<MissedPeak> unseen_of(std::size_t response,
                                      const std::optional<RefinedRun>& fine) const {
    const JumpTransient& suspect = suspect_of(response, fine.has_value());
    const auto known = suspect.predicted.find(response);
    if (known == suspect.predicted.end()) return std::nullopt;
    const double exponent = damage_exponent(response);
    if (!fine || !suspect.is_simulated) {
      const auto& [share, factor] = known->second;
      return MissedPeak{response, std::pow(factor, exponent), share, suspect, true};
    }
    const double value = run_.analysis.reductions[response].value;
    const double peak = fine->values(static_cast<Eigen::Index>(response));
    const double share = 1.0 - std::pow(1.0 - missing_share(response, value, peak), 1.0 / exponent);
    if (!(share > small_missing_share)) return std::nullopt;
    return MissedPeak{response, peak / value, share, suspect, false};
  }

  /// Of damage, which grows with it as a power of stress; else 1.
  double damage_exponent(std::size_t response) const {
    const ResponseHistory& history = *run_.analysis.responses[response].history();
    return history.fatigue ? history.fatigue->damage_exponent.value_or(1.0) : 1.0;
  }

  /// Where most of a response is missing: among those that were simulated, if any of them miss some.
  const JumpTransient& suspect_of(std::size_t response, bool is_simulated) const {
    const auto rank = [&](const JumpTransient& suspect) {
      const auto found = suspect.predicted.find(response);
      const bool misses = found != suspect.predicted.end();
      return std::pair(misses && is_simulated && suspect.is_simulated,
                       misses ? found->second.share : 0.0);
    };
    return *std::ranges::max_element(
        suspects_,
        [&](const JumpTransient& a, const JumpTransient& b) { return rank(a) < rank(b); });
  }

  const TrustedRun& run_;
  const Mechanism& mechanism_;
  const Trajectory& trajectory_;
  std::vector<std::size_t> judged_;
  std::vector<JumpTransient> suspects_;
};

/// What begins it.
std::string cause_of(const TrustedRun& run, int step) {
  if (step > 0 || run.analysis.trajectory.periodic) {
    return fmt::format("what acts jumps at t = {:.4g} s", run.analysis.trajectory.time(step));
  }
  return run.problem.simulation.quasi_static_start
             ? "the motion begins at once"
             : "bodies begin undeformed under loads and speeds that are there at once";
}

std::string remedy_of(const TrustedRun& run, int step) {
  if (step > 0 || run.analysis.trajectory.periodic) {
    return ", or a \"ramp\" in place of a jump where it comes up slower than that";
  }
  return run.problem.simulation.quasi_static_start ? ""
                                                   : ", or \"initial_state\": \"quasi-static\"";
}

}  // namespace

std::vector<Finding> check_unresolved_transients(const TrustedRun& run) {
  if (!run.problem.simulation.checks_resolution) return {};
  const std::vector<MissedPeak> found = UnresolvedTransients(run).find();
  if (found.empty()) return {};
  const MissedPeak& worst = found.front();
  const Trajectory& trajectory = run.analysis.trajectory;
  Finding finding;
  finding.is_serious = true;
  double period = worst.suspect.main;
  for (const MissedPeak& one : found) {
    finding.responses.push_back(run.analysis.responses[one.response].name);
    period = std::min(period, one.suspect.main);
  }
  const std::size_t others = found.size() - 1;
  const int step = worst.suspect.step;
  finding.text = fmt::format(
      "the steps do not see how far \"{}\"{}: {}, and what is elastic swings beyond its new "
      "equilibrium with a period of {:.2g} s, in steps of {:.2g} s. {} would be {}. Try a "
      "/simulation/step of {:.1g} s{}.",
      finding.responses.front(),
      others == 0 ? " swings"
                  : fmt::format(" and {} other response{} swing", others, others == 1 ? "" : "s"),
      cause_of(run, step), worst.suspect.main, trajectory.step_size(step + 1),
      worst.is_predicted ? "Without damping the peak" : "The peak", times_as_large(worst.factor),
      period / good_steps, remedy_of(run, step));
  return {finding};
}

}  // namespace pleuel
