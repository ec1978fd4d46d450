#include "cli/reports/limits_report.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "cli/reports/analysis_report.hpp"
#include "cli/reports/optimum.hpp"
#include "cli/text/table.hpp"
#include "cli/text/wrapped_text.hpp"
#include "core/base/find_named.hpp"
#include "core/base/number_text.hpp"
#include "core/scene/shown_unit.hpp"
#include "optimization/verdict.hpp"

namespace pleuel {

namespace {

/// Of the terms of a sum, which may cancel.
constexpr double round_off_of_terms = 1e-12;

/// The sum of the magnitudes of what a limit on variables adds up; zero of one on a response.
double terms_of(const ConstraintSettings& constraint, const Eigen::VectorXd& x) {
  double size = 0.0;
  for (const auto& [variable, coefficient] : constraint.linear) {
    size += std::abs(coefficient * x(variable));
  }
  return size;
}

double value_of(const ConstraintSettings& constraint, const ProblemFile& problem,
                const Eigen::VectorXd& x, const Analysis& analysis) {
  double value = 0.0;
  for (const auto& [variable, coefficient] : constraint.linear) value += coefficient * x(variable);
  if (!constraint.linear.empty()) {
    return std::abs(value) <= round_off_of_terms * terms_of(constraint, x) ? 0.0 : value;
  }
  return without_round_off(analysis,
                           index_of_named(problem.responses, constraint.response).value());
}

/// As exactly as a verified optimum keeps its limits; of a limit on variables, which may be zero,
/// to the round-off of its terms.
bool is_kept(const ConstraintSettings& constraint, const Eigen::VectorXd& x, double value) {
  const auto exceeds = [&](double excess, double limit) {
    return excess > std::max(Tolerances().violation * std::abs(limit),
                             round_off_of_terms * terms_of(constraint, x));
  };
  return !(constraint.upper && exceeds(value - *constraint.upper, *constraint.upper)) &&
         !(constraint.lower && exceeds(*constraint.lower - value, *constraint.lower));
}

using Errors = std::vector<std::optional<ErrorBar>>;

/// Whether a limit that is broken may be kept as far as the error of its response is known.
bool is_within_error(const ProblemFile& problem, const ConstraintSettings& constraint, double value,
                     const Errors& errors) {
  const auto index = index_of_named(problem.responses, constraint.response);
  if (!index || *index >= errors.size() || !errors[*index]) return false;
  const ErrorBar& bar = *errors[*index];
  if (!bar.is_resolved() || !std::isfinite(bar.bound())) return false;
  const bool is_high = constraint.upper && value > *constraint.upper;
  const double excess = is_high ? value - *constraint.upper : *constraint.lower - value;
  return excess <= bar.bound();
}

/// A difference that value and limit do not show, with their five digits, is none.
std::string margin_text(const UsedLimit& used, double value, const ShownUnit& unit) {
  const double margin = used.is_upper ? used.limit - value : value - used.limit;
  if (std::abs(margin) < 1e-5 * std::abs(used.limit)) return "0";
  return significant(unit.shown(margin), 3);
}

std::string sum_text(const ProblemFile& problem, const Eigen::VectorXd& x,
                     const Analysis& analysis) {
  std::vector<std::string> broken;
  for (const ConstraintSettings& constraint : problem.constraints) {
    if (is_kept(constraint, x, value_of(constraint, problem, x, analysis))) continue;
    broken.push_back(constraint.name);
  }
  const std::size_t all = problem.constraints.size();
  if (broken.empty() && all == 1) return "The limit is kept.\n";
  if (broken.empty()) return fmt::format("All {} limits are kept.\n", all);
  if (all == 1) return fmt::format("The limit is broken: {}.\n", broken.front());
  return wrapped(fmt::format("{} of {} limits {} broken: {}.", broken.size(), all,
                             broken.size() == 1 ? "is" : "are", fmt::join(broken, ", ")),
                 "  ") +
         "\n";
}

}  // namespace

Json limit_document(const ProblemFile& problem, const ConstraintSettings& constraint,
                    const Eigen::VectorXd& x, double value) {
  const UsedLimit used = used_limit(constraint, value);
  Json entry = {{"value", value},
                {"limit", used.limit},
                {"side", used.is_upper ? "upper" : "lower"},
                {"unit", unit_of(problem, constraint).si}};
  if (used.utilisation) entry["utilisation"] = *used.utilisation;
  entry["kept"] = is_kept(constraint, x, value);
  return entry;
}

Json limits_document(const ProblemFile& problem, const Eigen::VectorXd& x, const Analysis& analysis,
                     const Errors& errors) {
  Json document = Json::object();
  for (const ConstraintSettings& constraint : problem.constraints) {
    const double value = value_of(constraint, problem, x, analysis);
    Json& entry = document[constraint.name] = limit_document(problem, constraint, x, value);
    if (is_kept(constraint, x, value)) continue;
    entry["within_error"] = is_within_error(problem, constraint, value, errors);
  }
  return document;
}

std::string limits_text(const ProblemFile& problem, const Eigen::VectorXd& x,
                        const Analysis& analysis, const Errors& errors) {
  Table table({{"constraint", Table::Align::left},
               {"value"},
               {"limit"},
               {"unit", Table::Align::left},
               {"used"},
               {"margin"},
               {"", Table::Align::left}});
  for (const ConstraintSettings& constraint : problem.constraints) {
    const double value = value_of(constraint, problem, x, analysis);
    const UsedLimit used = used_limit(constraint, value);
    const ShownUnit unit = unit_of(problem, constraint);
    table.add_row(
        {constraint.name, significant(unit.shown(value)),
         (used.is_upper ? "≤ " : "≥ ") + significant(unit.shown(used.limit)), unit.name,
         used.utilisation ? percent(*used.utilisation) : "–", margin_text(used, value, unit),
         is_kept(constraint, x, value)                         ? "kept"
         : is_within_error(problem, constraint, value, errors) ? "BROKEN, within its error"
                                                               : "BROKEN"});
  }
  return table.is_empty() ? "" : "\n" + table.text() + "\n" + sum_text(problem, x, analysis);
}

bool keeps_limits(const ProblemFile& problem, const Eigen::VectorXd& x, const Analysis& analysis) {
  return std::all_of(problem.constraints.begin(), problem.constraints.end(),
                     [&](const ConstraintSettings& constraint) {
                       return is_kept(constraint, x, value_of(constraint, problem, x, analysis));
                     });
}

}  // namespace pleuel
