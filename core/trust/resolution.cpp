#include "core/trust/resolution.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/number_text.hpp"
#include "core/base/relative_error.hpp"
#include "core/response/linearized_expression.hpp"
#include "core/scene/response_parts.hpp"
#include "core/trust/asked_responses.hpp"
#include "core/trust/error_bands.hpp"
#include "core/trust/nested_runs.hpp"
#include "core/trust/round_off.hpp"

namespace pleuel {

namespace {

/// Relative errors from which on a response is named, and from which on nothing that rests on it is
/// verified.
constexpr double small_error = 0.01, serious_error = 0.1;

// Of a suspicion:
constexpr double suspicious_change = 0.01;      ///< of a value by twice the step
constexpr double suspicious_difference = 0.05;  ///< of histories, of their largest value
/// Second difference of a history over its largest value: 2 (1 − cos ωh) of a vibration.
constexpr double suspicious_swing = 0.3;
/// Error of the balance of energy, of the largest elastic energy.
constexpr double suspicious_energy = 0.5;

/// A change that is not below this share of the one before says nothing of the next one (a quarter
/// is what order 2 promises).
constexpr double falling_share = 0.5;
/// What is taken then, times the change.
constexpr double unknown_factor = 3.0;

/// What the error of a response is compared with: its value and its limits, one of which may be
/// zero.
double asked_size(const ProblemFile& problem, const std::string& response, double value) {
  double size = std::abs(value);
  for (const ConstraintSettings& limit : problem.constraints) {
    if (limit.response != response) continue;
    size =
        std::max({size, std::abs(limit.lower.value_or(0.0)), std::abs(limit.upper.value_or(0.0))});
  }
  return size;
}

/// Whether the accuracy of a response is asked for.
bool counts(const ProblemFile& problem, std::size_t response) {
  const std::vector<std::size_t> asked = asked_responses(problem);
  return std::find(asked.begin(), asked.end(), response) != asked.end();
}

class Judgement {
 public:
  explicit Judgement(const TrustedRun& run)
      : run_(run), problem_(run.problem), found_(nested_run_of(run.analysis)) {
    for (std::size_t i = 0; i < run.analysis.responses.size(); ++i) {
      if (!is_monitor(problem_, i)) judged_.push_back(i);
    }
  }

  Resolution judge() {
    if (judged_.empty()) return {};
    plan_coarse_runs();
    make_coarse_runs();
    suspect();
    if (is_suspicious() && leave_out_round_off()) suspect();
    needs_half_step_ = is_close() || is_time_suspicious_ || !do_coarse_runs_suffice();
    std::vector<Refinement> fine;
    if (needs_half_step_) fine.push_back({0.5, 1.0});
    if (is_space_suspicious_) fine.push_back(twice);
    if (are_modes_suspicious_) fine.push_back({1.0, 1.0, judging_modes});
    Resolution found = weigh(make_nested_runs(problem_, run_.x, fine));
    make_bars(found);
    return found;
  }

 private:
  static constexpr Refinement twice{.pieces = 2}, half{.elements = 0.5};

  bool is_close() const { return run_.scrutiny == Scrutiny::close; }
  /// Of the run that is always made.
  bool has_finer_division() const { return other_division_.pieces > 1; }

  static Refinement at_twice_the_step(Refinement division) {
    division.step = 2.0;
    return division;
  }

  void plan_coarse_runs() {
    const std::optional<int> fewest = fewest_elements(run_.analysis.model, problem_);
    const bool has_few = fewest.value_or(1) <= 2 || !can_be_halved(run_.analysis.model, problem_);
    other_division_ = has_few ? twice : half;
    has_elements_ = fewest.has_value();
    has_more_elements_ = is_close() && has_elements_ && !has_few;
    has_modes_ = has_reduced_beams(run_.analysis.model, problem_);
    // One element may have no more modes, and more elements change nothing without them.
    has_modes_of_more_elements_ = has_modes_ && has_few;
    has_tolerance_ = problem_.simulation.newton_tolerance > small_newton_tolerance;
  }

