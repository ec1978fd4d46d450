#include "core/trust/unseen_overshoot.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "core/base/number_text.hpp"
#include "core/integration/fast_vibration.hpp"
#include "core/response/fatigue.hpp"
#include "core/trust/asked_responses.hpp"

namespace pleuel {

namespace {

/// Share of a history that may be unseen: a few Ritz vectors know a swing to some percent.
constexpr double small_missing_share = 0.1;
/// Angular frequency from which on a mode is fast, times the step: three steps a period.
constexpr double fast_angle = 2.0;
/// Before and behind a jump, in steps.
constexpr double beside = 1e-6;
/// Steps a period that see a peak.
constexpr double good_steps = 20.0;
/// Of so many jumps the largest are looked at.
constexpr std::size_t most_jumps = 16;
/// A swing is followed for so many of its longest periods, with so many samples of its shortest.
constexpr double followed_periods = 1.5, samples_of_period = 12.0;
constexpr int most_samples = 200;

/// A jump of what acts.
struct Jump {
  int step;              ///< the instant
  State before, behind;  ///< what it meets; positions and velocities at it, and the instant behind
  Eigen::VectorXd change;  ///< of the residual
};

/// The largest that the steps leave unseen of a response.
struct Unseen {
  std::size_t response;
  double swung;   ///< the peak that it would have
  double share;   ///< what is missing, of the largest of all
  int step;       ///< where
  double period;  ///< [s]
};

class UnseenOvershoots {
 public:
  explicit UnseenOvershoots(const TrustedRun& run)
      : run_(run), mechanism_(run.analysis.model.mechanism), trajectory_(run.analysis.trajectory) {
    for (const std::size_t i : asked_parts(run.problem)) {
      if (is_judged(run.analysis.responses[i])) judged_.push_back(i);
    }
  }

  /// The worst first.
  std::vector<Unseen> find() {
    if (judged_.empty() || (mechanism_.elastic.empty() && mechanism_.springs.empty())) return {};
    for (const Jump& jump : largest_jumps()) look_at(jump);
    std::stable_sort(found_.begin(), found_.end(),
                     [](const Unseen& a, const Unseen& b) { return a.share > b.share; });
    return std::move(found_);
  }

 private:
  static bool is_judged(const Response& response) {
    if (!response.history() || response.history()->map) return false;
    if (response.is_fatigue()) return !response.history()->fatigue->damage_exponent;
    return response.is_peak_over_time();
  }

  double step_behind(int step) const { return trajectory_.time(step + 1) - trajectory_.time(step); }

  std::vector<Jump> largest_jumps() const {
    const BrokenInstants& breaks = run_.analysis.breaks;
    std::vector<Jump> jumps = {trajectory_.periodic ? seam() : start()};
    for (int step = 1; step < trajectory_.steps(); ++step) {
      if (!breaks.empty() && breaks[step]) jumps.push_back(jump_at(step));
    }
    std::erase_if(jumps, [](const Jump& jump) { return jump.change.isZero(0.0); });
    if (jumps.size() > most_jumps) {
      std::stable_sort(jumps.begin(), jumps.end(), [](const Jump& a, const Jump& b) {
        return a.change.squaredNorm() > b.change.squaredNorm();
      });
      jumps.resize(most_jumps);
    }
    return jumps;
  }

  /// The first instant: nothing is accelerated yet, and nothing holds.
  Jump start() const {
    State state;
    trajectory_.states->load(0, state);
    state.time += beside * step_behind(0);
    state.a.setZero();
    state.lambda.setZero();
    return {0, state, state, residual(state)};
  }

  /// Between the end of a motion that repeats itself and its beginning.
  Jump seam() const {
    State at;
    trajectory_.states->load(0, at);
    return jump_of(0, at, at, trajectory_.time(trajectory_.steps()), at.time);
  }

  Jump jump_at(int step) const {
    State before, at;
    trajectory_.states->load(step - 1, before);
    trajectory_.states->load(step, at);
    return jump_of(step, before, at, at.time, at.time);
  }

  /// @param end, begin  the same instant, as one before and one behind it
  Jump jump_of(int step, const State& before, State at, double end, double begin) const {
    const double close = beside * step_behind(step);
    at.time = end - close;
    const Eigen::VectorXd sooner = residual(at);
    at.time = begin + close;
    return {step, before, at, residual(at) - sooner};
  }

  Eigen::VectorXd residual(const State& state) const {
    Eigen::VectorXd residual;
    mechanism_.system->residual(state, ConstraintLevel::acceleration, residual);
    return residual;
  }

  void look_at(const Jump& jump) {
    const FastVibration fast(mechanism_, jump.behind, jump.change,
                             fast_angle / step_behind(jump.step));
    if (fast.is_empty()) return;
    for (const std::size_t i : judged_) {
      const StepRange range = run_.analysis.responses[i].steps(trajectory_.time);
      if (range.last > jump.step) look_at(jump, fast, i, range);
    }
  }

