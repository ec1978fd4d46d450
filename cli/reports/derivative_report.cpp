#include "cli/reports/derivative_report.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "cli/text/table.hpp"
#include "core/base/number_text.hpp"
#include "core/scene/shown_unit.hpp"

namespace pleuel {

namespace {

/// Decimal digits that are right: 0 … 15, what a number of 64 bits holds.
int digits_of(double relative_error) {
  if (!(relative_error < 1.0)) return 0;
  return std::min(15, static_cast<int>(std::floor(-std::log10(std::max(relative_error, 1e-16)))));
}

Json curve_document(const std::vector<CentralDifference>& curve) {
  return list_of(curve, [](const CentralDifference& one) {
    return Json{{"step", one.step}, {"difference", one.value}, {"error", one.error}};
  });
}

Json variable_document(const JudgedDerivative& judged) {
  Json document = {{"verdict", to_string(judged.verdict)},
                   {"derivative", judged.derivative},
                   {"error", judged.error},
                   {"difference_step", judged.step},
                   {"resolution", judged.resolution},
                   {"curve", curve_document(judged.curve)}};
  if (judged.tight_error) document["tight_error"] = *judged.tight_error;
  return document;
}

std::string response_verdict(const ProblemFile& problem, const DerivativeCheck& check) {
  const std::size_t worst = check.worst_variable();
  const double worst_error = check.variables[worst].error;
  switch (check.verdict()) {
    case DerivativeVerdict::agrees:
      return check.error == 0.0 ? "agrees exactly" : "agrees to " + magnitude(check.error);
    case DerivativeVerdict::noise:
      return fmt::format("differences are too inexact to check that of {}",
                         problem.variables[worst].name);
    case DerivativeVerdict::kink:
      return fmt::format("at a kink, see below ({})", magnitude(worst_error));
    default:
      return "DIFFERS by " + magnitude(worst_error);
  }
}

std::string explanation(const JudgedDerivative& judged) {
  switch (judged.verdict) {
    case DerivativeVerdict::noise:
      if (judged.tight_error) return "noise: /simulation/newton_tolerance is too loose, see below";
      return fmt::format("noise: differences are good to {} only", magnitude(judged.resolution));
    case DerivativeVerdict::kink:
      return "kink: differences mix two peaks";
    default:
      return "DIFFERS";
  }
}

/// What to do where Newton's method stops too early for differences; empty if it does not.
std::string loose_newton_text(const ProblemFile& problem,
                              const std::vector<DerivativeCheck>& checks) {
  double largest = -1.0;
  for (const DerivativeCheck& check : checks) {
    for (const JudgedDerivative& judged : check.variables) {
      if (judged.tight_error) largest = std::max(largest, *judged.tight_error);
    }
  }
  if (largest < 0.0) return "";
  return fmt::format(
      "Newton's method stops too early for differences: /simulation/newton_tolerance is {:g}. With "
      "a tighter one\nthese derivatives are right (to {}): tighten it, or live with errors of "
      "that size in the values.\n",
      problem.simulation.newton_tolerance, magnitude(largest));
}

std::string disagreements_text(const ProblemFile& problem,
                               const std::vector<DerivativeCheck>& checks) {
  Table table({left_aligned("response"), left_aligned("variable"), "derivative", "error", "at step",
               left_aligned("because")});
  for (std::size_t i = 0; i < checks.size(); ++i) {
    for (std::size_t j = 0; j < checks[i].variables.size(); ++j) {
      const JudgedDerivative& judged = checks[i].variables[j];
      if (judged.verdict == DerivativeVerdict::agrees) continue;
      table.add_row({problem.responses[i].name, problem.variables[j].name,
                     significant(judged.derivative), magnitude(judged.error),
                     fmt::format("{:g}", judged.step), explanation(judged)});
    }
  }
  if (table.is_empty()) return "";
  return "\nDerivatives that do not agree with differences to 1e-6 [SI]\n" + table.text() +
         loose_newton_text(problem, checks);
}

/// What an optimizer compares the noise of a response with; 0 if it does not look at it.
double optimizer_magnitude(const ProblemFile& problem, const std::string& response, double value) {
  const bool is_objective = problem.objective && problem.objective->response == response;
  double size = is_objective ? std::abs(value) : 0.0;
  for (const ConstraintSettings& constraint : problem.constraints) {
    if (constraint.response != response) continue;
    const double limit = std::max(std::abs(constraint.lower.value_or(0.0)),
                                  std::abs(constraint.upper.value_or(0.0)));
    const double larger = std::max(std::abs(value), limit);
    size = size > 0.0 ? std::min(size, larger) : larger;
  }
  return size;
}

}  // namespace

Json derivative_document(const ProblemFile& problem, const DerivativeCheck& check) {
  Json document = {
      {"verdict", to_string(check.verdict())},
      {"error", check.error},
      {"difference_step", check.step},
      {"adjoint_error", check.adjoint_error},
      {"noise", check.relative_noise},
      {"digits",
       {{"value", digits_of(check.relative_noise)}, {"gradient", digits_of(check.error)}}},
      {"variables", Json::object()}};
  for (std::size_t j = 0; j < check.variables.size(); ++j) {
    document["variables"][problem.variables[j].name] = variable_document(check.variables[j]);
  }
  return document;
}

std::string derivatives_text(const ProblemFile& problem, const Analysis& analysis,
                             const std::vector<DerivativeCheck>& checks) {
  Table table({left_aligned("response"), "value", left_aligned("unit"), left_aligned("derivative"),
               left_aligned("worst variable"), "adjoint", "noise", left_aligned("digits")});
  for (std::size_t i = 0; i < checks.size(); ++i) {
    const DerivativeCheck& check = checks[i];
    const ShownUnit unit = unit_of(problem.responses[i]);
    const std::size_t worst = check.worst_variable();
    table.add_row(
        {problem.responses[i].name, significant(unit.shown(analysis.reductions[i].value)),
         unit.name, response_verdict(problem, check),
         fmt::format("{} {}", problem.variables[worst].name,
                     magnitude(check.variables[worst].error)),
         magnitude(check.adjoint_error), magnitude(check.relative_noise),
         fmt::format("{} / {}", digits_of(check.relative_noise), digits_of(check.error))});
  }
  return "Responses; direct differentiation against central differences and against the adjoint "
         "method,\nnoise of the value (all relative), and right digits of value / gradient that an "
         "optimizer may expect\n" +
         table.text() + disagreements_text(problem, checks);
}

/// Below, Newton's method stops at round-off.
constexpr double least_tolerance = 1e-11;

std::vector<std::string> noise_warnings(const ProblemFile& problem, const Analysis& analysis,
                                        const std::vector<DerivativeCheck>& checks) {
  std::vector<std::string> warnings;
  for (std::size_t i = 0; i < checks.size(); ++i) {
    const std::string& name = problem.responses[i].name;
    const double size = optimizer_magnitude(problem, name, analysis.reductions[i].value);
    if (size == 0.0 || checks[i].noise <= problem.optimizer.tolerance * size) continue;
    const double noise = checks[i].noise / size;
    warnings.push_back(fmt::format(
        "the noise of {}, {}, is above /optimizer/tolerance, {:g}: {} cannot tell progress from "
        "noise there. Set /optimizer/tolerance to {:.0e} or more{}",
        name, magnitude(noise), problem.optimizer.tolerance, problem.optimizer.backend,
        std::pow(10.0, std::ceil(std::log10(noise))),
        problem.simulation.newton_tolerance > least_tolerance
            ? fmt::format(
                  "; if rounding does not cause it, a /simulation/newton_tolerance below {:g} "
                  "makes it less",
                  problem.simulation.newton_tolerance)
            : ""));
  }
  return warnings;
}

}  // namespace pleuel
