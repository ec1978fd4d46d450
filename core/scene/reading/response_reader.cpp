#include "core/scene/reading/response_reader.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/int_size.hpp"
#include "core/scene/grammar/response_table.hpp"
#include "core/scene/reading/case_suffix.hpp"
#include "core/scene/reading/joint_reader.hpp"
#include "core/scene/reading/mistakes.hpp"
#include "core/scene/reading/scene_reader.hpp"
#include "core/scene/reading/symbols.hpp"
#include "core/scene/reading/unit_scanner.hpp"
#include "core/scene/response_kind.hpp"
#include "core/scene/shown_unit.hpp"

namespace pleuel {

namespace {

/// Names of columns in files of histories (docs/reference/responses.md).
void check_column(const std::string& name, const JsonNode& node) {
  if (name == "time" || name.ends_with(":error")) {
    node.fail(
        "has a name that files of histories need for their own columns: \"time\" and \"…:error\"");
  }
}

/// Of the motion in a joint: which coordinate, if it has two.
void read_joint_coordinate(const JsonNode& node, const Scene& scene, ResponseSettings& response) {
  auto* motion = std::get_if<JointMotionResponse>(&response.what);
  if (motion == nullptr) return;
  const Joint& joint = *find_named(scene.joints, motion->joint);
  check_coordinate_between_bodies(node.at("joint"), joint);
  motion->coordinate = read_coordinate(node, joint);
}

/// But for formulas, which need all others.
ResponseSettings read_response(const std::string& name, const JsonNode& node,
                               const ResponseScope& scope, NumberReader& numbers) {
  ResponseSettings response{name, read_row(node.at("type"), response_kinds()).made};
  if (response.is<ExpressionResponse>()) return response;
  read_keys(node, numbers, [&](Keys& keys) { describe(keys, response, scope); }, {"type"});
  read_joint_coordinate(node, scope.scene, response);
  return response;
}

/// Reads the expressions among the responses.
/// @returns names of those that a document of one load case leaves out
std::set<std::string> read_expressions(const JsonNode& node, std::vector<ResponseSettings>& all,
                                       NumberReader& numbers) {
  std::set<std::string> left_out;
  MistakeCollector mistakes;
  for (ResponseSettings& one : all) {
    if (!one.is<ExpressionResponse>()) continue;
    mistakes.collect([&] {
      const bool is_read = numbers.read_or_leave_out(one.name, [&] {
        one = read_expression_response(one.name, node.at(one.name), all, numbers);
      });
      if (!is_read) left_out.insert(one.name);
    });
  }
  if (left_out.empty()) mistakes.fail_if_any();
  return left_out;
}

}  // namespace

std::vector<ResponseSettings> read_responses(const JsonNode& node, const Scene& scene,
                                             const SimulationSettings& simulation,
                                             NumberReader& numbers) {
  const ResponseScope scope{scene, simulation.end_time};
  std::vector<ResponseSettings> responses;
  read_each(node, [&](const std::string& name, const JsonNode& response) {
    check_column(name, response);
    responses.push_back(read_response(name, response, scope, numbers));
  });
  // Formulas know responses by their places, which are known when it is known which are left out.
  while (true) {
    std::vector<ResponseSettings> all = responses;
    const std::set<std::string> left_out = read_expressions(node, all, numbers);
    if (left_out.empty()) return all;
    std::erase_if(responses,
                  [&](const ResponseSettings& one) { return left_out.contains(one.name); });
  }
}

namespace {

using Kind = ExpressionArgument::Kind;

bool is_frequency(const ResponseSettings& response) {
  const Quantity quantity = quantity_of(response);
  return quantity.name == quantities::angular_frequency.name &&
         quantity.unit == quantities::angular_frequency.unit;
}

/// Of responses that are read: an expression without formula is not.
std::vector<Symbol> symbols_of(const std::vector<ResponseSettings>& responses) {
  std::vector<Symbol> symbols;
  for (std::size_t i = 0; i < responses.size(); ++i) {
    const bool is_read = !responses[i].is<ExpressionResponse>() || formula_of(responses[i]);
    if (!is_read) continue;
    symbols.push_back({responses[i].name, dimension_of(quantity_of(responses[i])), std::nullopt,
                       ExpressionArgument{Kind::response, i}});
  }
  return symbols;
}

/// rad/s made from frequencies is a frequency: limits on it take Hz, as on its parts.
void name_frequency(Expression& expression, const std::vector<ResponseSettings>& known) {
  if (expression.unit != quantities::angular_frequency.unit) return;
  const bool is_one =
      std::ranges::any_of(expression.arguments, [&](const ExpressionArgument& argument) {
        return argument.kind == Kind::response && is_frequency(known[argument.index]);
      });
  if (is_one) expression.quantity = quantities::angular_frequency.name;
}

ResponseSettings formula_response(const std::string& name, Expression formula) {
  return {name, ExpressionResponse{std::make_shared<const Expression>(std::move(formula))}};
}

ResponseSettings make_response(const std::string& name, const JsonNode& value,
                               const std::vector<ResponseSettings>& known, NumberReader& numbers) {
  Expression expression = *numbers.formula(value, symbols_of(known)).expression;
  name_frequency(expression, known);
  if (expression.arguments.empty()) {
    value.fail_with_value("must depend on a response or on a design variable");
  }
  return formula_response(name, std::move(expression));
}

/// The steps that the extreme of a formula is taken of, from the left to the right.
void add_leaves(const Expression& whole, int step, Operation extreme, std::vector<int>& leaves) {
  const ExpressionStep& one = whole.steps[step];
  if (one.operation != extreme) {
    leaves.push_back(step);
    return;
  }
  add_leaves(whole, one.first, extreme, leaves);
  add_leaves(whole, one.second, extreme, leaves);
}

/// The part of a formula that ends with this step: operands stand before what is made of them.
Expression part_ending_with(const Expression& whole, int last, const std::string& text) {
  const auto has_operands = [](const ExpressionStep& step) {
    return step.operation != Operation::argument && step.first >= 0;
  };
  int first = last;
  while (has_operands(whole.steps[first])) first = whole.steps[first].first;
  Expression part;
  part.text = text;
  part.quantity = whole.quantity;
  part.unit = whole.unit;
  for (int i = first; i <= last; ++i) {
    ExpressionStep step = whole.steps[i];
    if (has_operands(step)) {
      step.first -= first;
      if (step.second >= 0) step.second -= first;
    } else if (step.operation == Operation::argument) {
      const ExpressionArgument& argument = whole.arguments[step.first];
      const auto known = std::ranges::find(part.arguments, argument);
      step.first = static_cast<int>(known - part.arguments.begin());
      if (known == part.arguments.end()) part.arguments.push_back(argument);
    }
    part.steps.push_back(step);
  }
  return part;
}

/// "a" and "2*b" of "max(a, 2*b)".
std::vector<std::string> operand_texts(const std::string& formula) {
  std::vector<std::string> texts(1);
  int depth = 0;
  for (const char c : formula) {
    if (c == ')') --depth;
    if (c == ',' && depth == 1) {
      texts.emplace_back();
    } else if (depth >= 1) {
      texts.back() += c;
    }
    if (c == '(') ++depth;
  }
  for (std::string& text : texts) text = trimmed(text);
  return texts;
}

bool is_response(const Expression& expression, int step) {
  const ExpressionStep& one = expression.steps[step];
  return one.operation == Operation::argument &&
         expression.arguments[one.first].kind == Kind::response;
}

/// A formula max(…) or min(…) as that of responses: parts that are formulas themselves become responses
/// of their own, before it, so that each can be pressed upon by itself (response_parts.hpp).
void split_extreme(ResponseSettings& whole, std::vector<ResponseSettings>& responses) {
  const Expression& expression = *formula_of(whole);
  const Operation extreme = expression.steps.back().operation;
  if (extreme != Operation::larger && extreme != Operation::smaller) return;
  std::vector<int> leaves;
  add_leaves(expression, int_size(expression.steps) - 1, extreme, leaves);
  std::vector<std::string> texts = operand_texts(whole.name);
  const bool has_texts = texts.size() == leaves.size();
  std::vector<ResponseSettings> parts;
  Expression of_parts = expression;
  of_parts.arguments.clear();
  of_parts.steps.clear();
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    ExpressionArgument argument{Kind::response, responses.size() + parts.size()};
    if (is_response(expression, leaves[i])) {
      const auto& step = expression.steps[leaves[i]];
      argument = expression.arguments[step.first];
    } else {
      const bool is_variable = expression.steps[leaves[i]].operation == Operation::argument;
      const std::string name =
          has_texts && !is_variable ? texts[i] : fmt::format("{} [{}]", whole.name, i + 1);
      Expression part = part_ending_with(expression, leaves[i], name);
      const bool is_known = find_named(responses, name) || find_named(parts, name);
      if (part.arguments.empty() || is_known) return;
      parts.push_back(formula_response(name, std::move(part)));
    }
    of_parts.arguments.push_back(argument);
    of_parts.steps.push_back({Operation::argument, 0.0, static_cast<int>(i)});
    const int here = int_size(of_parts.steps) - 1;
    if (i > 0) of_parts.steps.push_back({extreme, 0.0, here - 1, here});
  }
  whole = formula_response(whole.name, std::move(of_parts));
  for (ResponseSettings& part : parts) responses.push_back(std::move(part));
}

/// "= a - b" → "a - b"
std::string formula_name(const JsonNode& node) {
  const std::string text = node.text();
  const std::size_t first = text.find_first_not_of(" =");
  return first == std::string::npos ? text : text.substr(first);
}

}  // namespace

