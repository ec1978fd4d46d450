#include <cmath>

#include <fmt/format.h>

#include "cli/reports/case_report.hpp"
#include "cli/reports/limits_report.hpp"
#include "cli/reports/optimum_document.hpp"
#include "cli/reports/scene_report.hpp"
#include "cli/reports/starts_report.hpp"
#include "cli/text/wrapped_text.hpp"
#include "core/base/find_named.hpp"
#include "core/base/number_text.hpp"
#include "core/scene/case_goals.hpp"

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
  if (result.status == Status::interrupted) return "INTERRUPTED: " + result.message;
  if (result.status == Status::failed) return "FAILED: " + result.message;
  if (result.status != Status::verified) {
    return fmt::format("NOT VERIFIED ({}): {}", to_string(result.status), result.message);
  }
  if (optimum.sizes != nullptr && optimum.sizes->is_choice) return "VERIFIED: " + result.message;
  return fmt::format("VERIFIED: every limit holds{}; {}", deciding_text(optimum),
                     neighbours_text(optimum));
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
  const std::string reached = reached_bound(variable, value);
  if (reached == "both") return "fixed";
  return reached.empty() ? "" : fmt::format("at its {} bound", reached);
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
  Table table({left_aligned("variable"), "start", name_of_end(to_string(optimum.result.status)),
               "lower", "upper", left_aligned("unit"), left_aligned("")});
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
std::string worth(const Json& limit, double objective) {
  const double gain =
      -limit.at("multiplier").get<double>() * 0.01 * std::abs(limit.at("limit").get<double>());
  if (gain == 0.0 || objective == 0.0) return "–";
  return (gain < 0 ? "−" : "+") + fmt::format("{:.2f} %", 100 * std::abs(gain / objective));
}

/// What round-off leaves of a limit of zero is zero.
std::string limited_text(double shown) {
  return significant(std::abs(shown) < 1e-9 ? 0.0 : shown);
}

/// "rod_strength +3 σ": with the margin that is kept from it.
std::string name_with_margin(const std::string& name, const Json& limit) {
  const std::string limit_name = limit.value("limit_name", name);
  if (!limit.contains("deviations")) return limit_name;
  return fmt::format("{} {}{:g} σ", limit_name, limit["side"] == "upper" ? "+" : "−",
                     limit["deviations"].get<double>());
}

std::string constraints_text(const Optimum& optimum, const Json& all, bool shows_prices) {
  const ProblemFile& problem = optimum.problem;
  Json limits =
      Json::object();  // of several cases those that decide a limit or that it has a price in
  for (const auto& [name, limit] : all.items()) {
    const bool has_price = limit.value("multiplier", 0.0) != 0.0;
    if (limit.value("decides", true) || has_price) limits[name] = limit;
  }
  const NamedUnits units = units_of_limits(problem);
  const ShownUnit objective = unit_of(find_response(problem, problem.objective->response));
  std::vector<DocumentColumn> columns = {{"constraint", name_with_margin, Table::Align::left},
                                         shown_column("value", "/value", units, limited_text),
                                         limit_column(units),
                                         unit_column(units),
                                         number_column("used", "/utilisation", percent)};
  if (problem.has_cases()) {
    const auto load_case = [&](const std::string& name, const Json&) {
      return cases_of_limit(problem, index_of_named(problem.constraints, name).value());
    };
    columns.insert(columns.begin() + 1, {"case", load_case, Table::Align::left});
  }
  if (shows_prices) {
    const auto price = [units, objective](const std::string& name, const Json& limit) {
      const double shown = objective.shown(limit.at("multiplier").get<double>());
      return significant(shown * units.at(name).factor, 3);
    };
    columns.push_back({fmt::format("multiplier [{}/unit]", objective.name), price});
    columns.push_back({"at +1 % limit", [&](const std::string&, const Json& limit) {
                         return worth(limit, optimum.result.evaluation.objective);
                       }});
  }
  const Table table = table_of(limits, columns);
  if (table.is_empty()) return "";
  return "\n" + table.text() +
         (limits.size() < all.size()
              ? wrapped("Each limit in the case that decides it; the others are in result.json.\n")
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
  return wrapped(
      fmt::format("{}: {} evaluations, {} with {}, {} restart{}, {}\n", backend, result.evaluations,
                  result.gradient_evaluations, gradients, result.restarts,
                  result.restarts == 1 ? "" : "s", duration(result.seconds)),
      "  ");
}

}  // namespace

std::string name_of_end(const std::string& status) {
  return status == to_string(Status::verified) ? "optimum" : "end";
}

std::string optimum_report(const Optimum& optimum, const Json& document, bool is_verbose) {
  const std::string status = "\n" + wrapped(status_text(optimum)) + "\n";
  if (!optimum.has_design()) {
    const bool has_best = optimum.result.status == Status::interrupted;
    return has_best ? status + "\n" + variables_text(optimum) : status;
  }
  const bool shows_prices = is_verbose && has_prices(optimum.result);
  const bool shows_audit = is_verbose || optimum.result.status != Status::verified;
  return status + objective_text(optimum) +
         wrapped(objective_in_cases(optimum.problem, optimum.result), "  ") + "\n" +
         variables_text(optimum) +
         constraints_text(optimum, document.at("constraints"), shows_prices) + "\n" +
         warnings_text(optimum.warnings, optimum.consequences) +
         (shows_audit ? audit_text(optimum) : "") + effort_text(optimum);
}

}  // namespace pleuel
