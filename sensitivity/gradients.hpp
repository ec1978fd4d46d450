#pragma once

#include <string>
#include <vector>

#include "core/response/analysis.hpp"
#include "sensitivity/finite_difference.hpp"
#include "sensitivity/sampled_gradients.hpp"

namespace pleuel {

struct GradientOptions {
  /// Relative step of finite differences, Δx = step · step_scale().
  double difference_step = 1e-5;
  /// Simulations at a time, of finite differences.
  int threads = 1;
};

/// How gradients are computed, and why: a sentence.
struct GradientChoice {
  GradientMethod method;  ///< not automatic
  std::string reason;
};

/// The method that is asked for; where that is left open, the cheaper one of the exact ones.
GradientChoice choose_gradients(GradientMethod asked, Analysis& analysis,
                                const std::vector<SampledValue>& values);

/// Whether simulations of neighbouring designs make the gradients.
bool is_difference(GradientMethod method);

/// Direct differentiation or the adjoint. @pre one of the two
ExactMethod exact_method(GradientMethod method);

/// Gradients of some numbers by differences of simulations with the steps of the analysis, numbers
/// × variables.
/// @param method  one of the two differences
Eigen::MatrixXd gradients_by_differences(const ProblemFile& problem, const Eigen::VectorXd& x,
                                         const Analysis& analysis, GradientMethod method,
                                         const ValuesOf& values, const GradientOptions& options);

/// Gradients of all responses, responses × variables; unit of entry (i, j) = unit of response i /
/// unit of variable j [SI].
/// @param analysis  of the problem at x
/// @throws SimulationError
Eigen::MatrixXd gradients(const ProblemFile& problem, const Eigen::VectorXd& x, Analysis& analysis,
                          GradientMethod method, const GradientOptions& options = {});

/// Those of all responses by direct differentiation, from the analysis alone.
Eigen::MatrixXd direct_gradients(Analysis& analysis);

/// The history of a response at the place where its value is taken (that of a peak, of several
/// places), with its derivatives at every instant.
struct HistoryGradients {
  std::size_t response;
  int place;                  ///< row of the history
  Eigen::VectorXd values;     ///< one an instant [SI]
  Eigen::MatrixXd gradients;  ///< instants × variables [SI]
};

/// Of all responses that have a history, by one run of direct differentiation.
/// @throws SimulationError
std::vector<HistoryGradients> history_gradients(Analysis& analysis);

/// Derivatives of values and histories by the same run.
struct ResponseDerivatives {
  Eigen::MatrixXd values;  ///< responses × variables [SI]
  std::vector<HistoryGradients> histories;
};

/// @throws SimulationError
ResponseDerivatives response_derivatives(Analysis& analysis);

}  // namespace pleuel
