#include "core/response/body_frequency.hpp"

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/beam/elastic_basis.hpp"
#include "core/beam/natural_modes.hpp"

namespace pleuel {

namespace {

/// Squares of frequencies that differ by less are one, several times.
constexpr double coincidence = 1e-6;

}  // namespace

DesignConstant body_frequency(const BodyModel& body, int mode, int variables) {
  if (mode >= body.elastic_size()) {
    throw InputError(fmt::format("the body \"{}\" has {} natural frequencies, not {}", body.name,
                                 body.elastic_size(), mode + 1));
  }
  const auto dense = [&](const Eigen::VectorXd& entries) {
    return dense_matrix(body.invariants.pattern, entries);
  };
  const NaturalModes modes =
      natural_modes(dense(body.invariants.stiffness), dense(body.invariants.mass_matrix));
  const double square = modes.lambda(mode);
  const Eigen::Array<bool, Eigen::Dynamic, 1> coincides =
      (modes.lambda.array() - square).abs() <= coincidence * square;
  DesignConstant frequency;
  frequency.value = std::sqrt(square);
  frequency.derivatives = Eigen::VectorXd::Zero(variables);
  for (const auto& [variable, change] : body.invariants_x) {
    const Eigen::MatrixXd matrix = dense(change.stiffness) - square * dense(change.mass_matrix);
    double sum = 0.0;
    for (Eigen::Index i = 0; i < coincides.size(); ++i) {
      const auto shape = modes.shapes.col(i);
      if (coincides(i)) sum += shape.dot(matrix * shape);
    }
    frequency.derivatives(variable) =
        sum / static_cast<double>(coincides.count()) / (2.0 * frequency.value);
  }
  return frequency;
}

}  // namespace pleuel
