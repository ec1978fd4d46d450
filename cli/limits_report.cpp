#include "cli/limits_report.hpp"

#include <algorithm>
#include <cmath>

#include "cli/optimum.hpp"
#include "cli/table.hpp"
#include "core/base/number_text.hpp"
#include "core/scene/shown_unit.hpp"
#include "optimization/verdict.hpp"

namespace pleuel {

namespace {

double value_of(const ConstraintSettings& constraint, const ProblemFile& problem,
                const Eigen::VectorXd& x, const Analysis& analysis) {
  double value = 0.0;
  for (const auto& [variable, coefficient] : constraint.linear) value += coefficient * x(variable);
  if (!constraint.linear.empty()) return value;
  const ResponseSettings& response = find_response(problem, constraint.response);
  return analysis.reductions[static_cast<std::size_t>(&response - problem.responses.data())].value;
}

/// As exactly as a verified optimum keeps its limits.
bool is_kept(const ConstraintSettings& constraint, double value) {
  const auto exceeds = [](double excess, double limit) {
    return excess > Tolerances().violation * std::abs(limit);
  };
  return !(constraint.upper && exceeds(value - *constraint.upper, *constraint.upper)) &&
         !(constraint.lower && exceeds(*constraint.lower - value, *constraint.lower));
}

}  // namespace

Json limits_document(const ProblemFile& problem, const Eigen::VectorXd& x,
                     const Analysis& analysis) {
  Json document = Json::object();
  for (const ConstraintSettings& constraint : problem.constraints) {
    const double value = value_of(constraint, problem, x, analysis);
    const UsedLimit used = used_limit(constraint, value);
    Json& entry = document[constraint.name];
    entry = {{"value", value},
             {"limit", used.limit},
             {"side", used.is_upper ? "upper" : "lower"},
             {"unit", unit_of(problem, constraint).si}};
    if (used.utilisation) entry["utilisation"] = *used.utilisation;
    entry["kept"] = is_kept(constraint, value);
  }
  return document;
}

std::string limits_text(const ProblemFile& problem, const Eigen::VectorXd& x,
                        const Analysis& analysis) {
  Table table({{"constraint", Table::Align::left},
               {"value"},
               {"limit"},
               {"unit", Table::Align::left},
               {"used"},
               {"", Table::Align::left}});
  for (const ConstraintSettings& constraint : problem.constraints) {
    const double value = value_of(constraint, problem, x, analysis);
    const UsedLimit used = used_limit(constraint, value);
    const ShownUnit unit = unit_of(problem, constraint);
    table.add_row({constraint.name, significant(unit.shown(value)),
                   (used.is_upper ? "≤ " : "≥ ") + significant(unit.shown(used.limit)), unit.name,
                   used.utilisation ? percent(*used.utilisation) : "–",
                   is_kept(constraint, value) ? "kept" : "BROKEN"});
  }
  return table.is_empty() ? "" : "\n" + table.text();
}

}  // namespace pleuel
