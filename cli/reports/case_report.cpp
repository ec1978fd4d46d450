#include "cli/reports/case_report.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include <fmt/format.h>

#include "cli/reports/limits_report.hpp"
#include "cli/text/wrapped_text.hpp"
#include "core/base/error.hpp"
#include "core/base/number_text.hpp"
#include "core/base/plain_file_name.hpp"
#include "core/response/value_over_cases.hpp"
#include "core/scene/case_goals.hpp"
#include "core/scene/load_cases.hpp"
#include "core/scene/shown_unit.hpp"

namespace pleuel {

namespace {

/// Shares below this are round-off of the multipliers.
constexpr double least_share = 1e-3;

/// How far a value is beyond its limit, relative to the limit; negative within.
double excess(const ConstraintSettings& constraint, double value) {
  const auto beyond = [&](double limit, double sign) {
    const double size = std::max(std::abs(limit), std::numeric_limits<double>::min());
    return sign * (value - limit) / size;
  };
  double most = -std::numeric_limits<double>::infinity();
  if (constraint.upper) most = std::max(most, beyond(*constraint.upper, 1.0));
  if (constraint.lower) most = std::max(most, beyond(*constraint.lower, -1.0));
  return most;
}

/// What an objective over cases takes from each of them: the largest one decides.
Eigen::VectorXd weighted_objectives(const ProblemFile& problem, const Eigen::VectorXd& objectives) {
  Eigen::VectorXd weighted = problem.objective->sign() * objectives;
  if (problem.objective->over_cases != OverCases::weighted) return weighted;
  for (std::size_t c = 0; c < problem.cases.size(); ++c) {
    weighted(c) *= problem.case_weights[c];
  }
  return weighted;
}

/// What one percent more of the limit would be worth.
double worth(const ProblemFile& problem, const Result& result, std::size_t constraint) {
  const ConstraintSettings& limits = problem.constraints[constraint];
  const double multiplier = result.constraint_multipliers(constraint);
  const std::optional<double>& limit = multiplier > 0.0 ? limits.upper : limits.lower;
  return std::abs(multiplier * limit.value_or(0.0));
}

/// The largest of a number of each limit, case by case. @returns empty if no limit is of one case
template <class NumberOfLimit>
Eigen::VectorXd largest_in_cases(const ProblemFile& problem, const NumberOfLimit& number_of) {
  constexpr double none = -std::numeric_limits<double>::infinity();
  Eigen::VectorXd largest = Eigen::VectorXd::Constant(problem.cases.size(), none);
  for (std::size_t i = 0; i < problem.constraints.size(); ++i) {
    if (case_of(problem, i).empty()) continue;
    double& here = largest(problem.case_constraints[i].load_case);
    here = std::max(here, number_of(i));
  }
  return largest.maxCoeff() > none ? largest : Eigen::VectorXd();
}

/// By what a case decides, the weightiest first: its share in an objective over cases or its value
/// of it, what its limits cost, how far they are used. Those that are not known are empty.
std::vector<Eigen::VectorXd> measures_of_cases(const ProblemFile& problem, const Result& result) {
  std::vector<Eigen::VectorXd> measures;
  if (result.case_shares.size() > 0) {
    measures.push_back(result.case_shares);
  } else if (result.case_objectives.size() > 0) {
    measures.push_back(weighted_objectives(problem, result.case_objectives));
  }
  if (has_prices(result)) {
    measures.push_back(largest_in_cases(
        problem, [&](std::size_t limit) { return worth(problem, result, limit); }));
  }
  const Eigen::VectorXd& values = result.evaluation.constraints;
  if (values.size() == std::ssize(problem.constraints)) {
    measures.push_back(largest_in_cases(problem, [&](std::size_t limit) {
      return excess(problem.constraints[limit], values(limit));
    }));
  }
  return measures;
}

/// Leaves those whose number is the largest, within what round-off makes of equal ones.
void keep_largest(const Eigen::VectorXd& numbers, std::vector<std::size_t>& cases) {
  if (numbers.size() == 0) return;
  const double largest = numbers(cases).maxCoeff();
  if (!std::isfinite(largest)) return;
  const double least = largest - least_share * std::abs(largest);
  std::erase_if(cases, [&](std::size_t c) { return numbers(c) < least; });
}

/// Of equal ones that of the first limit in conflict, where limits are; else the first.
std::size_t first_in_conflict(const ProblemFile& problem, const std::vector<std::size_t>& cases,
                              const Result& result) {
  if (!result.least_violation) return cases.front();
  for (const ExceededLimit& limit : result.least_violation->limits) {
    if (case_of(problem, limit.constraint).empty()) continue;
    const std::size_t here = problem.case_constraints[limit.constraint].load_case;
    if (std::ranges::find(cases, here) != cases.end()) return here;
  }
  return cases.front();
}

/// What the document of its case says of a response of one case.
const Json& entry_of(const ProblemFile& joined, const Json& cases, std::size_t response) {
  const OfCase of_case = case_of_response(joined, response);
  const ProblemFile& one = joined.cases[of_case.load_case];
  return cases.at(one.load_case).at("responses").at(one.responses[of_case.index].name);
}

/// The derivatives that stand there in the entries of all parts; none if one of them has none.
std::optional<Eigen::VectorXd> gradient_at(const ProblemFile& joined, const Json& cases,
                                           const LinearizedResponse& linear,
                                           const Json::json_pointer& place) {
  Eigen::VectorXd gradient = linear.design;
  for (const WeightedResponse& part : linear.parts) {
    const Json slopes = entry_of(joined, cases, part.response).value(place, Json());
    if (!slopes.is_object()) return std::nullopt;
    for (Eigen::Index j = 0; j < gradient.size(); ++j) {
      gradient(j) += part.weight * slopes.value(joined.variables[j].name, 0.0);
    }
  }
  return gradient;
}

/// By each method that the gradients of all parts were computed by.
void add_gradients(const ProblemFile& joined, const Json& cases, const LinearizedResponse& linear,
                   Json& entry) {
  if (linear.parts.empty()) return;
  const Json& first = entry_of(joined, cases, linear.parts.front().response);
  const Json methods = first.value("gradients", Json::object());
  for (const auto& [method, unused] : methods.items()) {
    const auto gradient =
        gradient_at(joined, cases, linear, Json::json_pointer("/gradients") / method);
    if (gradient) entry["gradients"][method] = by_name(joined.variables, *gradient);
  }
}

}  // namespace

std::string case_of(const ProblemFile& problem, std::size_t constraint) {
  const bool is_of_case = problem.has_cases() &&
                          limit_name(problem, constraint) != problem.constraints[constraint].name;
  return is_of_case ? problem.cases[problem.case_constraints[constraint].load_case].load_case : "";
}

std::string cases_of_limit(const ProblemFile& problem, std::size_t constraint) {
  if (is_of_several(case_of_constraint(problem, constraint))) return "several";
  const std::string load_case = case_of(problem, constraint);
  return load_case.empty() ? "all" : load_case;
}

std::vector<bool> deciding_constraints(const ProblemFile& problem, const Eigen::VectorXd& values) {
  std::map<std::string, std::size_t> deciding;
  const auto excess_of = [&](std::size_t i) { return excess(problem.constraints[i], values(i)); };
  for (std::size_t i = 0; i < problem.constraints.size(); ++i) {
    const auto [known, is_new] = deciding.emplace(limit_name(problem, i), i);
    if (!is_new && excess_of(i) > excess_of(known->second)) known->second = i;
  }
  std::vector<bool> is_deciding(problem.constraints.size(), false);
  for (const auto& [limit, i] : deciding) is_deciding[i] = true;
  return is_deciding;
}

std::size_t deciding_case(const ProblemFile& problem, const Result& result) {
  std::vector<std::size_t> cases(problem.cases.size());
  std::iota(cases.begin(), cases.end(), std::size_t{0});
  for (const Eigen::VectorXd& measure : measures_of_cases(problem, result)) {
    keep_largest(measure, cases);
  }
  return first_in_conflict(problem, cases, result);
}

Json cases_document(const ProblemFile& problem, const Result& result) {
  Json document = {{"names", list_of(problem.cases, &ProblemFile::load_case)}};
  document["shown"] = problem.cases[deciding_case(problem, result)].load_case;
  for (std::size_t c = 0; c < problem.cases.size(); ++c) {
    const std::string& name = problem.cases[c].load_case;
    if (result.case_objectives.size() > 0) document["objective"][name] = result.case_objectives(c);
    if (result.case_shares.size() > 0) document["shares"][name] = result.case_shares(c);
  }
  return document;
}

std::string objective_in_cases(const ProblemFile& problem, const Result& result) {
  if (!problem.has_cases() || result.case_objectives.size() == 0) return "";
  const ShownUnit unit = unit_of(find_response(problem, problem.objective->response));
  std::string text;
  for (std::size_t c = 0; c < problem.cases.size(); ++c) {
    const bool has_share = result.case_shares.size() > 0 && result.case_shares(c) > least_share;
    text += fmt::format("{}{} {}{}", text.empty() ? "" : ", ", problem.cases[c].load_case,
                        significant(unit.shown(result.case_objectives(c))),
                        has_share ? " (decides)" : "");
  }
  return fmt::format("  in the cases [{}]: {}\n", unit.name, text);
}

std::string name_of_case_file(const std::string& stem, const ProblemFile& load_case) {
  const std::string name = load_case.load_case;
  return fmt::format("{}{}.csv", stem, name.empty() ? "" : "-" + plain_file_name(name));
}

Json uncertain_document(const ProblemFile& problem, const UncertainResponse& response) {
  std::vector<DesignVariable> parameters;
  for (const UncertainParameter& parameter : problem.uncertainty->parameters) {
    parameters.push_back(problem.variables[parameter.variable]);
  }
  return {{"deviation", response.deviation},
          {"bounds", {response.value - response.bound, response.value + response.bound}},
          {"shares", by_name(parameters, response.shares)},
          {"gradients", by_name(parameters, response.gradient)}};
}

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
      if (cases.front().contains("parameters")) {  // of `uncertainty`
        const auto gradient = gradient_at(joined, cases, linear, Json::json_pointer("/gradients"));
        entry.update(uncertain_document(
            joined, first_order(*joined.uncertainty, entry["value"], gradient.value())));
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
  const bool has_deviations =
      std::ranges::any_of(responses, [](const Json& one) { return one.contains("deviation"); });
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
  if (!broken_limits(limits).empty())
    text += "\nA limit that is made from several cases is broken.\n";
  return text;
}

bool lacks_numbers(const Json& document) {
  const Json all = document.value("responses", Json::object());
  return std::ranges::any_of(all, [](const Json& entry) { return entry.contains("error"); });
}

}  // namespace pleuel
