#include "cli/files/run_again.hpp"

#include <utility>
#include <vector>

#include "cli/input/problem_input.hpp"
#include "core/response/analysis.hpp"
#include "core/response/effect_measurement.hpp"
#include "core/scene/problem_reader.hpp"

namespace pleuel {

std::string shown_case(const Json& result) {
  if (!result.contains("cases") || !result["cases"].is_object()) return "";
  const Json name = result["cases"].value("shown", Json());
  return name.is_string() ? name.get<std::string>() : "";
}

namespace {

/// The effects of the model that the result is of: where an optimization has ended, more of them may
/// matter than where it began.
/// @returns whether the result names them
bool take_effects(const Json& result, ProblemFile& problem) {
  if (problem.has_cases() || !result.contains("effects")) return false;
  EffectDecisions decisions;
  for (const Json& effect : result["effects"]) {
    if (!effect.contains("body") || effect.value("case", "") != problem.load_case) continue;
    const std::pair key(effect["body"].get<std::string>(), effect.at("name").get<std::string>());
    decisions.measured[key].is_needed = effect.at("built").get<bool>();
  }
  if (decisions.measured.empty()) return false;
  problem.effects.decisions = std::move(decisions);
  return true;
}

}  // namespace

ProblemFile problem_of(const Json& card, const Json& result) {
  return problem_of(card, result, shown_case(result));
}

ProblemFile problem_of(const Json& card, const Json& result, const std::string& load_case) {
  const std::string file = card.at("input").at("file").get<std::string>();
  Json document = card.at("problem"), setting = result.value("setting", Json::object());
  if (!load_case.empty()) {
    document = document_in_case(document, load_case, file);
    if (setting.contains("cases")) setting = setting["cases"].value(load_case, Json::object());
  }
  std::vector<std::string> overrides;
  if (setting.contains("overrides")) {
    for (const auto& [pointer, value] : setting["overrides"].items()) {
      overrides.push_back(pointer + "=" + value.dump());
    }
  }
  ProblemFile problem = read_problem_text(document.dump(), file, overrides).complete();
  problem.load_case = load_case;
  if (!take_effects(result, problem)) decide_effects(problem);
  return problem;
}

std::optional<Eigen::VectorXd> design_in(const Json& document, const ProblemFile& problem,
                                         const std::string& key) {
  Eigen::VectorXd x = start_design(problem);
  if (x.size() == 0) return x;
  if (!document.contains("variables")) return std::nullopt;
  for (std::size_t i = 0; i < problem.variables.size(); ++i) {
    const Json variable = document["variables"].value(problem.variables[i].name, Json());
    const Json value = key.empty() ? variable : variable.value(key, Json());
    if (!value.is_number()) return std::nullopt;
    x(i) = value.get<double>();
  }
  return x;
}

}  // namespace pleuel
