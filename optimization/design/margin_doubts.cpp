#include "optimization/design/margin_doubts.hpp"

#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/base/number_text.hpp"

namespace pleuel {

namespace {

/// Of the limit.
constexpr double worth_a_word = 0.01, serious = 0.05;

/// A limit with a margin, and what of a parameter its first order misses most.
struct Margin {
  const ConstraintSettings* constraint;
  std::size_t response;
  double value;
  double missed = 0.0;  ///< of the limit
  std::string parameter{};

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

/// Of one parameter, into `margins`.
void look_beside(DesignProblem& design, const Eigen::VectorXd& x, Eigen::Index parameter,
                 double deviation, std::vector<Margin>& margins) {
  for (Margin& margin : margins) {
    Eigen::VectorXd above = x, below = x;
    above(parameter) += margin.constraint->deviations * deviation;
    below(parameter) -= margin.constraint->deviations * deviation;
    const double mean =
        0.5 * (design.value_at(above, margin.response) + design.value_at(below, margin.response));
    const double missed = margin.side() * (mean - margin.value) / std::abs(margin.limit());
    if (!(missed > margin.missed)) continue;
    margin.missed = missed;
    margin.parameter = design.file().variables[static_cast<std::size_t>(parameter)].name;
  }
}

}  // namespace

std::vector<Doubt> doubt_margins(DesignProblem& design, const Eigen::VectorXd& x) {
  std::vector<Margin> margins = margins_of(design, x);
  if (margins.empty()) return {};
  const Eigen::VectorXd deviations = design.variable_deviations();
  std::vector<Doubt> doubts;
  for (Eigen::Index i = 0; i < deviations.size(); ++i) {
    if (deviations(i) == 0.0) continue;
    try {
      look_beside(design, x, i, deviations(i), margins);
    } catch (const SimulationError& error) {
      doubts.push_back(
          {fmt::format("at the deviations of \"{}\" that limits ask for the mechanism "
                       "cannot be simulated: {}",
                       design.file().variables[static_cast<std::size_t>(i)].name, error.what()),
           true});
    }
  }
  for (const Margin& margin : margins) {
    if (margin.missed <= worth_a_word || margin.limit() == 0.0) continue;
    doubts.push_back(
        {fmt::format(
             "the margin of the limit \"{}\" is that of first order: {:g} deviations of "
             "\"{}\" to either side bring {} of the limit besides. See `pleuel uncertainty` "
             "with samples, or limit it in load cases with these values.",
             margin.constraint->name, margin.constraint->deviations, margin.parameter,
             rough_percent(margin.missed)),
         margin.missed > serious,
         {margin.constraint->response}});
  }
  return doubts;
}

}  // namespace pleuel
