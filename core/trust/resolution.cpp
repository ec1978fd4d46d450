#include "core/trust/resolution.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/number_text.hpp"
#include "core/base/relative_error.hpp"
#include "core/scene/response_parts.hpp"
#include "core/trust/coarse_runs.hpp"
#include "core/trust/error_bars.hpp"
#include "core/trust/refinement_set.hpp"
#include "core/trust/round_off.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

namespace {

/// Relative errors from which on a response is named, and from which on nothing that rests on it is
/// verified.
constexpr double small_error = 0.01, serious_error = 0.1;
/// Error of the balance of energy, of the largest elastic energy, from which on vibrations are damped
/// out by steps that are far too large: runs may agree on having seen nothing.
constexpr double suspicious_energy = 0.5;

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
  return std::ranges::find(asked, response) != asked.end();
}

/// Relative to the value; infinite: not known.
double share_of(const Evidence& evidence, const ErrorPart& part, double of_part) {
  if (!part.is_resolved) return std::numeric_limits<double>::infinity();
  return value_error(evidence.value + of_part, evidence.value, evidence.magnitude);
}

/// The estimate of the error; of bars that are known without one none.
double error_share(const Evidence& evidence, const ErrorPart& part) {
  return share_of(evidence, part, part.change);
}

/// Those that are no errors themselves.
std::vector<std::size_t> judged_responses(const ProblemFile& problem) {
  std::vector<std::size_t> judged;
  for (std::size_t i = 0; i < problem.responses.size(); ++i) {
    if (!is_monitor(problem, i)) judged.push_back(i);
  }
  return judged;
}

/// With the runs in larger steps, which others may have made.
RefinedRuns stored(const TrustedRun& run) {
  RefinedRuns store(run.problem, run.x);
  store.keep({2.0}, refined_run_of(coarse_runs(run).twice));
  store.keep({4.0}, refined_run_of(coarse_runs(run).four));
  return store;
}

class Judgement {
 public:
  explicit Judgement(const TrustedRun& run)
      : run_(run),
        problem_(run.problem),
        store_(stored(run)),
        set_(store_, {}, run.problem, run.analysis,
             is_close() ? Divisions::finer : Divisions::coarser,
             coarse_runs(run).is_four_enough ? 4.0 : 2.0),
        judged_(judged_responses(run.problem)),
        asked_(asked_responses(run.problem)) {}

  Resolution judge() {
    weigh();
    if (is_any_uncertain()) leave_out_round_off();
    if (is_close() || run_.monitors.elastic_energy_error > suspicious_energy || !do_suffice()) {
      refine();
    }
    if (set_.runs().half_step != nullptr && !do_suffice()) refine();
    found_.bands = error_bands(problem_, run_.analysis, set_.runs_of_histories(), order());
    found_.failure = set_.failure();
    return std::move(found_);
  }

 private:
  bool is_close() const { return run_.scrutiny == Scrutiny::close; }
  int order() const { return scheme_order(problem_.simulation); }

  void refine() {
    set_.refine_steps();
    weigh();
  }

  void weigh() {
    found_.bars.assign(run_.analysis.responses.size(), std::nullopt);
    found_.evidence.assign(run_.analysis.responses.size(), std::nullopt);
    for (const std::size_t i : judged_) {
      found_.evidence[i] = evidence_of(run_.analysis, i, set_.runs(), order());
      found_.evidence[i]->element_order = element_order(problem_, i);
      found_.bars[i] = with_known(i, error_bar(*found_.evidence[i]));
    }
  }

  bool is_any_uncertain() const {
    return std::ranges::any_of(judged_, [&](std::size_t i) {
      const ErrorBar& bar = *found_.bars[i];
      return error_share(*found_.evidence[i], bar.step) > small_error ||
             error_share(*found_.evidence[i], bar.elements) > small_error;
    });
  }

  void leave_out_round_off() {
    const std::vector<bool> is_left_out = find_round_off(run_);
    std::erase_if(judged_, [&](std::size_t i) { return is_left_out[i]; });
    weigh();
  }

  /// Whether the runs say what the step leaves of the responses that count; of an answer, that it is
  /// within the accuracy which the file asks for.
  bool do_suffice() const {
    return std::ranges::all_of(asked_, [&](std::size_t i) {
      if (!found_.bars[i]) return true;
      const ErrorPart& step = found_.bars[i]->step;
      if (!is_close() || !step.is_resolved) return step.is_resolved;
      const double size = problem_.objective ? asked_size(problem_, problem_.responses[i].name,
                                                          found_.evidence[i]->value)
                                             : found_.evidence[i]->magnitude;
      return step.bound <= problem_.accuracy.target * size;
    });
  }

  /// The bar of a response, or what is known of it otherwise if that is narrower.
  ErrorBar with_known(std::size_t response, const ErrorBar& bar) const {
    if (!run_.known || run_.known->empty() || !(*run_.known)[response]) return bar;
    const ErrorBar& known = *(*run_.known)[response];
    return bar.is_resolved() && bar.bound() <= known.bound() ? bar : known;
  }

  const TrustedRun& run_;
  const ProblemFile& problem_;
  RefinedRuns store_;
  RefinementSet set_;
  std::vector<std::size_t> judged_, asked_;
  Resolution found_;
};

/// Vibrations that nothing damps never die out: the smaller the steps, the more of them are seen.
const char* advice_to_damp(const Model& model) {
  const bool is_damped = std::ranges::any_of(model.effects, [](const EffectRecord& record) {
    return record.name == "damping" && record.is_built;
  });
  const bool is_elastic = std::ranges::any_of(
      model.bodies, [](const BodyModel& body) { return body.elastic_size() > 0; });
  if (is_damped || !is_elastic) return "";
  return ", or give the beams \"damping\": no body has any, and vibrations that nothing damps may "
         "need ever smaller steps";
}

