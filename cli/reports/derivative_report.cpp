#include "cli/reports/derivative_report.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "cli/text/table.hpp"
#include "cli/text/wrapped_text.hpp"
#include "core/base/number_text.hpp"
#include "core/scene/reading/invariants_reader.hpp"
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

Json judged_document(const JudgedDerivative& judged) {
  Json document = {{"verdict", to_string(judged.verdict)},
                   {"derivative", judged.derivative},
                   {"error", judged.error},
                   {"difference_step", judged.step},
                   {"resolution", judged.resolution},
                   {"curve", curve_document(judged.curve)}};
  if (judged.tight_error) document["tight_error"] = *judged.tight_error;
  return document;
}

std::string response_verdict(const DerivativeCheck& check) {
  const JudgedDerivative& worst = check.worst();
  switch (worst.verdict) {
    case DerivativeVerdict::agrees:
      return worst.error == 0.0 ? "agrees exactly" : "agrees to " + magnitude(worst.error);
    case DerivativeVerdict::noise:
      return "differences are too inexact to check it";
    case DerivativeVerdict::kink:
      return fmt::format("at a kink, see below ({})", magnitude(worst.error));
    default:
      return "DIFFERS by " + magnitude(worst.error);
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
std::string loose_newton_text(const ProblemFile& problem, const DerivativeChecks& checks) {
  double largest = -1.0;
  for (const DerivativeCheck& check : checks.responses) {
    for (const JudgedDerivative& judged : check.directions) {
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

/// "rod_width", "all variables", "rod_width and 3 others"
std::string variables_text(const ProblemFile& problem, const CheckedDirection& direction) {
  const std::size_t count = direction.variables.size();
  if (count > 1 && count == problem.variables.size()) return "all variables";
  const std::string& first = problem.variables[direction.variables.front()].name;
  if (count == 1) return first;
  return fmt::format("{} and {} other{}", first, count - 1, count == 2 ? "" : "s");
}

std::string disagreements_text(const ProblemFile& problem, const DerivativeChecks& checks) {
  Table table(
      {left_aligned("response"), left_aligned("by"), "error", "at step", left_aligned("because")});
  for (std::size_t i = 0; i < checks.responses.size(); ++i) {
    for (std::size_t k = 0; k < checks.directions.size(); ++k) {
      const JudgedDerivative& judged = checks.responses[i].directions[k];
      if (judged.verdict == DerivativeVerdict::agrees) continue;
      table.add_row({problem.responses[i].name, variables_text(problem, checks.directions[k]),
                     magnitude(judged.error), fmt::format("{:g}", judged.step),
                     explanation(judged)});
    }
  }
  if (table.is_empty()) return "";
  return "\nDerivatives that do not agree with differences to 1e-6\n" + table.text() +
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

/// Each variable is in one of the directions.
Json variables_document(const ProblemFile& problem, const std::vector<CheckedDirection>& directions,
                        const DerivativeCheck& check) {
  Json document = Json::object();
  for (std::size_t k = 0; k < directions.size(); ++k) {
    for (const Eigen::Index j : directions[k].variables) {
      document[problem.variables[j].name] = {{"verdict", to_string(check.directions[k].verdict)},
                                             {"derivative", check.derivatives(j)},
                                             {"error", check.directions[k].error}};
    }
  }
  return document;
}

/// All inertia of a body as a change: what a factor on its density does.
BodyConstants inertia_of(const BodyConstants& constants) {
  BodyConstants inertia = zero_constants(constants);
  inertia.mass = constants.mass;
  inertia.first_moment = constants.first_moment;
  inertia.second_moment = constants.second_moment;
  inertia.shape = constants.shape;
  inertia.mixed = constants.mixed;
  inertia.moments = constants.moments;
  inertia.mass_matrix = constants.mass_matrix;
  return inertia;
}

BodyConstants with_only(const BodyConstants& constants, SparseMatrix BodyConstants::*matrix) {
  BodyConstants change = zero_constants(constants);
  change.*matrix = constants.*matrix;
  return change;
}

}  // namespace

Json directions_document(const ProblemFile& problem,
                         const std::vector<CheckedDirection>& directions) {
  return list_of(directions, [&](const CheckedDirection& direction) {
    Json changes = Json::object();
    for (const Eigen::Index j : direction.variables) {
      changes[problem.variables[j].name] = direction.change(j);
    }
    return changes;
  });
}

Json derivative_document(const ProblemFile& problem,
                         const std::vector<CheckedDirection>& directions,
                         const DerivativeCheck& check) {
  const JudgedDerivative& worst = check.worst();
  return {{"verdict", to_string(worst.verdict)},
          {"error", worst.error},
          {"difference_step", worst.step},
          {"adjoint_error", check.adjoint_error},
          {"noise", check.relative_noise},
          {"digits",
           {{"value", digits_of(check.relative_noise)}, {"gradient", digits_of(worst.error)}}},
          {"variables", variables_document(problem, directions, check)},
          {"directions", list_of(check.directions, judged_document)}};
}

std::string derivatives_text(const ProblemFile& problem, const Analysis& analysis,
                             const DerivativeChecks& checks) {
  Table table({left_aligned("response"), "value", left_aligned("unit"), left_aligned("derivative"),
               "adjoint", "noise", left_aligned("digits")});
  for (std::size_t i = 0; i < checks.responses.size(); ++i) {
    const DerivativeCheck& check = checks.responses[i];
    const ShownUnit unit = unit_of(problem.responses[i]);
    table.add_row(
        {problem.responses[i].name, significant(unit.shown(analysis.reductions[i].value)),
         unit.name, response_verdict(check), magnitude(check.adjoint_error),
         magnitude(check.relative_noise),
         fmt::format("{} / {}", digits_of(check.relative_noise), digits_of(check.worst().error))});
  }
  return wrapped(
             "Responses; direct differentiation against central differences and against the "
             "adjoint method, noise of the value (all relative), and right digits of value / "
             "gradient that an optimizer may expect\n") +
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

Json constant_gradients_document(const ProblemFile& problem, const std::string& body,
                                 const ConstantGradients& gradients) {
  Json document = {{"body", body}, {"responses", Json::object()}};
  for (std::size_t i = 0; i < problem.responses.size(); ++i) {
    Json& response = document["responses"][problem.responses[i].name];
    response = {{"unit", unit_of(problem.responses[i]).si}};
    response.update(derivative_json(gradients.numbers[i]));
  }
  return document;
}

std::string constant_gradients_text(const ProblemFile& problem, const std::string& body,
                                    const ConstantGradients& gradients,
                                    const Eigen::VectorXd& values) {
  const BodyConstants& constants = gradients.constants;
  const BodyConstants changes[] = {inertia_of(constants),
                                   with_only(constants, &BodyConstants::stiffness),
                                   with_only(constants, &BodyConstants::damping)};
  Table table({{"response", Table::Align::left}, {"inertia"}, {"stiffness"}, {"damping"}});
  for (std::size_t i = 0; i < problem.responses.size(); ++i) {
    std::vector<std::string> cells = {problem.responses[i].name};
    const double value = values(static_cast<Eigen::Index>(i));
    for (const BodyConstants& change : changes) {
      const double percent = along(gradients.numbers[i], change) / value;
      cells.push_back(value == 0.0 ? "–" : signed_significant(percent, 3) + " %");
    }
    table.add_row(std::move(cells));
  }
  return fmt::format("\nWhat 1 % more of \"{}\" changes\n{}", body, table.text());
}

}  // namespace pleuel
