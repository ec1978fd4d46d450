#include "cli/files/run_again.hpp"

#include <vector>

#include "core/response/analysis.hpp"
#include "core/response/effect_measurement.hpp"
#include "core/scene/problem_reader.hpp"

namespace pleuel {

ProblemFile problem_of(const Json& card, const Json& result) {
  std::vector<std::string> overrides;
  if (result.contains("setting") && result["setting"].contains("overrides")) {
    for (const auto& [pointer, value] : result["setting"]["overrides"].items()) {
      overrides.push_back(pointer + "=" + value.dump());
    }
  }
  ProblemFile problem = read_problem_text(
      card.at("problem").dump(), card.at("input").at("file").get<std::string>(), overrides);
  decide_effects(problem);
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
