#pragma once

#include "cli/text/json.hpp"
#include "sensitivity/gradients.hpp"

/// What the variables change of the responses of a simulated design.
namespace pleuel {

struct DesignInfluence {
  Eigen::MatrixXd gradients;  ///< responses × variables [SI]
  /// Empty where they would take too much time or memory.
  std::vector<HistoryGradients> histories{};
};

/// Of a simulation that is there already: no other one is made. With few variables by one run of
/// direct differentiation, which gives the histories, too; with many by the cheaper exact method.
/// Null without variables, and where the gradients cannot be computed.
std::shared_ptr<const DesignInfluence> design_influence(const ProblemFile& problem,
                                                        Analysis& analysis);

}  // namespace pleuel