  void make_coarse_runs() {
    std::vector<Refinement> refinements = {{2.0, 1.0}, {4.0, 1.0}};
    if (has_elements_) refinements.push_back(at_twice_the_step(other_division_));
    if (has_more_elements_) refinements.push_back(at_twice_the_step(twice));
    if (has_modes_) refinements.push_back({2.0, 1.0, judging_modes});
    if (has_modes_of_more_elements_) {
      refinements.push_back({.step = 2.0, .more_modes = judging_modes, .pieces = 2});
    }
    if (has_tolerance_) refinements.push_back({4.0, 1.0, 0, judging_newton});
    std::vector<NestedRun> runs = make_nested_runs(problem_, run_.x, refinements);
    std::size_t next = 0;
    coarse_ = std::move(runs[next++]);
    coarsest_ = std::move(runs[next++]);
    if (has_elements_) other_elements_ = std::move(runs[next++]);
    if (has_more_elements_) more_elements_ = std::move(runs[next++]);
    if (has_modes_) other_modes_ = std::move(runs[next++]);
    if (has_modes_of_more_elements_) modes_of_more_elements_ = std::move(runs[next++]);
    if (has_tolerance_) other_newton_ = std::move(runs[next++]);
  }

  bool is_suspicious() const {
    return is_time_suspicious_ || is_space_suspicious_ || are_modes_suspicious_;
  }

  /// @returns whether there was one
  bool leave_out_round_off() {
    const std::vector<bool> is_left_out = find_round_off(run_);
    return std::erase_if(judged_, [&](std::size_t i) { return is_left_out[i]; }) > 0;
  }

  double magnitude(const NestedRun& run, std::size_t i) const {
    const Eigen::MatrixXd& history = run.histories[i];
    if (history.size() > 0) return history.cwiseAbs().maxCoeff();
    const double value = std::abs(run.values(i));
    return run_.analysis.responses[i].expression() ? std::max(value, magnitude_of(run_.analysis, i))
                                                   : value;
  }

  /// Of the value of a response, relative to the second run.
  double change(const NestedRun& run, const NestedRun& reference, std::size_t i) const {
    return value_error(run.values(i), reference.values(i), magnitude(reference, i));
  }

  void suspect() {
    is_time_suspicious_ = coarse_.has_failed() ||
                          run_.monitors.elastic_energy_error > suspicious_energy ||
                          std::any_of(judged_.begin(), judged_.end(),
                                      [&](std::size_t i) { return is_suspicious_in_time(i); });
    // Half the elements have four times the error (order 2, bending has more), twice a quarter of
    // it.
    const double share = has_finer_division() ? 4.0 / 3.0 : 1.0 / 3.0;
    if (has_elements_) is_space_suspicious_ = is_suspicious_beside(other_elements_, share);
    if (has_modes_) are_modes_suspicious_ = is_suspicious_beside(other_modes_, 1.0);
  }

  /// @param share  of the change that is an error
  bool is_suspicious_beside(const NestedRun& other, double share) const {
    return coarse_.has_failed() || other.has_failed() ||
           std::any_of(judged_.begin(), judged_.end(), [&](std::size_t i) {
             return share * change(other, coarse_, i) > small_error;
           });
  }

  bool is_suspicious_in_time(std::size_t i) const {
    if (change(coarse_, found_, i) > suspicious_change) return true;
    const Eigen::MatrixXd& history = found_.histories[i];
    if (history.size() == 0) return false;
    const StepRange range = run_.analysis.responses[i].steps(coarse_.time);
    const double size = magnitude(found_, i);
    return largest_difference(found_.time, history, coarse_.time, coarse_.histories[i], range) >
               suspicious_difference * size ||
           swing(history) > suspicious_swing * size;
  }

  static double swing(const Eigen::MatrixXd& history) {
    const Eigen::Index n = history.cols() - 2;
    if (n < 1) return 0.0;
    return (history.leftCols(n) - 2.0 * history.middleCols(1, n) + history.rightCols(n))
        .cwiseAbs()
        .maxCoeff();
  }

