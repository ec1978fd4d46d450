#include "core/response/body_frequency.hpp"

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/beam/elastic_basis.hpp"

namespace pleuel {

FrequencyWithDerivatives body_frequency(const BodyModel& body, int mode, int variables) {
  if (mode >= body.elastic_size()) {
    throw InputError(fmt::format("the body \"{}\" has {} natural frequencies, not {}", body.name,
                                 body.elastic_size(), mode + 1));
  }
  const auto dense = [&](const Eigen::VectorXd& entries) {
    return dense_matrix(body.invariants.pattern, entries);
  };
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> modes(
      dense(body.invariants.stiffness), dense(body.invariants.mass_matrix));
  const double square = modes.eigenvalues()(mode);
  const Eigen::VectorXd shape = modes.eigenvectors().col(mode);
  FrequencyWithDerivatives frequency;
  frequency.value = std::sqrt(square);
  frequency.derivatives = Eigen::VectorXd::Zero(variables);
  for (const auto& [variable, change] : body.invariants_x) {
    const Eigen::MatrixXd matrix = dense(change.stiffness) - square * dense(change.mass_matrix);
    frequency.derivatives(variable) = shape.dot(matrix * shape) / (2.0 * frequency.value);
  }
  return frequency;
}

}  // namespace pleuel