/// Of a part, and of a bar that is known otherwise.
ErrorPart smaller(const ErrorPart& part, const ErrorPart& of_bar) {
  return of_bar.is_resolved && of_bar.bound < part.bound ? of_bar : part;
}

/// A response that is not known well enough: its error and its bar, relative.
struct Uncertain {
  std::size_t response = 0;
  double error = 0.0, bar = 0.0;
};

/// The worst first.
std::vector<Uncertain> uncertain_by(const Resolution& found,
                                    ErrorPart (*part_of)(const ErrorBar&, const Evidence&)) {
  std::vector<Uncertain> uncertain;
  for (std::size_t i = 0; i < found.bars.size(); ++i) {
    if (!found.bars[i]) continue;
    const Evidence& evidence = *found.evidence[i];
    const ErrorPart part = part_of(*found.bars[i], evidence);
    const double error = error_share(evidence, part);
    if (error > small_error) {
      uncertain.push_back({i, error, share_of(evidence, part, part.bound)});
    }
  }
  std::ranges::stable_sort(
      uncertain, [](const Uncertain& a, const Uncertain& b) { return a.error > b.error; });
  return uncertain;
}

/// The finding about some responses.
Finding check_about(const TrustedRun& run, const Resolution& found,
                    const std::vector<Uncertain>& uncertain, const std::string& cause,
                    const std::string& advice) {
  Finding finding;
  std::vector<std::string> bars;
  for (const Uncertain& one : uncertain) {
    const std::string& name = run.analysis.responses[one.response].name;
    finding.responses.push_back(name);
    finding.is_serious =
        finding.is_serious || (one.error > serious_error && counts(run.problem, one.response));
    bars.push_back(std::isinf(one.bar)
                       ? fmt::format("\"{}\" unknown", name)
                       : fmt::format("\"{}\" uncertain by {}", name, rough_percent(one.bar)));
  }
  finding.text = fmt::format(
      "{} leave {}: not resolved. {}", cause, fmt::join(bars, ", "),
      found.failure.empty() ? advice : "A run that would tell failed: " + found.failure);
  return finding;
}

/// A step that brings an error below half a percent by order 2, two digits.
std::string proposed_step(const ProblemFile& problem, double error) {
  const double factor = std::clamp(std::sqrt(0.5 * small_error / error), 1.0 / 16.0, 0.5);
  return fmt::format("{:.2g} s", problem.simulation.step * factor);
}

}  // namespace

Resolution judge_resolution(const TrustedRun& run) {
  const bool has_any = !judged_responses(run.problem).empty();
  return run.problem.simulation.checks_resolution && has_any ? Judgement(run).judge()
                                                             : Resolution();
}

std::vector<Finding> check_resolution(const TrustedRun& run, const Resolution& found) {
  std::vector<Finding> findings;
  const auto of_step =
      uncertain_by(found, [](const ErrorBar& bar, const Evidence&) { return bar.step; });
  if (!of_step.empty()) {
    findings.push_back(check_about(run, found, of_step, "the steps",
                                   fmt::format("Try a /simulation/step of {}{}",
                                               proposed_step(run.problem, of_step.front().error),
                                               advice_to_damp(run.analysis.model))));
  }
  const auto of_elements = uncertain_by(found, [](const ErrorBar& bar, const Evidence& evidence) {
    return smaller(element_part(evidence), bar.elements);
  });
  if (!of_elements.empty()) {
    findings.push_back(check_about(run, found, of_elements, "the elements", "Try more elements"));
  }
  const auto of_modes = uncertain_by(found, [](const ErrorBar& bar, const Evidence& evidence) {
    return smaller(mode_part(evidence), bar.elements);
  });
  if (!of_modes.empty()) {
    findings.push_back(
        check_about(run, found, of_modes, "the modes of a \"reduction\"", "Try more modes"));
  }
  return findings;
}

namespace {

/// Share of the energy in motion. Errors of order h² are a few times larger in peaks than in
/// energy.
constexpr double small_energy_error = 1e-2;
/// Where so much is missing, vibrations are not seen that the motion has.
constexpr double large_energy_error = 0.1;

/// ", or a drive or a load jumps": of what there is.
std::string what_may_jump(const Scene& scene) {
  const bool has_drive =
      std::ranges::any_of(scene.joints, [](const Joint& joint) { return joint.drive.has_value(); });
  const bool has_spring = std::ranges::any_of(scene.loads, [](const Load& load) {
    return std::holds_alternative<SpringDamper>(load.element) ||
           std::holds_alternative<JointForce>(load.element);
  });
  const bool has_load = std::ranges::any_of(scene.loads, [](const Load& load) {
    return std::holds_alternative<PointLoad>(load.element);
  });
  std::vector<std::string> names;
  if (has_drive) names.emplace_back("a drive");
  if (has_load) names.emplace_back("a load");
  if (has_spring) names.emplace_back("a spring or motor");
  return names.empty() ? "" : fmt::format(", or {} jumps", fmt::join(names, " or "));
}

}  // namespace

std::vector<Finding> check_energy_balance(const TrustedRun& run) {
  const double error = run.monitors.energy_error;
  if (error <= small_energy_error) return {};
  return {{fmt::format("energy is balanced to {} of the largest in the motion only: steps are "
                       "too long for what moves here{}. Compare with a smaller "
                       "/simulation/step.",
                       rough_percent(error), what_may_jump(run.problem.scene)),
           error > large_energy_error}};
}

}  // namespace pleuel