  Resolution weigh(std::vector<NestedRun> fine) {
    Resolution resolution;
    std::size_t next = 0;
    if (needs_half_step_) half_step_ = std::move(fine[next++]);
    if (is_time_suspicious_) resolution.in_time = weigh_time(half_step_, resolution.failure);
    if (is_space_suspicious_) {
      twice_elements_ = std::move(fine[next++]);
      resolution.in_space = weigh_division(twice_elements_, resolution.in_time, resolution.failure);
    }
    if (are_modes_suspicious_) {
      more_modes_ = std::move(fine[next++]);
      resolution.in_modes = weigh_division(more_modes_, resolution.in_time, resolution.failure);
    }
    return resolution;
  }

  /// Whether runs say what the step leaves of the responses that count, and that it is within the
  /// accuracy which the file asks for.
  bool suffice(const JudgingRuns& runs) const {
    return std::all_of(judged_.begin(), judged_.end(), [&](std::size_t i) {
      if (!counts(problem_, i)) return true;
      const ErrorPart step = with_known(i, error_bar(run_.analysis, i, runs, order())).step;
      const double value = found_.values(i);
      const double size = problem_.objective
                              ? asked_size(problem_, problem_.responses[i].name, value)
                              : magnitude(found_, i);
      return step.is_resolved && step.bound <= problem_.accuracy.target * size;
    });
  }

  /// Those with larger steps: one step has none above it.
  void set_coarse(JudgingRuns& runs) const {
    const auto is_coarser = [](const NestedRun& one, const NestedRun& other) {
      return one.has_failed() || one.time.size() < other.time.size();
    };
    if (is_coarser(coarse_, found_)) runs.twice_step = &coarse_;
    if (is_coarser(coarsest_, coarse_)) runs.four_steps = &coarsest_;
  }

  /// Where four times the step is far from any order, half of it has to tell.
  bool do_coarse_runs_suffice() const {
    JudgingRuns runs;
    set_coarse(runs);
    return suffice(runs);
  }

  void make_bars(Resolution& resolution) {
    JudgingRuns runs;
    if (needs_half_step_) runs.half_step = &half_step_;
    set_coarse(runs);
    if (quarter_step_ || (needs_half_step_ && !suffice(runs))) {
      runs.quarter_step = &quarter_step();
    }
    if (has_elements_) {
      (has_finer_division() ? runs.more_elements : runs.fewer_elements) = {&other_elements_,
                                                                           &coarse_};
    }
    if (has_more_elements_) runs.more_elements = {&more_elements_, &coarse_};
    if (is_space_suspicious_) runs.more_elements = {&twice_elements_, &found_};
    // Beside more elements fewer would make most bars too wide (tests/honesty).
    if (runs.more_elements.is_asked()) runs.fewer_elements = {};
    if (has_modes_) runs.modes = {&other_modes_, &coarse_};
    if (has_modes_of_more_elements_) runs.modes = {&modes_of_more_elements_, &other_elements_};
    if (are_modes_suspicious_) runs.modes = {&more_modes_, &found_};
    if (has_tolerance_) runs.newton = {&other_newton_, &coarsest_};
    const NestedRun* const judging[] = {
        runs.quarter_step,      runs.half_step,          &coarse_,       &coarsest_,
        runs.more_elements.run, runs.fewer_elements.run, runs.modes.run, runs.newton.run};
    for (const NestedRun* run : judging) {
      if (run && resolution.failed_run.empty()) resolution.failed_run = run->failure;
    }
    JudgingRuns of_bands = runs;  // histories of one step have bands, too
    of_bands.twice_step = &coarse_;
    of_bands.four_steps = &coarsest_;
    resolution.bands = error_bands(run_.analysis, of_bands, order());
    resolution.bars.resize(run_.analysis.responses.size());
    resolution.evidence.resize(run_.analysis.responses.size());
    for (const std::size_t i : judged_) {
      resolution.evidence[i] = evidence_of(run_.analysis, i, runs, order());
      resolution.bars[i] = with_known(i, error_bar(*resolution.evidence[i]));
    }
  }

