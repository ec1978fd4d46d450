#pragma once

#include "sensitivity/gradients.hpp"

namespace pleuel {

/// A maximum over time where two peaks of nearly the same height move differently with the design:
/// the response has a kink near here, its gradient is that of the higher peak only.
struct Kink {
  std::size_t response;
  PeakTie tie;
  double difference;  ///< of the two gradients, relative
};

/// Peaks whose gradients differ by less move alike with the design, as far as an optimizer can tell.
inline constexpr double least_kink = 1e-2;

/// ‖s ∘ (g − h)‖ / max(‖s ∘ g‖, ‖s ∘ h‖), 0 where both gradients vanish.
/// @param scales  s of variables, whose units may differ: step_scales()
double gradient_difference(const Eigen::RowVectorXd& g, const Eigen::RowVectorXd& h,
                           const Eigen::VectorXd& scales);

/// The kinks among the ties of an analysis: ties whose gradients differ by more than `least_kink`.
/// Costs one run of direct differentiation, and nothing if there is no tie.
std::vector<Kink> find_kinks(Analysis& analysis, const std::vector<DesignVariable>& variables);

/// Gradients of all responses, responses × variables [SI], and the kinks, by one run.
struct GradientsAndKinks {
  Eigen::MatrixXd gradients;
  std::vector<Kink> kinks;
};
GradientsAndKinks gradients_and_kinks(Analysis& analysis,
                                      const std::vector<DesignVariable>& variables,
                                      ExactMethod method);

}  // namespace pleuel
