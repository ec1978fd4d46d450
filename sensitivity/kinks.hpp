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

/// The kinks among the ties of an analysis: ties whose gradients differ by more than a hundredth.
/// Costs one run of direct differentiation, and nothing if there is no tie.
std::vector<Kink> find_kinks(Analysis& analysis);

/// Gradients of all responses, responses × variables [SI], and the kinks, by one run.
struct GradientsAndKinks {
  Eigen::MatrixXd gradients;
  std::vector<Kink> kinks;
};
GradientsAndKinks gradients_and_kinks(Analysis& analysis, ExactMethod method);

}  // namespace pleuel