  /// The bar of a response, or what is known of it otherwise if that is narrower.
  ErrorBar with_known(std::size_t response, const ErrorBar& bar) const {
    if (!run_.known || run_.known->empty() || !(*run_.known)[response]) return bar;
    const ErrorBar& known = *(*run_.known)[response];
    return bar.is_resolved() && bar.bound() <= known.bound() ? bar : known;
  }

  int order() const { return scheme_order(problem_.simulation); }

  std::vector<Unresolved> weigh_time(const NestedRun& fine, std::string& failure) {
    std::vector<Unresolved> unresolved;
    if (fine.has_failed()) {
      failure = fine.failure;
      return unresolved;
    }
    std::vector<Unresolved> open;
    bool rings = false;
    for (const std::size_t i : judged_) {
      const double now = change(found_, fine, i);
      const double before = coarse_.has_failed() ? 0.0 : change(coarse_, found_, i);
      const double error = now * (falls(now, before) ? 1.0 + missing_share() : unknown_factor);
      const bool is_known = now > small_error || falls(now, before), rings_on = rings_in(fine, i);
      if (error > small_error && is_known) {
        unresolved.push_back({i, now, error});
      } else if (error > small_error || rings_on) {
        open.push_back({i, now, error});
      }
      rings = rings || rings_on;
    }
    if (!open.empty() && (unresolved.empty() || rings)) ask_finer(fine, open);
    for (const Unresolved& one : open) {
      if (one.error > small_error) unresolved.push_back(one);
    }
    return sorted(std::move(unresolved));
  }

  /// Whether half the step changes a history as much as the step itself did: values may agree by
  /// accident, or all miss what only finer steps see.
  bool rings_in(const NestedRun& fine, std::size_t i) const {
    const Eigen::MatrixXd& history = found_.histories[i];
    if (history.size() == 0 || coarse_.has_failed()) return false;
    const std::vector<Response>& responses = run_.analysis.responses;
    const double now = largest_difference(fine.time, fine.histories[i], found_.time, history,
                                          responses[i].steps(found_.time)),
                 before =
                     largest_difference(found_.time, history, coarse_.time, coarse_.histories[i],
                                        responses[i].steps(coarse_.time));
    return now > suspicious_difference * magnitude(found_, i) && now > falling_share * before;
  }

  /// Whether a change is that of a fine division, a fraction of the one before.
  bool falls(double now, double before) const {
    return now <= std::max(falling_share, 1.2 * std::pow(2.0, -order())) * before;
  }

  /// What all finer divisions still change, over the last change.
  double missing_share() const { return 1.0 / (std::pow(2.0, order()) - 1.0); }

  /// Made when it is asked for.
  const NestedRun& quarter_step() {
    if (!quarter_step_) quarter_step_ = make_nested_run(problem_, run_.x, {0.25, 1.0});
    return *quarter_step_;
  }

  /// Judges changes of unknown meaning by another half of the step.
  void ask_finer(const NestedRun& fine, std::vector<Unresolved>& open) {
    const NestedRun& finest = quarter_step();
    if (finest.has_failed()) return;
    for (Unresolved& one : open) {
      const double next = change(fine, finest, one.response),
                   both = change(found_, finest, one.response);
      one.error = falls(next, one.change) ? both + missing_share() * next
                                          : std::max({one.change, next, both});
      one.is_of_quarter = both > one.change;
      one.change = std::max(one.change, both);
    }
  }

  /// Of elements or modes. Without those that time does not resolve: what space changes of them is
  /// not known.
  std::vector<Unresolved> weigh_division(const NestedRun& fine,
                                         const std::vector<Unresolved>& in_time,
                                         std::string& failure) const {
    std::vector<Unresolved> unresolved;
    if (fine.has_failed()) {
      failure = fine.failure;
      return unresolved;
    }
    for (const std::size_t i : judged_) {
      const double now = change(found_, fine, i), error = 4.0 / 3.0 * now;
      const bool is_named = std::any_of(
          in_time.begin(), in_time.end(),
          [&](const Unresolved& other) { return other.response == i && other.error > error; });
      if (error > small_error && !is_named) unresolved.push_back({i, now, error});
    }
    return sorted(std::move(unresolved));
  }

