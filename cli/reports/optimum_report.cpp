#include "cli/reports/optimum_report.hpp"

#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "cli/reports/case_report.hpp"
#include "cli/reports/error_report.hpp"
#include "cli/reports/monitors_report.hpp"
#include "cli/reports/plain_verdict.hpp"
#include "cli/reports/reached_bound.hpp"
#include "cli/reports/sizes_report.hpp"
#include "cli/reports/warnings.hpp"
#include "cli/text/table.hpp"
#include "cli/text/wrapped_text.hpp"
#include "core/base/number_text.hpp"
#include "core/scene/case_goals.hpp"
#include "optimization/prices.hpp"

namespace pleuel {

namespace {

/// "crank_strength and rod_stiffness decide": the limits that cost something; empty if none does.
std::string deciding_text(const Optimum& optimum) {
  if (!has_prices(optimum.result)) return "";
  std::vector<std::string> names;
  for (std::size_t i = 0; i < optimum.problem.constraints.size(); ++i) {
    if (optimum.result.constraint_multipliers(i) == 0.0) continue;
    names.push_back(limit_name(optimum.problem, i));
  }
  if (names.empty()) return "";
  const std::string last = names.back();
  names.pop_back();
  if (names.empty()) return "; " + last + " decides";
  return fmt::format("; {} and {} decide", fmt::join(names, ", "), last);
}

/// What was found, in words that need no theory; the audit of a verified answer is told apart.
std::string status_text(const Optimum& optimum) {
  const Result& result = optimum.result;
  switch (result.status) {
    case Status::verified:
      if (optimum.sizes != nullptr && optimum.sizes->is_choice)
        return "VERIFIED: " + result.message;
      return fmt::format("VERIFIED: every limit holds{}; {}", deciding_text(optimum),
                         neighbours_text(optimum));
    case Status::stalled:
      return "NOT VERIFIED (stalled): " + result.message;
    case Status::unresolved:
      return "NOT VERIFIED (unresolved): " + result.message;
    case Status::infeasible:
      return "NOT VERIFIED (infeasible): " + result.message;
    case Status::interrupted:
      return "INTERRUPTED: " + result.message;
    default:
      return "FAILED: " + result.message;
  }
}

std::string objective_text(const Optimum& optimum) {
  const std::string& name = optimum.problem.objective->response;
  const ShownUnit unit = unit_of(find_response(optimum.problem, name));
  const double sign = optimum.problem.objective->sign();
  const double start = sign * first_design(optimum.result.history).objective;
  const double end = sign * optimum.result.evaluation.objective;
  std::string text = fmt::format("{}: {} → {} {}", name, significant(unit.shown(start)),
                                 significant(unit.shown(end)), unit.name);
  if (start != 0.0) text += fmt::format(" ({})", signed_percent((end - start) / std::abs(start)));
  text += "\n";
  if (optimum.result.error) {
    text += wrapped("  " + error_sentence(*optimum.result.error, end, unit), "    ") + "\n";
  }
  return text;
}

std::string bound_mark(const DesignVariable& variable, double value) {
  if (const auto choice = size_text(variable, value)) return *choice;
  const ReachedBound reached = reached_bound(variable, value);
  if (reached == ReachedBound::none) return "";
  if (reached == ReachedBound::both) return "fixed";
  return fmt::format("at its {} bound", to_string(reached));
}

/// Whether neither the objective nor a limit depends on a variable at the last design.
bool changes_nothing(const Evaluation& evaluation, Eigen::Index variable) {
  return evaluation.has_gradients() && evaluation.objective_gradient(variable) == 0.0 &&
         evaluation.constraint_jacobian.col(variable).isZero(0.0);
}

/// Of a section its name, if it is one of the list.
std::string value_text(const DesignVariable& variable, const ShownUnit& unit, double value) {
  const auto name = is_section(variable) ? size_text(variable, value) : std::nullopt;
  return name.value_or(significant(unit.shown(value)));
}

std::string variables_text(const Optimum& optimum) {
  const std::vector<ShownUnit> units = variable_units(optimum.problem);
  Table table({{"variable", Table::Align::left},
               {"start"},
               {name_of_end(to_string(optimum.result.status))},
               {"lower"},
               {"upper"},
               {"unit", Table::Align::left},
               {"", Table::Align::left}});
  for (std::size_t i = 0; i < optimum.problem.variables.size(); ++i) {
    const DesignVariable& variable = optimum.problem.variables[i];
    const ShownUnit& unit = units[i];
    const double value = optimum.result.x(i);
    const auto text = [&](double number) { return value_text(variable, unit, number); };
    const bool is_name = is_section(variable) && size_text(variable, value);
    std::string mark = is_name ? "" : bound_mark(variable, value);
    if (mark.empty() && !is_name &&
        changes_nothing(optimum.result.evaluation, static_cast<Eigen::Index>(i))) {
      mark = "changes nothing here";
    }
    table.add_row({variable.name, text(optimum.start(i)), text(value), text(variable.lower),
                   text(variable.upper), is_section(variable) ? "" : unit.name, mark});
  }
  return table.text();
}

/// −μ · 1 % of the limit, relative to the objective: what one more percent of a limit is worth.
std::string worth(const Optimum& optimum, double multiplier, double limit) {
  const double objective = optimum.result.evaluation.objective;
  const double gain = -multiplier * 0.01 * std::abs(limit);
  if (gain == 0.0 || objective == 0.0) return "–";
  return (gain < 0 ? "−" : "+") + fmt::format("{:.2f} %", 100 * std::abs(gain / objective));
}

std::string price_text(double multiplier, const ShownUnit& objective, const ShownUnit& limit) {
  return multiplier == 0.0 ? "0" : significant(objective.shown(multiplier) * limit.factor, 3);
}

/// What round-off leaves of a limit of zero is zero.
std::string limited_text(double shown) {
  return significant(std::abs(shown) < 1e-9 ? 0.0 : shown);
}

std::vector<std::string> constraint_row(const Optimum& optimum, std::size_t i, bool has_price) {
  const ConstraintSettings& constraint = optimum.problem.constraints[i];
  const double value = optimum.result.evaluation.constraints(i);
  std::optional<double> multiplier;
  if (has_price) {
    multiplier = optimum.problem.objective->sign() * optimum.result.constraint_multipliers(i);
  }
  const UsedLimit used = used_limit(constraint, value);
  const ShownUnit unit = unit_of(optimum.problem, constraint);
  const ShownUnit objective_unit =
      unit_of(find_response(optimum.problem, optimum.problem.objective->response));
  const std::string margin =
      constraint.deviations > 0.0
          ? fmt::format(" {}{:g} σ", constraint.upper ? "+" : "−", constraint.deviations)
          : "";
  std::vector<std::string> cells = {
      limit_name(optimum.problem, i) + margin, limited_text(unit.shown(value)),
      (used.is_upper ? "≤ " : "≥ ") + significant(unit.shown(used.limit)), unit.name,
      used.utilisation ? percent(*used.utilisation) : "–"};
  if (multiplier) {
    cells.push_back(price_text(*multiplier, objective_unit, unit));
    cells.push_back(worth(optimum, *multiplier, used.limit));
  }
  return cells;
}

/// Of several cases those that decide a limit or that it has a price in.
bool is_shown(const Optimum& optimum, std::size_t constraint, const std::vector<bool>& decides) {
  const bool is_of_case = !case_of(optimum.problem, constraint).empty();
  const bool has_price =
      has_prices(optimum.result) && optimum.result.constraint_multipliers(constraint) != 0.0;
  return !is_of_case || decides[constraint] || has_price;
}

std::string constraints_text(const Optimum& optimum, bool shows_prices) {
  const bool has_cases = optimum.problem.has_cases();
  std::vector<Table::Column> columns = {{"constraint", Table::Align::left},
                                        {"value"},
                                        {"limit"},
                                        {"unit", Table::Align::left},
                                        {"used"}};
  if (shows_prices) {
    const ShownUnit objective_unit =
        unit_of(find_response(optimum.problem, optimum.problem.objective->response));
    columns.push_back({fmt::format("multiplier [{}/unit]", objective_unit.name)});
    columns.push_back({"at +1 % limit"});
  }
  if (has_cases) columns.insert(columns.begin() + 1, {"case", Table::Align::left});
  Table table(std::move(columns));
  const std::vector<bool> decides =
      deciding_constraints(optimum.problem, optimum.result.evaluation.constraints);
  std::size_t shown = 0;
  for (std::size_t i = 0; i < optimum.problem.constraints.size(); ++i) {
    if (!is_shown(optimum, i, decides)) continue;
    std::vector<std::string> row = constraint_row(optimum, i, shows_prices);
    if (has_cases) row.insert(row.begin() + 1, cases_of_limit(optimum.problem, i));
    table.add_row(std::move(row));
    ++shown;
  }
  if (table.is_empty()) return "";
  const std::size_t left = optimum.problem.constraints.size() - shown;
  return "\n" + table.text() +
         (left > 0 ? wrapped("Each limit in the case that decides it; the others are in "
                             "result.json.\n")
                   : "");
}

/// Residuals and what was checked.
std::string audit_text(const Optimum& optimum) {
  const Result& result = optimum.result;
  if (result.status != Status::verified) {
    return fmt::format("KKT residual {}, largest violation of a limit {} (both relative)\n",
                       magnitude(result.kkt_residual), magnitude(result.max_violation));
  }
  return wrapped("Audit: " + result.message + ".", "  ") + "\n" +
         wrapped("In plain words: " + plain_verdict(optimum) + ".", "  ") + "\n";
}

std::string effort_text(const Optimum& optimum) {
  const Result& result = optimum.result;
  std::string gradients = "gradients";
  if (optimum.method) gradients += fmt::format(" ({})", to_string(optimum.method->method));
  const std::string backend =
      result.polished_with.empty()
          ? result.backend
          : fmt::format("{}, polished with {}", result.backend, result.polished_with);
  return fmt::format("{}: {} evaluations, {} with {}, {} restart{}, {}\n", backend,
                     result.evaluations, result.gradient_evaluations, gradients, result.restarts,
                     result.restarts == 1 ? "" : "s", duration(result.seconds));
}

}  // namespace

std::string name_of_end(const std::string& status) {
  return status == to_string(Status::verified) ? "optimum" : "end";
}

std::string optimum_report(const Optimum& optimum, bool is_verbose) {
  const std::string status = "\n" + wrapped(status_text(optimum)) + "\n";
  if (!optimum.has_design()) return status;
  const bool shows_prices = is_verbose && has_prices(optimum.result);
  const bool shows_audit = is_verbose || optimum.result.status != Status::verified;
  return status + objective_text(optimum) +
         wrapped(objective_in_cases(optimum.problem, optimum.result), "  ") + "\n" +
         variables_text(optimum) + constraints_text(optimum, shows_prices) + "\n" +
         warnings_text(optimum.warnings, optimum.consequences) +
         (shows_audit ? audit_text(optimum) : "") + effort_text(optimum);
}

}  // namespace pleuel
