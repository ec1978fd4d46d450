#include "core/trust/extrapolation.hpp"

#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/eager_matrices.hpp"
#include "core/model/imported_constants.hpp"
#include "core/scene/body_source.hpp"

namespace pleuel {

namespace {

constexpr double harmless_kink = 1e-4;

/// The variables by which a body is not that of its file, with both values; empty if it is.
std::string moved_variables(const ImportedBody& imported, const ProblemFile& problem,
                            const Eigen::VectorXd& x) {
  const Design<double> design(x.begin(), x.end());
  std::vector<std::string> moved;
  for (const ImportedVariable& of : imported.variables) {
    const ConstantsDerivative& derivative = imported.file->design[of.in_design];
    if (derivative.derivative && is_zero(*derivative.derivative)) continue;
    const DesignVariable& variable = problem.variables[of.number.variable];
    const double size =
        derivative.value != 0.0 ? std::abs(derivative.value) : variable.upper - variable.lower;
    const double value = resolve(of.number, design);
    if (std::abs(value - derivative.value) <= harmless_kink * size) continue;
    moved.push_back(fmt::format("{} = {:.6g} instead of {:.6g} {}", derivative.variable, value,
                                derivative.value, derivative.unit));
  }
  return fmt::format("{}", fmt::join(moved, ", "));
}

}  // namespace

std::vector<Finding> check_extrapolation(const TrustedRun& run) {
  std::vector<Finding> findings;
  const Design<double> design(run.x.begin(), run.x.end());
  for (const Body& body : run.problem.scene.bodies) {
    const auto* imported = std::get_if<ImportedBody>(&body.shape);
    if (imported && imported->maker &&
        imported->maker->distance(body_values(*imported, design)) > 0.0) {
      findings.push_back(
          {fmt::format("the constants of \"{}\" are continued from other designs: {} "
                       "has not made it for this one",
                       body.name, imported->source),
           true});
    }
    if (!imported || !imported->is_linear) continue;
    const std::string moved = moved_variables(*imported, run.problem, run.x);
    if (moved.empty()) continue;
    findings.push_back(
        {fmt::format("the constants of \"{}\" are continued linearly to a design that its file {} "
                     "is not of: {}. Nothing says how wrong they are there. Write the file anew "
                     "for this design, go on from there, and repeat it until the design stays.",
                     body.name, imported->source, moved),
         true});
  }
  return findings;
}

}  // namespace pleuel
