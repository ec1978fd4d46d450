#include "cli/reports/over_cases_report.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "cli/reports/limits_report.hpp"
#include "cli/text/wrapped_text.hpp"
#include "core/base/error.hpp"
#include "core/response/value_over_cases.hpp"
#include "core/scene/load_cases.hpp"
#include "core/scene/shown_unit.hpp"

namespace pleuel {

namespace {

/// What the document of its case says of a response of one case.
const Json& entry_of(const ProblemFile& joined, const Json& cases, std::size_t response) {
  const OfCase of_case = case_of_response(joined, response);
  const ProblemFile& one = joined.cases[of_case.load_case];
  return cases.at(one.load_case).at("responses").at(one.responses[of_case.index].name);
}

/// The methods that gradients of all parts were computed by; of `uncertainty` one without a name.
std::vector<std::string> common_methods(const ProblemFile& joined, const Json& cases,
                                        const std::vector<WeightedResponse>& parts) {
  std::vector<std::string> methods;
  for (const WeightedResponse& part : parts) {
    const Json& entry = entry_of(joined, cases, part.response);
    std::vector<std::string> here;
    const Json gradients = entry.value("gradients", Json::object());
    for (const auto& [method, gradient] : gradients.items()) {
      if (gradient.is_object()) here.push_back(method);
    }
    if (&part == &parts.front()) methods = here;
    std::erase_if(methods, [&](const std::string& method) {
      return std::find(here.begin(), here.end(), method) == here.end();
    });
  }
  return methods;
}

/// d(response)/d(variable), from the gradients that gradient_of() finds in the entries of its parts.
template <class GradientOf>
double slope_of(const ProblemFile& joined, const Json& cases, const LinearizedResponse& linear,
                std::size_t variable, const GradientOf& gradient_of) {
  double slope = linear.design(variable);
  for (const WeightedResponse& part : linear.parts) {
    const Json& gradient = gradient_of(entry_of(joined, cases, part.response));
    slope += part.weight * gradient.at(joined.variables[variable].name).template get<double>();
  }
  return slope;
}

void add_gradients(const ProblemFile& joined, const Json& cases, const LinearizedResponse& linear,
                   Json& entry) {
  for (const std::string& method : common_methods(joined, cases, linear.parts)) {
    for (std::size_t j = 0; j < joined.variables.size(); ++j) {
      entry["gradients"][method][joined.variables[j].name] = slope_of(
          joined, cases, linear, j,
          [&](const Json& part) -> const Json& { return part.at("gradients").at(method); });
    }
  }
}

/// First order, as of one case (studies/uncertainty.hpp): the parameters are the same in all of them.
void add_uncertainty(const ProblemFile& joined, const Json& cases, const LinearizedResponse& linear,
                     Json& entry) {
  double variance = 0.0, bound = 0.0;
  Json shares = Json::object();
  for (const UncertainParameter& parameter : joined.uncertainty->parameters) {
    const std::size_t variable = parameter.variable;
    const std::string& name = joined.variables[variable].name;
    const double slope =
        slope_of(joined, cases, linear, variable,
                 [](const Json& part) -> const Json& { return part.at("gradients"); });
    const double deviation = slope * parameter.standard_deviation();
    entry["gradients"][name] = slope;
    shares[name] = deviation * deviation;
    variance += deviation * deviation;
    bound += std::abs(slope) * parameter.half_width();
  }
  for (Json& share : shares) {
    if (variance > 0.0) share = share.get<double>() / variance;
  }
  const double value = entry.at("value").get<double>();
  entry["deviation"] = std::sqrt(variance);
  entry["bounds"] = {value - bound, value + bound};
  entry["shares"] = shares;
}

bool has_uncertainty(const Json& cases) {
  return cases.front().contains("parameters");
}

}  // namespace

Json over_cases_document(const ProblemFile& joined, const Eigen::VectorXd& x, const Json& cases) {
  const ValueInCase value_of = [&](std::size_t response) {
    return entry_of(joined, cases, response).at("value").get<double>();
  };
  Json document;
  for (std::size_t i = 0; i < joined.responses.size(); ++i) {
    if (!is_over_cases(joined, i)) continue;
    const ResponseSettings& response = joined.responses[i];
    Json& entry = document["responses"][response.name];
    entry = {{"value", nullptr}, {"unit", unit_of(response).si}};
    try {
      entry["value"] = value_over_cases(joined, i, x, value_of);
      const LinearizedResponse linear = linearized_over_cases(joined, i, x, value_of);
      if (has_uncertainty(cases)) {
        add_uncertainty(joined, cases, linear, entry);
      } else {
        add_gradients(joined, cases, linear, entry);
      }
    } catch (const SimulationError& error) {  // it has no value there, or no derivative
      entry["error"] = error.what();
    }
  }
  for (std::size_t i = 0; i < joined.constraints.size(); ++i) {
    if (!is_of_several(case_of_constraint(joined, i))) continue;
    const ConstraintSettings& constraint = joined.constraints[i];
    const ResponseSettings& limited = find_response(joined, constraint.response);
    const std::size_t response = &limited - joined.responses.data();
    try {
      document["constraints"][constraint.name] =
          limit_document(joined, constraint, x, value_over_cases(joined, response, x, value_of));
    } catch (const SimulationError&) {  // its response says so
    }
  }
  return document;
}

std::string over_cases_text(const ProblemFile& joined, const Json& document) {
  const Json responses = document.value("responses", Json::object());
  const Json limits = document.value("constraints", Json::object());
  if (responses.empty() && limits.empty()) return "";
  std::string text = "\nMade from several cases\n\n";
  const NamedUnits units = units_of_responses(joined), of_limits = units_of_limits(joined);
  std::vector<DocumentColumn> columns = {name_column("response"),
                                         shown_column("value", "/value", units)};
  const bool has_deviations = std::any_of(responses.begin(), responses.end(), [](const Json& one) {
    return one.contains("deviation");
  });
  if (has_deviations) columns.push_back(shown_column("deviation", "/deviation", units));
  columns.push_back(unit_column(units));
  if (!responses.empty()) text += table_of(responses, columns).text();
  for (const Json& entry : responses) {
    if (entry.contains("error")) text += "\n" + wrapped(text_at(entry, "/error")) + "\n";
  }
  if (!limits.empty()) {
    text += "\n" +
            table_of(limits, {name_column("constraint"), shown_column("value", "/value", of_limits),
                              limit_column(of_limits), unit_column(of_limits), kept_column()})
                .text();
  }
  if (!keeps_limits(limits)) text += "\nA limit that is made from several cases is broken.\n";
  return text;
}

bool lacks_numbers(const Json& document) {
  const Json all = document.value("responses", Json::object());
  return std::any_of(all.begin(), all.end(),
                     [](const Json& entry) { return entry.contains("error"); });
}

}  // namespace pleuel
