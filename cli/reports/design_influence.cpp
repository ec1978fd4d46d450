#include "cli/reports/design_influence.hpp"

#include "core/base/error.hpp"
#include "sensitivity/method_choice.hpp"

namespace pleuel {

namespace {

/// Direct differentiation takes as much time as some simulations for so many variables.
constexpr std::size_t most_variables = 24;
constexpr double most_numbers = 1e7;  ///< derivatives at instants: 80 MB

bool is_cheap(const ProblemFile& problem, const Analysis& analysis) {
  double histories = 0.0;
  for (const Response& response : analysis.responses) histories += response.history() ? 1.0 : 0.0;
  const auto variables = static_cast<double>(problem.variables.size());
  const auto instants = static_cast<double>(analysis.trajectory.time.size());
  return problem.variables.size() <= most_variables &&
         histories * variables * instants <= most_numbers;
}

}  // namespace

std::shared_ptr<const DesignInfluence> design_influence(const ProblemFile& problem,
                                                        Analysis& analysis) {
  if (problem.variables.empty() || analysis.responses.empty()) return nullptr;
  try {
    if (is_cheap(problem, analysis)) {
      ResponseDerivatives all = response_derivatives(analysis);
      return std::make_shared<DesignInfluence>(
          DesignInfluence{std::move(all.values), std::move(all.histories)});
    }
    const std::vector<SampledValue> values = response_values(analysis);
    return std::make_shared<DesignInfluence>(DesignInfluence{
        sampled_gradients(analysis, values, choose_method(analysis, values).method)});
  } catch (const SimulationError&) {
    return nullptr;
  }
}

}  // namespace pleuel
