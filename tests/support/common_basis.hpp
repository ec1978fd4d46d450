#pragma once

#include <Eigen/Core>

#include "core/model/model.hpp"
#include "tests/support/dense_algebra.hpp"

/// Derivatives of a basis of elastic coordinates hold up to changes of basis within its span. What
/// differences of neighbouring models are to be compared with them must be in the same coordinates:
/// the matrix B of
///     q_neighbour = B q,   Z_neighbour B = Z + change · ∂Z/∂x  (least squares)
/// for all coordinates of the system; the identity where there is no basis. If the span of the
/// derivative is wrong, the differences show it: Z_neighbour B stays in the true span.
inline Eigen::MatrixXd change_of_basis(const pleuel::Model& model, const pleuel::Model& neighbour,
                                       int variable, double change) {
  const int n = model.mechanism.system->coordinates();
  Eigen::MatrixXd b = Eigen::MatrixXd::Identity(n, n);
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    const pleuel::BodyModel& body = model.bodies[i];
    if (!body.has_basis) continue;
    Eigen::MatrixXd expected(body.places.shape);
    for (const auto& [k, derivative] : body.places_x) {
      if (k == variable) expected += change * derivative.shape;
    }
    const int first = body.elastic_offset(), size = body.elastic_size();
    b.block(first, first, size, size) =
        pleuel::test::least_squares(Eigen::MatrixXd(neighbour.bodies[i].places.shape), expected);
  }
  return b;
}