ResponseSettings read_expression_response(const std::string& name, const JsonNode& node,
                                          const std::vector<ResponseSettings>& known,
                                          NumberReader& numbers) {
  node.allow_keys({"type", "value", "unit", "over_time"});
  if (const auto over_time = node.find("over_time")) {
    over_time->fail(
        "is not for an expression, which is made from responses that are reduced over time");
  }
  ResponseSettings response = make_response(name, node.at("value"), known, numbers);
  if (const auto unit = node.find("unit")) {
    response.unit = unit->text();
    try {
      response.unit_scale = unit_scale(response.unit, quantity_of(response));
    } catch (const UnitError& error) {
      unit->fail_with_value(fmt::format("must be a unit of {}, which the formula is",
                                        describe(quantity_of(response))),
                            fmt::format(": {}", error.what()));
    }
  }
  return response;
}

ResponseSettings& read_response_or_formula(const JsonNode& node,
                                           std::vector<ResponseSettings>& responses,
                                           NumberReader& numbers) {
  if (!is_formula(node)) {
    for (const std::string& name : {node.text(), spaced_case(node.text())}) {
      if (ResponseSettings* known = find_named(responses, name)) return *known;
    }
    numbers.require_here(node);
    return *find_named(responses, read_known_name(node, "response", names_of(responses)));
  }
  std::string name = formula_name(node);
  if (numbers.find_variable(name))
    name = "(" + name + ")";  // formulas mean the variable by its name
  if (ResponseSettings* known = find_named(responses, name)) return *known;
  ResponseSettings response = make_response(name, node, responses, numbers);
  split_extreme(response, responses);
  responses.push_back(std::move(response));
  return responses.back();
}

}  // namespace pleuel
