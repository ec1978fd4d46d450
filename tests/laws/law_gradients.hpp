#pragma once

#include "core/response/analysis.hpp"
#include "sensitivity/finite_difference.hpp"
#include "sensitivity/sampled_gradients.hpp"

namespace pleuel::test {

/// Gradients of all responses of a problem at its start, by three ways: responses × variables.
struct LawGradients {
  Eigen::MatrixXd direct, adjoint;
  Eigen::MatrixXd differences;  ///< of simulations, central, with one Richardson step
};

inline LawGradients law_gradients(const ProblemFile& problem) {
  const Eigen::VectorXd x = start_design(problem);
  const auto analysis = analyze(problem, x);
  const std::vector<SampledValue> values = response_values(*analysis);
  const Eigen::MatrixXd wide = central_differences(problem, x, 1e-3),
                        narrow = central_differences(problem, x, 5e-4);
  return {sampled_gradients(*analysis, values, ExactMethod::direct),
          sampled_gradients(*analysis, values, ExactMethod::adjoint), (4.0 * narrow - wide) / 3.0};
}

}  // namespace pleuel::test