  /// What a response is in a state, measured as its history is.
  Eigen::VectorXd observed(std::size_t response, const State& state) const {
    Signal& signal = *run_.analysis.responses[response].history()->signal;
    Eigen::VectorXd values(signal.channels());
    signal.observe(state, values);
    return values;
  }

  /// A swing as it goes on within the window of a response.
  struct Swing {
    Eigen::VectorXd time;
    Eigen::MatrixXd values;  ///< channels × samples
    double settled = 0.0;    ///< the number that it would be without the swing
  };

  Swing swing_of(const Jump& jump, const FastVibration& fast, std::size_t response,
                 const StepRange& range) const {
    const double at = trajectory_.time(jump.step);
    const double from = std::max(0.0, trajectory_.time(range.first) - at);
    const double length = std::min(followed_periods * fast.longest_period(),
                                   trajectory_.time(range.last) - at - from);
    const int samples =
        std::clamp(static_cast<int>(std::ceil(length / fast.shortest_period() * samples_of_period)),
                   3, most_samples);
    const bool is_later = range.first > jump.step;
    State base = jump.before;
    if (is_later) trajectory_.states->load(range.first, base);
    Swing swing;
    swing.time = Eigen::VectorXd::LinSpaced(samples, from, from + length);
    const Eigen::VectorXd offset = offset_of(response, is_later ? range.first : before(jump), base);
    for (int k = 0; k < samples; ++k) {
      State state = base;
      if (is_later) {
        fast.add_swing(swing.time(k), state);
      } else {
        fast.add(swing.time(k), state);
      }
      const Eigen::VectorXd values = observed(response, state) + offset;
      if (k == 0) swing.values.resize(values.size(), samples);
      swing.values.col(k) = values;
    }
    if (!is_later) fast.add_settled(base);
    const Eigen::VectorXd rest = observed(response, base) + offset;
    swing.settled =
        number_of(response, range, Eigen::Vector2d(from, from + length), rest.replicate(1, 2));
    return swing;
  }

  static int before(const Jump& jump) { return std::max(0, jump.step - 1); }

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

  void look_at(const Jump& jump, const FastVibration& fast, std::size_t response,
               const StepRange& range) {
    const double sign = run_.analysis.responses[response].is_reduced_by(OverTime::min) ? -1.0 : 1.0;
    const double value = run_.analysis.reductions[response].value;
    const Swing swing = swing_of(jump, fast, response, range);
    const double swung = number_of(response, range, swing.time, swing.values);
    const double missing = std::min(sign * (swung - value), sign * (swung - swing.settled));
    const double size = std::max({std::abs(value), std::abs(swung),
                                  run_.analysis.histories[response].lpNorm<Eigen::Infinity>()});
    if (!(missing > small_missing_share * size)) return;
    const Unseen unseen{response, swung, missing / size, jump.step, fast.main_period()};
    const auto known = std::find_if(found_.begin(), found_.end(), [&](const Unseen& other) {
      return other.response == response;
    });
    if (known == found_.end()) {
      found_.push_back(unseen);
    } else if (known->share < unseen.share) {
      *known = unseen;
    }
  }

  const TrustedRun& run_;
  const Mechanism& mechanism_;
  const Trajectory& trajectory_;
  std::vector<std::size_t> judged_;
  std::vector<Unseen> found_;  ///< one a response at most
};

}  // namespace

std::vector<Doubt> doubt_unseen_overshoot(const TrustedRun& run) {
  if (!run.problem.simulation.checks_resolution) return {};
  const std::vector<Unseen> found = UnseenOvershoots(run).find();
  if (found.empty()) return {};
  const Unseen& worst = found.front();
  const Trajectory& trajectory = run.analysis.trajectory;
  Doubt doubt;
  doubt.is_serious = true;
  double period = worst.period;
  for (const Unseen& one : found) {
    doubt.responses.push_back(run.analysis.responses[one.response].name);
    period = std::min(period, one.period);
  }
  const std::size_t others = found.size() - 1;
  const bool is_start = worst.step == 0;
  doubt.text = fmt::format(
      "the steps do not see how far \"{}\"{}: {}, and what is elastic swings beyond its new "
      "equilibrium with a period of {:.2g} s, in steps of {:.2g} s. The peak would be {}. Try a "
      "/simulation/step of {:.1g} s, or {}.",
      doubt.responses.front(),
      others == 0 ? " swings"
                  : fmt::format(" and {} other response{} swing", others, others == 1 ? "" : "s"),
      is_start ? "bodies begin undeformed under loads and speeds that are there at once"
               : fmt::format("what acts jumps at t = {:.4g} s", trajectory.time(worst.step)),
      worst.period, trajectory.step_size(worst.step + 1),
      times_as_large(worst.swung / run.analysis.reductions[worst.response].value),
      period / good_steps,
      is_start ? "\"initial_state\": \"quasi-static\""
               : "a \"ramp\" in place of a jump where it comes up slower than that");
  return {doubt};
}

}  // namespace pleuel
