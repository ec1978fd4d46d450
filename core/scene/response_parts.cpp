#include "core/scene/response_parts.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "core/base/find_named.hpp"
#include "core/scene/load_cases.hpp"

namespace pleuel {

namespace {

/// @param is_made  whether a response counts as made from others
template <class IsMade>
void add_parts(const ProblemFile& problem, std::size_t response, const IsMade& is_made,
               std::set<std::size_t>& parts) {
  if (!is_made(response)) {
    parts.insert(response);
    return;
  }
  for (const ExpressionArgument& argument : formula_of(problem.responses[response])->arguments) {
    if (argument.kind != ExpressionArgument::Kind::response) continue;
    add_parts(problem, argument.index, is_made, parts);
  }
}

template <class IsMade>
std::vector<std::size_t> all_parts(const ProblemFile& problem, std::size_t response,
                                   const IsMade& is_made) {
  std::set<std::size_t> parts;
  add_parts(problem, response, is_made, parts);
  return {parts.begin(), parts.end()};
}

}  // namespace

std::vector<std::size_t> parts_of(const ProblemFile& problem, std::size_t response) {
  return all_parts(problem, response, [&](std::size_t one) {
    return problem.responses[one].is<ExpressionResponse>();
  });
}

std::vector<std::string> names_made_of(
    const ProblemFile& problem, const std::function<bool(const ResponseSettings&)>& is_meant) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < problem.responses.size(); ++i) {
    const auto is_part = [&](std::size_t part) { return is_meant(problem.responses[part]); };
    if (std::ranges::any_of(parts_of(problem, i), is_part)) {
      names.push_back(problem.responses[i].name);
    }
  }
  return names;
}

std::vector<std::string> bodies_about(const ResponseSettings& response, const Scene& scene) {
  std::vector<std::string> about = bodies_of(response);
  const Joint* joint = find_named(scene.joints, joint_of(response));
  if (joint != nullptr) about.insert(about.end(), joint->bodies.begin(), joint->bodies.end());
  return about;
}

std::vector<std::size_t> parts_in_cases(const ProblemFile& joined, std::size_t response) {
  return all_parts(joined, response, [&](std::size_t one) { return is_over_cases(joined, one); });
}

namespace {

/// @returns whether the step is an extreme of responses, which are added
bool add_extreme_parts(const Expression& expression, std::size_t step, Operation extreme,
                       std::set<std::size_t>& parts) {
  const ExpressionStep& one = expression.steps[step];
  if (one.operation == Operation::argument) {
    const ExpressionArgument& argument = expression.arguments[one.first];
    parts.insert(argument.index);
    return argument.kind == ExpressionArgument::Kind::response;
  }
  return one.operation == extreme && add_extreme_parts(expression, one.first, extreme, parts) &&
         add_extreme_parts(expression, one.second, extreme, parts);
}

}  // namespace

std::vector<std::size_t> extreme_parts(const ProblemFile& problem, std::size_t response,
                                       Extreme extreme) {
  const Expression* expression = formula_of(problem.responses[response]);
  if (expression == nullptr) return {};
  std::set<std::size_t> parts;
  const Operation operation = extreme == Extreme::largest ? Operation::larger : Operation::smaller;
  const bool is_one =
      add_extreme_parts(*expression, expression->steps.size() - 1, operation, parts);
  if (!is_one || parts.size() < 2) return {};
  return {parts.begin(), parts.end()};
}

namespace {

/// Σ factor · response + what depends on other numbers.
struct LinearForm {
  std::optional<double> number = {};  ///< of one that depends on nothing
  std::map<std::size_t, double> factors = {};
  std::set<std::size_t> others = {};  ///< responses that it depends on otherwise

  void add(const LinearForm& other, double factor) {
    const bool is_number = number && other.number;
    number = is_number ? std::optional(*number + factor * *other.number) : std::nullopt;
    for (const auto& [response, one] : other.factors) factors[response] += factor * one;
    others.insert(other.others.begin(), other.others.end());
  }
  /// Any function of this and others.
  void mix(const LinearForm& other) {
    add(other, 1.0);
    number.reset();
    for (const auto& [response, factor] : factors) others.insert(response);
  }
};

LinearForm times(double factor, const LinearForm& form) {
  LinearForm product{0.0};
  product.add(form, factor);
  return product;
}

LinearForm linear_form(const ProblemFile& problem, std::size_t response);

LinearForm linear_form(const ProblemFile& problem, const Expression& expression,
                       const ExpressionStep& step, const std::vector<LinearForm>& earlier) {
  if (step.operation == Operation::constant) return {step.constant};
  if (step.operation == Operation::argument) {
    const ExpressionArgument& argument = expression.arguments[step.first];
    const bool is_response = argument.kind == ExpressionArgument::Kind::response;
    return is_response ? linear_form(problem, argument.index) : LinearForm();
  }
  LinearForm form = earlier[step.first];
  const LinearForm second = step.second < 0 ? LinearForm{0.0} : earlier[step.second];
  switch (step.operation) {
    case Operation::plus:
      form.add(second, 1.0);
      return form;
    case Operation::minus:
      form.add(second, -1.0);
      return form;
    case Operation::negated:
      return times(-1.0, form);
    case Operation::times:
      if (second.number) return times(*second.number, form);
      if (form.number) return times(*form.number, second);
      break;
    case Operation::over:
      if (second.number) return times(1.0 / *second.number, form);
      break;
    default:
      break;
  }
  form.mix(second);
  return form;
}

LinearForm linear_form(const ProblemFile& problem, std::size_t response) {
  const Expression* expression = formula_of(problem.responses[response]);
  if (expression == nullptr) return {std::nullopt, {{response, 1.0}}};
  std::vector<LinearForm> forms;
  for (const ExpressionStep& step : expression->steps) {
    forms.push_back(linear_form(problem, *expression, step, forms));
  }
  return forms.back();
}

}  // namespace

std::vector<LinearPart> linear_parts(const ProblemFile& problem, std::size_t response) {
  if (formula_of(problem.responses[response]) == nullptr) return {};
  const LinearForm form = linear_form(problem, response);
  std::vector<LinearPart> parts;
  for (const auto& [part, factor] : form.factors) {
    if (factor != 0.0 && !form.others.contains(part)) parts.push_back({part, factor});
  }
  return parts;
}

bool is_monitor(const ProblemFile& problem, std::size_t response) {
  const std::vector<std::size_t> parts = parts_of(problem, response);
  return std::ranges::any_of(parts, [&](std::size_t part) {
    return problem.responses[part].is<EnergyBalanceResponse, DriftResponse>();
  });
}

bool depends_on_masses_only(const ProblemFile& problem, std::size_t response) {
  const std::vector<std::size_t> parts = parts_of(problem, response);
  return std::ranges::all_of(
      parts, [&](std::size_t part) { return problem.responses[part].is<MassResponse>(); });
}

}  // namespace pleuel
