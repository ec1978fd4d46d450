#include "cli/reports/over_cases_report.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "cli/reports/limits_report.hpp"
#include "cli/text/table.hpp"
#include "cli/text/wrapped_text.hpp"
#include "core/base/error.hpp"
#include "core/base/number_text.hpp"
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
  if (!document.contains("responses") && !document.contains("constraints")) return "";
  std::string text = "\nMade from several cases\n\n";
  const Json all = document.value("responses", Json::object());
  const bool has_deviations = std::any_of(
      all.begin(), all.end(), [](const Json& entry) { return entry.contains("deviation"); });
  std::vector<Table::Column> columns = {{"response", Table::Align::left}, {"value"}};
  if (has_deviations) columns.push_back({"deviation"});
  columns.push_back({"unit", Table::Align::left});
  Table responses(std::move(columns));
  for (const auto& item : all.items()) {
    const std::string& name = item.key();
    const Json& entry = item.value();
    const ShownUnit unit = unit_of(find_response(joined, name));
    const auto cell = [&](const char* key) {
      const Json number = entry.value(key, Json());
      return number.is_number() ? significant(unit.shown(number.get<double>())) : "–";
    };
    std::vector<std::string> row = {name, cell("value")};
    if (has_deviations) row.push_back(cell("deviation"));
    row.push_back(unit.name);
    responses.add_row(std::move(row));
  }
  if (!responses.is_empty()) text += responses.text();
  for (const Json& entry : all) {
    if (entry.contains("error")) text += "\n" + wrapped(entry["error"].get<std::string>()) + "\n";
  }
  const Json limited = document.value("constraints", Json::object());
  Table limits({{"constraint", Table::Align::left},
                {"value"},
                {"limit"},
                {"unit", Table::Align::left},
                {"", Table::Align::left}});
  for (const ConstraintSettings& constraint : joined.constraints) {
    if (!limited.contains(constraint.name)) continue;
    const Json& entry = limited.at(constraint.name);
    const ShownUnit unit = unit_of(joined, constraint);
    limits.add_row({constraint.name, significant(unit.shown(entry.at("value").get<double>())),
                    (entry.at("side") == "upper" ? "≤ " : "≥ ") +
                        significant(unit.shown(entry.at("limit").get<double>())),
                    unit.name, entry.at("kept").get<bool>() ? "kept" : "BROKEN"});
  }
  if (!limits.is_empty()) text += "\n" + limits.text();
  if (breaks_limits(document)) text += "\nA limit that is made from several cases is broken.\n";
  return text;
}

bool lacks_numbers(const Json& document) {
  const Json all = document.value("responses", Json::object());
  return std::any_of(all.begin(), all.end(),
                     [](const Json& entry) { return entry.contains("error"); });
}

bool breaks_limits(const Json& document) {
  const Json limited = document.value("constraints", Json::object());
  return std::any_of(limited.begin(), limited.end(),
                     [](const Json& entry) { return !entry.at("kept").get<bool>(); });
}

}  // namespace pleuel
