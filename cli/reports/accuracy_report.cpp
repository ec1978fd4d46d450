#include "cli/reports/accuracy_report.hpp"

#include <algorithm>
#include <cmath>

#include "cli/reports/outcome.hpp"
#include "cli/reports/time_text.hpp"
#include "cli/reports/warnings.hpp"
#include "cli/text/table.hpp"
#include "cli/text/wrapped_text.hpp"
#include "core/base/find_named.hpp"
#include "core/base/number_text.hpp"
#include "core/base/quoted.hpp"

namespace pleuel {

namespace {

/// Relative changes below this are round-off.
constexpr double no_change = 1e-9;
/// Share of the time below which nothing is said to be saved.
constexpr double least_saving = 0.05;
/// How many knobs are recommended.
constexpr std::size_t most_knobs = 2;

/// "0.031 %"
std::string share_text(double share) {
  return share == 0.0 ? "0 %" : significant(100.0 * share, 2) + " %";
}

/// The largest of the errors that count and whose it is: "0.031 % rod_stress"; with "≤" if it is
/// below that of the reference, which then stands there.
std::string worst(const ProblemFile& problem, const AccuracyStudy& study, const AccuracyRun& run,
                  Eigen::VectorXd AccuracyRun::*kind) {
  const Eigen::VectorXd& errors = run.*kind;
  if (errors.size() == 0 || study.counted.empty()) return "–";
  std::size_t index = study.counted.front();
  for (const std::size_t i : study.counted) {
    if (errors(i) > errors(index)) index = i;
  }
  const bool is_bound = errors(index) > 0.0 && errors(index) <= (study.reference.*kind)(index);
  return fmt::format("{}{} {}", is_bound ? "≤ " : "", share_text(errors(index)),
                     problem.responses[index].name);
}

std::string first_sentence(const std::string& text) {
  return text.substr(0, text.find(". "));
}

bool is_recommended(const AccuracyStudy& study, std::size_t run) {
  return !study.recommendations.empty() && study.recommendations.front().values == run;
}

std::string runs_text(const ProblemFile& problem, const AccuracyStudy& study) {
  Table table(
      {"step [ms]", "elements", left_aligned("largest error"), left_aligned("of a gradient"),
       "simulation [ms]", "gradient [ms]", "steps", "factorizations", left_aligned("")},
      2);
  for (std::size_t i = 0; i < study.runs.size(); ++i) {
    const AccuracyRun& run = study.runs[i];
    std::vector<std::string> cells = {fmt::format("{:.4g}", 1e3 * run.settings.step),
                                      elements_text(run.settings)};
    if (run.has_failed()) {
      cells.insert(cells.end(), {"failed", first_sentence(run.failure)});
    } else {
      cells.insert(cells.end(), {worst(problem, study, run, &AccuracyRun::errors),
                                 worst(problem, study, run, &AccuracyRun::gradient_errors),
                                 fmt::format("{:.1f}", 1e3 * run.simulation_seconds),
                                 fmt::format("{:.1f}", 1e3 * run.gradient_seconds),
                                 std::to_string(run.steps), std::to_string(run.factorizations)});
    }
    if (is_recommended(study, i)) cells.push_back("← recommended");
    table.add_row(std::move(cells));
  }
  return table.text();
}

/// "For 1 % take a step of 0.2 ms and 4 elements a segment: 9.7 ms a simulation; for gradients …"
std::string recommendation_text(const AccuracyStudy& study, const Recommendation& one) {
  if (!one.values) {
    return fmt::format("For {} none of these settings will do. ", target_text(one.target));
  }
  const AccuracyRun& run = study.runs[*one.values];
  std::string text = fmt::format("For {} take {}: {} a simulation", target_text(one.target),
                                 setting_text(run.settings), milliseconds(run.simulation_seconds));
  if (run.gradient_errors.size() == 0) return text + ". ";
  if (!one.gradients) return text + "; gradients are not as exact with any of them. ";
  if (one.gradients == one.values) {
    return text + fmt::format(", {} with gradients as exact. ", milliseconds(run.seconds()));
  }
  const AccuracyRun& other = study.runs[*one.gradients];
  return text + fmt::format("; for gradients as exact {}, {} with them. ",
                            setting_text(other.settings), milliseconds(other.seconds()));
}

std::string recommendations_text(const AccuracyStudy& study) {
  if (study.recommendations.empty()) {
    return "Nothing is recommended before all runs are done.\n";
  }
  std::string text;
  for (const Recommendation& one : study.recommendations) {
    text += recommendation_text(study, one);
    if (!one.values) break;  // nor for less
  }
  return text + "\n";
}

/// "13 ± 2 % less time", "the same work"
std::string time_text(const ComparedTime& time) {
  if (is_same(time)) return "the same work";
  if (!time.is_measurable()) return "no measurable difference of time";
  return percent_with_spread(time) + (time.change < 0.0 ? " less time" : " more time");
}

std::string signed_share(double share) {
  return signed_significant(100.0 * share, 2) + " %";
}

/// Of the response that counts and changes most: "rod_bow −18 %".
std::string worst_change(const ProblemFile& problem, const AccuracyStudy& study,
                         const VariedRun& varied) {
  std::size_t worst = 0;
  double share = 0.0;
  for (const std::size_t i : study.counted) {
    const double size =
        std::max(std::abs(study.reference.values(i)), 1e-3 * study.reference.magnitudes(i));
    const double change = size > 0.0 ? varied.influence(i) / size : 0.0;
    if (std::abs(change) > std::abs(share)) share = change, worst = i;
  }
  if (std::abs(share) < no_change) return "no change";
  return problem.responses[worst].name + " " + signed_share(share);
}

double objective_size(const ProblemFile& problem, const AccuracyStudy& study) {
  const auto index = index_of_named(problem.responses, problem.objective->response);
  return index ? std::abs(study.reference.values(*index)) : 0.0;
}

/// What leaving out an effect, or including it, changes: of the optimum, or of the worst response.
std::string influence_text(const ProblemFile& problem, const AccuracyStudy& study,
                           const VariedRun& varied) {
  if (!varied.run.optimum_change) return worst_change(problem, study, varied);
  const ResponseSettings& objective = find_response(problem, problem.objective->response);
  const double change = *varied.run.optimum_change;
  if (std::abs(change) <= no_change * objective_size(problem, study)) return "no change";
  return change_text(objective, change);
}

/// "Without geometric stiffening: 13 % less time, +7.8 g. "
std::string effects_text(const ProblemFile& problem, const AccuracyStudy& study) {
  std::string text;
  for (const VariedRun& one : study.effects) {
    const bool is_without = one.variation.value == "off";
    text += fmt::format("{} {}: ", is_without ? "Without" : "With", words_of(one.variation.knob));
    if (one.run.has_failed()) {
      text += fmt::format("fails, as {}. ", excerpt(one.run.failure, 160));
    } else {
      text += fmt::format("{}, {}. ", time_text(one.time), influence_text(problem, study, one));
    }
  }
  return text.empty() ? text : text + "\n";
}

/// Knobs that save time and keep the error that is asked for; the best first.
std::vector<const VariedRun*> knobs_that_pay(const AccuracyStudy& study) {
  std::vector<const VariedRun*> all;
  if (study.recommendations.empty() || !study.recommendations.front().values) return all;
  const double target = study.recommendations.front().target;
  for (const VariedRun& one : study.knobs) {
    if (one.run.has_failed() || study.counted_error(one.run.errors) > target) continue;
    if (one.time.is_measurable() && one.time.change < -least_saving) all.push_back(&one);
  }
  std::ranges::stable_sort(all, [](const VariedRun* one, const VariedRun* other) {
    return one->time.change < other->time.change;
  });
  if (all.size() > most_knobs) all.resize(most_knobs);
  return all;
}

/// "With newton_tolerance 1e-6: 24 % less time, and still within 1 %. "
std::string knobs_text(const AccuracyStudy& study) {
  std::string text;
  for (const VariedRun* one : knobs_that_pay(study)) {
    text += fmt::format("With {}: {}, and still within {}. ", variation_text(one->variation),
                        time_text(one->time), target_text(study.recommendations.front().target));
  }
  return text.empty() ? text : text + "\n";
}

std::string variations_text(const ProblemFile& problem, const AccuracyStudy& study) {
  if (study.knobs.empty()) return "";
  Table table({left_aligned("one by one"), "time", "run [ms]", left_aligned("largest error"),
               left_aligned("of a gradient")});
  for (const VariedRun& one : study.knobs) {
    std::vector<std::string> cells = {variation_text(one.variation)};
    if (one.run.has_failed()) {
      cells.insert(cells.end(), {"–", "–", "failed"});
    } else {
      cells.insert(cells.end(), {time_change_text(one.time),
                                 fmt::format("{:.1f}", 1e3 * one.run.simulation_seconds),
                                 worst(problem, study, one.run, &AccuracyRun::errors),
                                 worst(problem, study, one.run, &AccuracyRun::gradient_errors)});
    }
    table.add_row(std::move(cells));
  }
  return wrapped(fmt::format("Changed at {}:", setting_text(study.runs[*study.base].settings))) +
         "\n\n" + table.text() + "\n";
}

std::string largest_of(const AccuracyStudy& study, const Eigen::VectorXd& errors) {
  return errors.size() == 0 ? "–" : share_text(study.counted_error(errors));
}

std::string counted_text(const ProblemFile& problem, const AccuracyStudy& study) {
  if (study.counted.size() == problem.responses.size()) return "all responses";
  if (study.counted.empty()) return "no response";
  std::vector<std::string> names;
  for (const std::size_t i : study.counted) names.push_back(problem.responses[i].name);
  return fmt::format("what is minimized or limited ({})", fmt::join(names, ", "));
}

std::string check_text(const AccuracyStudy& study) {
  const ReferenceCheck& check = study.check;
  if (!check.failure.empty()) {
    return fmt::format(" It could not be compared with {}: {}.", check.formulation,
                       first_sentence(check.failure));
  }
  return fmt::format(" The formulation {} differs from it by {} at most.", check.formulation,
                     largest_of(study, check.differences));
}

std::string reference_text(const ProblemFile& problem, const AccuracyStudy& study) {
  return wrapped(fmt::format(
      "Errors are those of {}, relative to a reference with {} ({}), whose own error is "
      "estimated at {}, of gradients {} (≤: below that).{} Times are processor times.",
      counted_text(problem, study), setting_text(study.reference.settings),
      duration(study.reference.seconds()), largest_of(study, study.reference.errors),
      largest_of(study, study.reference.gradient_errors), check_text(study)));
}

/// "An optimum to 1 %: 0.05 s with a step of 0.2 ms and 4 elements a segment, +0.24 g off. "
std::string optimum_sentence(const ProblemFile& problem, const OptimumStudy& optima,
                             double target) {
  const OptimumRun* best = nullptr;
  for (const OptimumRun& run : optima.runs) {
    if (run.has_failed() || optima.relative_error(run) > target) continue;
    if (best == nullptr || run.seconds < best->seconds) best = &run;
  }
  if (best == nullptr) {
    return fmt::format("An optimum to {} needs a finer setting than these. ", target_text(target));
  }
  const ResponseSettings& objective = find_response(problem, problem.objective->response);
  return fmt::format("An optimum to {}: {} with {}, {} off. ", target_text(target),
                     duration(best->seconds), setting_text(best->settings),
                     change_text(objective, best->change));
}

std::string optimum_sentences(const ProblemFile& problem, const AccuracyStudy& study,
                              const OptimumStudy* optima) {
  if (optima == nullptr || optima->reference.has_failed()) return "";
  std::string text;
  for (const Recommendation& one : study.recommendations) {
    text += optimum_sentence(problem, *optima, one.target);
  }
  return text + "\n";
}

std::string optima_text(const ProblemFile& problem, const OptimumStudy* optima) {
  if (optima == nullptr) return "";
  const OptimumRun& reference = optima->reference;
  if (reference.has_failed()) {
    return wrapped(fmt::format("No optimum with {} to compare others with: {}",
                               setting_text(reference.settings), reference.failure)) +
           "\n\n";
  }
  const ResponseSettings& objective = find_response(problem, problem.objective->response);
  const ShownUnit unit = unit_of(objective);
  Table table({"step [ms]",
               "elements",
               {"optimum [" + unit.name + "]"},
               "off by",
               "relative",
               "seconds",
               "evaluations",
               left_aligned("status")},
              2);
  for (const OptimumRun& run : optima->runs) {
    std::vector<std::string> cells = {fmt::format("{:.4g}", 1e3 * run.settings.step),
                                      elements_text(run.settings)};
    if (run.has_failed()) {
      cells.insert(cells.end(), {"–", "–", "–"});
    } else {
      const double error = optima->relative_error(run);
      cells.insert(cells.end(),
                   {significant(unit.shown(run.objective), 6), change_text(objective, run.change),
                    (error <= optima->relative_floor() ? "≤ " : "") + share_text(error)});
    }
    cells.insert(cells.end(), {significant(run.seconds, 2), std::to_string(run.evaluations),
                               to_string(run.status)});
    table.add_row(std::move(cells));
  }
  const std::string known = optima->reference_error
                                ? "± " + change_text(objective, *optima->reference_error).substr(1)
                                : std::string("error not known");
  return "Whole optimizations:\n\n" + table.text() + "\n" +
         wrapped(fmt::format("Compared with the optimum of {} {} ({}) with {}, {}.",
                             significant(unit.shown(reference.objective), 6), unit.name, known,
                             setting_text(reference.settings), to_string(reference.status))) +
         "\n\n";
}

}  // namespace

std::string division_text(const Discretization& settings) {
  if (settings.elements > 0) {
    return fmt::format("{} element{} a segment", settings.elements,
                       settings.elements == 1 ? "" : "s");
  }
  const std::string times =
      settings.factor == 1.0 ? "" : fmt::format("{:g} times ", settings.factor);
  return times + "the elements of the file";
}

std::string elements_text(const Discretization& settings) {
  return settings.elements > 0 ? std::to_string(settings.elements)
                               : fmt::format("×{:g}", settings.factor);
}

std::string setting_text(const Discretization& settings) {
  return fmt::format("a step of {:.4g} ms and {}", 1e3 * settings.step, division_text(settings));
}

std::string variation_text(const Variation& variation) {
  return variation.knob + " " + variation.value;
}

std::string milliseconds(double seconds) {
  const double shown = 1e3 * seconds;
  return shown < 9.95 ? fmt::format("{:.2g} ms", shown) : fmt::format("{:.0f} ms", shown);
}

std::string target_text(double target) {
  return fmt::format("{:g} %", 100.0 * target);
}

std::string change_text(const ResponseSettings& response, double change) {
  ShownUnit unit = unit_of(response);
  if (unit.si == "kg" && std::abs(change) < 1.0) unit = {"kg", "g", 1e-3};
  return signed_significant(unit.shown(change), 2) + unit.suffix();
}

std::string accuracy_text(const ProblemFile& problem, const AccuracyStudy& study,
                          const OptimumStudy* optima, bool is_verbose) {
  const std::size_t all = accuracy_grid(problem).size();
  std::string text = study.is_interrupted ? interrupted_text(study.runs.size(), all, "runs") : "";
  text += wrapped(problem.name + ": " + recommendations_text(study));
  text += wrapped(optimum_sentences(problem, study, optima));
  text += wrapped(knobs_text(study)) + wrapped(effects_text(problem, study)) + "\n";
  if (is_verbose) {
    text += runs_text(problem, study) + "\n" + optima_text(problem, optima);
    text += variations_text(problem, study) + reference_text(problem, study) + "\n";
  }
  return text + warnings_text(warnings_of(study));
}

}  // namespace pleuel