  static std::vector<Unresolved> sorted(std::vector<Unresolved> unresolved) {
    std::stable_sort(unresolved.begin(), unresolved.end(),
                     [](const Unresolved& a, const Unresolved& b) { return a.error > b.error; });
    return unresolved;
  }

  const TrustedRun& run_;
  const ProblemFile& problem_;
  NestedRun found_, coarse_, coarsest_, other_elements_, more_elements_, other_modes_,
      modes_of_more_elements_, other_newton_;
  NestedRun half_step_, twice_elements_, more_modes_;
  std::optional<NestedRun> quarter_step_;
  std::vector<std::size_t> judged_;
  Refinement other_division_ = half;
  bool has_elements_ = false, has_more_elements_ = false, has_modes_ = false,
       has_modes_of_more_elements_ = false, has_tolerance_ = false;
  bool needs_half_step_ = false;
  bool is_time_suspicious_ = false, is_space_suspicious_ = false, are_modes_suspicious_ = false;
};

/// A step that brings the largest error below half a percent by order 2, two digits.
std::string proposed_step(const ProblemFile& problem, double error) {
  const double factor = std::clamp(std::sqrt(0.5 * small_error / error), 1.0 / 16.0, 0.5);
  return fmt::format("{:.2g} s", problem.simulation.step * factor);
}

/// Vibrations that nothing damps never die out: the smaller the steps, the more of them are seen.
const char* advice_to_damp(const Model& model) {
  const bool is_damped = std::any_of(
      model.effects.begin(), model.effects.end(),
      [](const EffectRecord& record) { return record.name == "damping" && record.is_built; });
  const bool is_elastic =
      std::any_of(model.bodies.begin(), model.bodies.end(),
                  [](const BodyModel& body) { return body.elastic_size() > 0; });
  if (is_damped || !is_elastic) return "";
  return ", or give the beams \"damping\": no body has any, and vibrations that nothing damps may "
         "need ever smaller steps";
}

/// The doubt about some responses, or none.
std::vector<Doubt> doubt_about(const TrustedRun& run, const std::vector<Unresolved>& unresolved,
                               const std::string& what, const std::string& advice) {
  if (unresolved.empty()) return {};
  Doubt doubt;
  std::vector<std::string> changes;
  for (const Unresolved& one : unresolved) {
    const std::string& name = run.analysis.responses[one.response].name;
    doubt.responses.push_back(name);
    doubt.is_serious =
        doubt.is_serious || (one.error > serious_error && counts(run.problem, one.response));
    changes.push_back(fmt::format("\"{}\" by {}", name, rough_percent(one.change)));
  }
  doubt.text =
      fmt::format("{} changes {}: not resolved. {}", what, fmt::join(changes, ", "), advice);
  return {doubt};
}

}  // namespace

Resolution judge_resolution(const TrustedRun& run) {
  return run.problem.simulation.checks_resolution ? Judgement(run).judge() : Resolution();
}

std::vector<Doubt> doubt_resolution(const TrustedRun& run, const Resolution& found) {
  std::vector<Doubt> doubts;
  const auto add = [&](const std::vector<Doubt>& more) {
    doubts.insert(doubts.end(), more.begin(), more.end());
  };
  if (!found.in_time.empty()) {
    const bool is_of_quarter = std::any_of(found.in_time.begin(), found.in_time.end(),
                                           [](const Unresolved& one) { return one.is_of_quarter; });
    add(doubt_about(run, found.in_time,
                    is_of_quarter ? "half or a quarter of the step" : "half the step",
                    fmt::format("Try a /simulation/step of {}{}",
                                proposed_step(run.problem, found.in_time.front().error),
                                advice_to_damp(run.analysis.model))));
  }
  add(doubt_about(run, found.in_space, "twice the elements", "Try more elements"));
  add(doubt_about(run, found.in_modes,
                  fmt::format("a \"reduction\" of {} modes more in each family", judging_modes),
                  "Try more modes"));
  if (!found.failure.empty()) {
    doubts.push_back(
        {fmt::format("whether the responses are resolved is not known: {}", found.failure)});
  }
  return doubts;
}

}  // namespace pleuel
