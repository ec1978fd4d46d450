#include "core/response/body_frequency.hpp"

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/beam/elastic_basis.hpp"

namespace pleuel {

namespace {

/// Squares of frequencies that differ by less are one, several times.
constexpr double coincidence = 1e-6;

}  // namespace

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
  const Eigen::Array<bool, Eigen::Dynamic, 1> coincides =
      (modes.eigenvalues().array() - square).abs() <= coincidence * square;
  FrequencyWithDerivatives frequency;
  frequency.value = std::sqrt(square);
  frequency.derivatives = Eigen::VectorXd::Zero(variables);
  for (const auto& [variable, change] : body.invariants_x) {
    const Eigen::MatrixXd matrix = dense(change.stiffness) - square * dense(change.mass_matrix);
    double sum = 0.0;
    for (Eigen::Index i = 0; i < coincides.size(); ++i) {
      const auto shape = modes.eigenvectors().col(i);
      if (coincides(i)) sum += shape.dot(matrix * shape);
    }
    frequency.derivatives(variable) =
        sum / static_cast<double>(coincides.count()) / (2.0 * frequency.value);
  }
  return frequency;
}

}  // namespace pleuel
