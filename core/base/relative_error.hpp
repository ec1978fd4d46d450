#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

/// How wrong a number or a gradient is, compared with a better one.
namespace pleuel {

/// |v − r| / max(|r|, 1e-3 · magnitude)
/// @param magnitude  of the history behind the value: a final position near zero is not blamed for
///                   what is small beside the motion
inline double value_error(double value, double reference, double magnitude) {
  const double difference = std::abs(value - reference);
  return difference == 0.0 ? 0.0 : difference / std::max(std::abs(reference), 1e-3 * magnitude);
}

/// ‖x ∘ (g − r)‖₂ / max(‖x ∘ r‖₂, 1e-3 · magnitude): sensitivities to relative changes of the
/// design, so that variables of different units can be added, and a response that hardly depends
/// on the design is not blamed for round-off.
inline double gradient_error(const Eigen::VectorXd& gradient, const Eigen::VectorXd& reference,
                             const Eigen::VectorXd& x, double magnitude) {
  const double difference = (gradient - reference).cwiseProduct(x).norm();
  const double size = std::max(reference.cwiseProduct(x).norm(), 1e-3 * magnitude);
  return difference == 0.0 ? 0.0 : difference / size;
}

}  // namespace pleuel
