#include "core/scene/response_parts.hpp"

#include <algorithm>
#include <set>

namespace pleuel {

namespace {

void add_parts(const ProblemFile& problem, std::size_t response, std::set<std::size_t>& parts) {
  const ResponseSettings& settings = problem.responses[response];
  if (settings.type != ResponseType::expression) {
    parts.insert(response);
    return;
  }
  for (const ExpressionArgument& argument : settings.expression->arguments) {
    if (argument.kind == ExpressionArgument::Kind::response) {
      add_parts(problem, argument.index, parts);
    }
  }
}

}  // namespace

std::vector<std::size_t> parts_of(const ProblemFile& problem, std::size_t response) {
  std::set<std::size_t> parts;
  add_parts(problem, response, parts);
  return {parts.begin(), parts.end()};
}

bool is_monitor(const ProblemFile& problem, std::size_t response) {
  const std::vector<std::size_t> parts = parts_of(problem, response);
  return std::any_of(parts.begin(), parts.end(), [&](std::size_t part) {
    const ResponseType type = problem.responses[part].type;
    return type == ResponseType::energy_balance || type == ResponseType::constraint_drift;
  });
}

}  // namespace pleuel
