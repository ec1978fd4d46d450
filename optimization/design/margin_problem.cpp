#include "optimization/design/margin_problem.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/number_text.hpp"
#include "core/scene/body_rules.hpp"
#include "optimization/robust_problem.hpp"
#include "sensitivity/gradients.hpp"

namespace pleuel {

std::unique_ptr<Problem> with_margins(
    Problem& problem, const DesignProblem& design,
    const std::vector<std::optional<std::size_t>>& constraint_of_row) {
  Eigen::VectorXd margins = Eigen::VectorXd::Zero(Eigen::Index(constraint_of_row.size()));
  for (std::size_t row = 0; row < constraint_of_row.size(); ++row) {
    if (!constraint_of_row[row]) continue;
    margins(row) = design.file().constraints[*constraint_of_row[row]].deviations;
  }
  if (margins.isZero(0.0)) return nullptr;
  if (is_difference(design.file().sensitivity.method)) {
    throw InputError(
        "/sensitivity/method must be \"auto\", \"direct\" or \"adjoint\" where a constraint has "
        "\"deviations\": their gradients are differences of gradients");
  }
  Eigen::VectorXd deviations = Eigen::VectorXd::Zero(Eigen::Index(problem.variables().size()));
  deviations.head(Eigen::Index(design.variables().size())) = design.variable_deviations();
  return std::make_unique<RobustProblem>(problem, deviations, margins);
}

namespace {

/// Of the limit.
constexpr double worth_a_word = 0.01, serious = 0.05;
/// The same where a value changes to one side of a parameter only, at a kink.
constexpr double notable_kink = 1e-3;

/// A limit with a margin, and what of a parameter its first order misses most.
struct Margin {
  const ConstraintSettings* constraint;
  std::size_t response;
  double value;
  double missed = 0.0;  ///< of the limit
  std::string parameter{};
  std::string kink{};  ///< a parameter to one side of which alone the value changes

  double limit() const { return constraint->upper ? *constraint->upper : *constraint->lower; }
  double side() const { return constraint->upper ? 1.0 : -1.0; }
};

std::vector<Margin> margins_of(DesignProblem& design, const Eigen::VectorXd& x) {
  std::vector<Margin> margins;
  for (std::size_t i = 0; i < design.file().constraints.size(); ++i) {
    const ConstraintSettings& constraint = design.file().constraints[i];
    const std::optional<std::size_t> response = design.response_of(i);
    if (constraint.deviations == 0.0 || !response) continue;
    margins.push_back({&constraint, *response, design.value_at(x, *response)});
  }
  return margins;
}

const std::string& name_of(const DesignProblem& design, const UncertainParameter& parameter) {
  return design.file().variables[static_cast<std::size_t>(parameter.variable)].name;
}

/// So many deviations; of an interval no further than its ends.
double looked_at(const UncertainParameter& parameter, double deviations) {
  const double far = deviations * parameter.standard_deviation();
  return parameter.interval > 0.0 ? std::min(far, parameter.half_width()) : far;
}

/// @throws InputError where bodies cannot be as a design says, or a size that is always positive is not
void refuse_impossible(const DesignProblem& design, const UncertainParameter& parameter,
                       const Eigen::VectorXd& x) {
  const Design<double> values(x.begin(), x.end());
  for (const Body& body : design.file().scene.bodies) {
    if (const auto why = find_impossible(body, values)) throw InputError(*why);
  }
  const auto index = static_cast<std::size_t>(parameter.variable);
  const DesignVariable& variable = design.file().variables[index];
  if (variable.lower > 0.0 && values[index] <= 0.0) {
    throw InputError(fmt::format("it would be {:.3g} [SI]", values[index]));
  }
}

void judge(Margin& margin, double above, double below, const std::string& parameter) {
  const double mean = 0.5 * (above + below);
  const double missed = margin.side() * (mean - margin.value) / std::abs(margin.limit());
  const double seen = 0.5 * std::abs(above - below) / std::abs(margin.limit());
  if (missed > notable_kink && missed > 0.7 * seen && missed < 1.4 * seen) margin.kink = parameter;
  if (!(missed > margin.missed)) return;
  margin.missed = missed;
  margin.parameter = parameter;
}

/// Of one parameter, into `margins`: two designs for all of them that ask for the same deviations.
void look_beside(DesignProblem& design, const Eigen::VectorXd& x,
                 const UncertainParameter& parameter, std::vector<Margin>& margins) {
  std::map<double, std::vector<Margin*>> by_change;
  for (Margin& margin : margins) {
    by_change[looked_at(parameter, margin.constraint->deviations)].push_back(&margin);
  }
  const auto values_at = [&](double change, const std::vector<Margin*>& alike) {
    Eigen::VectorXd beside = x;
    beside(parameter.variable) += change;
    refuse_impossible(design, parameter, beside);
    std::vector<double> values;
    for (const Margin* margin : alike) values.push_back(design.value_at(beside, margin->response));
    return values;
  };
  for (const auto& [change, alike] : by_change) {
    const std::vector<double> above = values_at(change, alike), below = values_at(-change, alike);
    for (std::size_t i = 0; i < alike.size(); ++i) {
      judge(*alike[i], above[i], below[i], name_of(design, parameter));
    }
  }
}

}  // namespace

std::vector<Finding> check_margins(DesignProblem& design, const Eigen::VectorXd& x) {
  std::vector<Margin> margins = margins_of(design, x);
  if (margins.empty() || !design.file().uncertainty) return {};
  std::vector<Finding> findings;
  const auto refuse = [&](const UncertainParameter& parameter, const std::string& why) {
    findings.push_back({fmt::format("at the deviations of \"{}\" that limits ask for the mechanism "
                                    "cannot be simulated: {}",
                                    name_of(design, parameter), why),
                        true});
  };
  for (const UncertainParameter& parameter : design.file().uncertainty->parameters) {
    try {
      look_beside(design, x, parameter, margins);
    } catch (const SimulationError& error) {
      refuse(parameter, error.what());
    } catch (const InputError& error) {  // a section that there cannot be
      refuse(parameter, error.what());
    }
  }
  for (const Margin& margin : margins) {
    if (!margin.kink.empty() && margin.limit() != 0.0) {
      findings.push_back(
          {fmt::format(
               "the margin of the limit \"{}\" is made from a mean of two slopes: \"{}\" "
               "changes with \"{}\" to one side only, as where two frequencies or peaks "
               "coincide, and there twice as much. See `pleuel uncertainty` with samples, or "
               "ask for {:.3g} deviations.",
               margin.constraint->name, margin.constraint->response, margin.kink,
               std::numbers::sqrt2 * margin.constraint->deviations),
           false,
           {margin.constraint->response}});
      continue;
    }
    if (margin.missed <= worth_a_word || margin.limit() == 0.0) continue;
    findings.push_back(
        {fmt::format(
             "the margin of the limit \"{}\" is that of first order: {:g} deviations of "
             "\"{}\" to either side bring {} of the limit besides. See `pleuel uncertainty` "
             "with samples, or limit it in load cases with these values.",
             margin.constraint->name, margin.constraint->deviations, margin.parameter,
             rough_percent(margin.missed)),
         margin.missed > serious,
         {margin.constraint->response}});
  }
  return findings;
}

}  // namespace pleuel
