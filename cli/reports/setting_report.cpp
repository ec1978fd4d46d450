#include "cli/reports/setting_report.hpp"

#include <cmath>

#include <fmt/format.h>

#include "cli/text/table.hpp"
#include "cli/text/wrapped_text.hpp"
#include "core/base/number_text.hpp"
#include "core/scene/reading/override.hpp"

namespace pleuel {

namespace {

Json tried_document(const TriedSetting& tried) {
  return {{"step", tried.step},
          {"elements", tried.elements},
          {"error", number_or_null(tried.error)},
          {"response", tried.response}};
}

std::string step_text(double step) {
  return significant(1e3 * step, 3) + " ms";
}

std::string wanted_text(double share) {
  return fmt::format("{:.3g} %", 100.0 * share);
}

std::string error_text(const TriedSetting& setting) {
  return std::isfinite(setting.error) ? significant(100.0 * setting.error, 2) + " %"
                                      : std::string("not resolved");
}

/// Of several load cases one each, in their order.
Json settings_document(const std::vector<TriedSetting>& settings) {
  if (settings.size() == 1) return tried_document(settings.front());
  return {{"cases", list_of(settings, tried_document)}};
}

}  // namespace

Json overrides_document(const Json& effective, const ProblemFile& divided) {
  Json overrides = {{"/simulation/step", fmt::format("{} s", divided.simulation.step)}};
  if (divided.effects.tolerance > 0.0) {
    overrides["/effects/tolerance"] = divided.effects.tolerance;
  }
  for (const Body& body : divided.scene.bodies) {
    const auto* beam = std::get_if<BeamBody>(&body.shape);
    if (beam == nullptr || beam->is_rigid) continue;
    const std::string pointer = child_pointer("/scene/bodies", body.name);
    const Json& written = effective[Json::json_pointer(pointer)];
    if (!written.contains("segments")) {
      overrides[pointer + "/elements"] = beam->segments.front().elements;
      continue;
    }
    for (std::size_t i = 0; i < beam->segments.size(); ++i) {
      const std::string place = fmt::format("{}/segments/{}", pointer, i);
      const Segment& segment = beam->segments[i];
      overrides[place + "/elements"] = segment.elements;
      // Without it the lengths of segments would follow the elements.
      const bool has_share = written["segments"][i].contains("length_fraction");
      if (!has_share && segment.fraction) overrides[place + "/length_fraction"] = *segment.fraction;
    }
  }
  return overrides;
}

Json setting_document(const ProblemInput& input, const SettingChoice& choice) {
  Json document = tried_document(choice.chosen);
  document["target"] = input.problem.accuracy.target;
  document["met"] = choice.is_met;
  document["overrides"] = overrides_document(input.effective, choice.problem);
  document["tried"] = list_of(choice.tried, tried_document);
  return document;
}

std::string setting_text(const ProblemFile& problem, const SettingChoice& choice) {
  const std::string target = wanted_text(problem.accuracy.target);
  const TriedSetting& chosen = choice.chosen;
  const std::string setting = fmt::format(
      "a step of {}{}", step_text(chosen.step),
      chosen.elements > 0 ? fmt::format(" and {} elements in all", chosen.elements) : "");
  if (choice.is_met) {
    return wrapped(fmt::format("For {}: {}; \"{}\" is known to {} (settings tried: {}).\n", target,
                               setting, chosen.response, error_text(chosen), choice.tried.size()));
  }
  const std::string left =
      std::isfinite(chosen.error)
          ? fmt::format("leaves \"{}\" at {}", chosen.response, error_text(chosen))
      : chosen.response.empty()
          ? "cannot be simulated, or is too large for what a load or a drive does"
          : fmt::format("does not resolve \"{}\"", chosen.response);
  const std::string reason = choice.is_out_of_reach
                                 ? " The modes of reduced beams, or the tolerance of Newton's "
                                   "method, miss it by themselves."
                                 : "";
  return wrapped(
      fmt::format("No setting that was tried is known to keep {}; the best of {}, {}, {}.{}\n",
                  target, choice.tried.size(), setting, left, reason));
}

Json stages_document(const std::vector<Stage>& stages) {
  return list_of(stages, [](const Stage& stage) {
    Json one = Json::object();
    if (stage.target > 0.0) {
      one = settings_document(stage.settings);
      one["target"] = stage.target;
      one["met"] = stage.is_met;
      one["settings_tried"] = stage.settings_tried;
      one["choice_seconds"] = stage.choice_seconds;
    }
    one["evaluations"] = stage.evaluations;
    one["seconds"] = stage.seconds;
    return one;
  });
}

std::string stages_text(const std::vector<Stage>& stages) {
  Table table({"target", "step", "elements", "known to", left_aligned("by"), "found in",
               "evaluations", "seconds"});
  for (const Stage& stage : stages) {
    if (stage.target <= 0.0) continue;
    for (const TriedSetting& setting : stage.settings) {
      const bool is_first = &setting == &stage.settings.front();
      table.add_row({is_first ? wanted_text(stage.target) : "", step_text(setting.step),
                     setting.elements > 0 ? std::to_string(setting.elements) : "–",
                     error_text(setting), setting.response,
                     is_first ? duration(stage.choice_seconds) : "",
                     is_first ? std::to_string(stage.evaluations) : "",
                     is_first ? fmt::format("{:.2f}", stage.seconds) : ""});
    }
  }
  return table.is_empty() ? "" : table.text() + "\n";
}

}  // namespace pleuel
