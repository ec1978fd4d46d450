#include "core/trust/unseen_overshoot.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "core/base/number_text.hpp"
#include "core/integration/fast_vibration.hpp"
#include "core/trust/asked_responses.hpp"

namespace pleuel {

namespace {

/// Shares of a peak that may be unseen without a word, and without harm.
constexpr double small_missing_share = 0.02, serious_missing_share = 0.1;
/// σ of what is fast, times the step: half a period.
constexpr double fast_angle = std::numbers::pi;
/// Before and behind a jump, in steps.
constexpr double beside = 1e-6;
/// Steps a period that see a peak.
constexpr double good_steps = 20.0;

/// A jump of what acts.
struct Jump {
  int step;      ///< the instant
  State before;  ///< what it meets
  FastVibration vibration;

  double period() const { return 2.0 * std::numbers::pi / vibration.frequency; }
};

/// The largest that the steps leave unseen of a response.
struct Unseen {
  std::size_t response;
  double swung;   ///< the peak that it would have
  double share;   ///< what is missing, of that or of what was found
  int step;       ///< where
  double period;  ///< [s]
};

class UnseenOvershoots {
 public:
  explicit UnseenOvershoots(const TrustedRun& run)
      : run_(run), mechanism_(run.analysis.model.mechanism), trajectory_(run.analysis.trajectory) {
    for (const std::size_t i : asked_responses(run.problem)) {
      if (is_judged(run.analysis.responses[i])) judged_.push_back(i);
    }
  }

  /// The worst first.
  std::vector<Unseen> find() {
    if (judged_.empty() || (mechanism_.elastic.empty() && mechanism_.springs.empty())) return {};
    for (int step = trajectory_.periodic ? 1 : 0; step < trajectory_.steps(); ++step) {
      if (step == 0 || (!run_.analysis.breaks.empty() && run_.analysis.breaks[step])) look_at(step);
    }
    std::stable_sort(found_.begin(), found_.end(),
                     [](const Unseen& a, const Unseen& b) { return a.share > b.share; });
    return std::move(found_);
  }

 private:
  static bool is_judged(const Response& response) {
    return response.is_peak_over_time() && !response.is_fatigue() && !response.history()->map &&
           !response.history()->rigid_response;
  }

  double step_behind(int step) const { return trajectory_.time(step + 1) - trajectory_.time(step); }

  /// The first instant: nothing is accelerated yet, and nothing holds.
  std::optional<Jump> start() const {
    State state;
    trajectory_.states->load(0, state);
    state.time += beside * step_behind(0);
    state.a.setZero();
    state.lambda.setZero();
    return jump_of(0, state, state, residual(state));
  }

  std::optional<Jump> jump_at(int step) const {
    State before, at;
    trajectory_.states->load(step - 1, before);
    trajectory_.states->load(step, at);
    const double time = at.time, close = beside * step_behind(step);
    at.time = time - close;
    const Eigen::VectorXd sooner = residual(at);
    at.time = time + close;
    return jump_of(step, before, at, residual(at) - sooner);
  }

  std::optional<Jump> jump_of(int step, const State& before, const State& behind,
                              const Eigen::VectorXd& change) const {
    Jump jump{step, before,
              fast_vibration(mechanism_, behind, change, fast_angle / step_behind(step))};
    if (!(jump.vibration.frequency > 0.0)) return std::nullopt;
    return jump;
  }

  Eigen::VectorXd residual(const State& state) const {
    Eigen::VectorXd residual;
    mechanism_.system->residual(state, ConstraintLevel::acceleration, residual);
    return residual;
  }

  void look_at(int step) {
    const std::optional<Jump> jump = step == 0 ? start() : jump_at(step);
    if (!jump) return;
    for (const std::size_t i : judged_) {
      const StepRange range = run_.analysis.responses[i].steps(trajectory_.time);
      if (step >= range.first && step < range.last) look_at(*jump, i);
    }
  }

  /// Of a state in which the fast modes are so far on the way to their equilibrium.
  double value_at(const Jump& jump, std::size_t response, double way) const {
    const FastVibration& fast = jump.vibration;
    State state = jump.before;
    state.q += way * fast.settled_q;
    state.a += fast.a + way * fast.settled_a;
    state.lambda += fast.lambda + way * fast.settled_lambda;
    const ResponseHistory& history = *run_.analysis.responses[response].history();
    Eigen::VectorXd observed(history.signal->channels());
    history.signal->observe(state, observed);
    Eigen::MatrixXd values(observed.size(), 2);
    values << observed, observed;
    return reduce(history.over_time, Eigen::Vector2d(0.0, 1.0), values, {0, 1}, {}, history.among)
        .value;
  }

  void look_at(const Jump& jump, std::size_t response) {
    const double sign = run_.analysis.responses[response].is_reduced_by(OverTime::min) ? -1.0 : 1.0;
    const double value = run_.analysis.reductions[response].value;
    const double settled = value_at(jump, response, 1.0),
                 swung = value_at(jump, response, 1.0 + jump.vibration.overshoot());
    const double missing = std::min(sign * (swung - value), sign * (swung - settled));
    const double size = std::max(std::abs(value), std::abs(swung));
    if (!(missing > small_missing_share * size)) return;
    const Unseen unseen{response, swung, missing / size, jump.step, jump.period()};
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
  doubt.is_serious = worst.share > serious_missing_share;
  double period = worst.period;
  for (const Unseen& one : found) {
    doubt.responses.push_back(run.analysis.responses[one.response].name);
    period = std::min(period, one.period);
  }
  const std::size_t others = found.size() - 1;
  const bool is_start = worst.step == 0;
  doubt.text = fmt::format(
      "the steps do not see how far \"{}\"{}: {}, and elastic bodies swing beyond their new "
      "equilibrium with a period of {:.2g} s, in steps of {:.2g} s. The peak would be {}. Try a "
      "/simulation/step of {:.1g} s, or {}.",
      doubt.responses.front(),
      others == 0 ? " swings"
                  : fmt::format(" and {} other response{} swing", others, others == 1 ? "" : "s"),
      is_start ? "they begin undeformed under loads and speeds that are there at once"
               : fmt::format("what acts jumps at t = {:.4g} s", trajectory.time(worst.step)),
      worst.period, trajectory.step_size(worst.step + 1),
      times_as_large(worst.swung / run.analysis.reductions[worst.response].value),
      period / good_steps,
      is_start ? "\"initial_state\": \"quasi-static\""
               : "a \"ramp\" in place of a jump where it comes up slower than that");
  return {doubt};
}

}  // namespace pleuel
