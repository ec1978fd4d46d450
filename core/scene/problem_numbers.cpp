#include "core/scene/problem_numbers.hpp"

#include "core/base/error.hpp"
#include "core/scene/reading/document_reader.hpp"
#include "core/scene/scene_rules.hpp"

namespace pleuel {

namespace {

/// No variable can stand for these.
constexpr const char* gravity = "/scene/gravity/";

/// @throws InputError if a number would move a point along an elastic beam
void check_places(const ProblemFile& problem, const std::vector<NumberGroup>& groups) {
  const Design<double> start = start_values(problem.variables);
  const std::size_t first = problem.variables.size() - groups.size();
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const auto moved = find_point_moved_along(problem.scene, start, first + i);
    if (moved) throw InputError(groups[i].name + " " + *moved);
  }
}

std::string unit_written_in(const Json& value) {
  return value.is_string() ? split_quantity(value.get<std::string>()).unit : "";
}

}  // namespace

std::vector<SceneNumber> scene_numbers(const ProblemText& text) {
  const Json document = whole_document(text);
  const JsonNode root(document, text.file);
  NumberReader reader(variable_names(root));
  read_document(root, reader);
  std::vector<SceneNumber> numbers;
  for (const FixedNumber& fixed : reader.fixed_numbers()) {
    if (fixed.node.place().starts_with(gravity)) continue;
    numbers.push_back(
        {fixed.node.place(), fixed.value, fixed.quantity, unit_written_in(fixed.node.value())});
  }
  return numbers;
}

ProblemFile bind_numbers(const ProblemText& text, const std::vector<NumberGroup>& groups) {
  Json document = whole_document(text);
  for (const NumberGroup& group : groups) {
    const Json value = document[Json::json_pointer(group.pointers.front())];
    document["variables"][group.name] = {{"start", value}, {"lower", value}, {"upper", value}};
    for (const std::string& pointer : group.pointers) {
      document[Json::json_pointer(pointer)] = {{"variable", group.name}};
    }
  }
  const JsonNode root(document, text.file);
  NumberReader reader(variable_names(root));
  ProblemFile problem = read_document(root, reader);
  if (!problem.load_case.empty()) keep_case(problem);
  check_places(problem, groups);
  return problem;
}

}  // namespace pleuel
