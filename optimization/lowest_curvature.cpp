#include "optimization/lowest_curvature.hpp"

#include <algorithm>

#include "core/base/dense_solvers.hpp"
#include "core/base/eager_matrices.hpp"
#include "optimization/generic_numbers.hpp"

namespace pleuel {

namespace {

/// Below this part of its length a vector lies in the span of the others.
constexpr double dependent = 1e-6;

/// What is left of a vector across orthonormal columns; twice is enough against rounding.
Eigen::VectorXd across(const Eigen::MatrixXd& columns, Eigen::VectorXd vector) {
  for (int pass = 0; pass < 2; ++pass) vector -= columns * (columns.transpose() * vector);
  return vector;
}

/// A vector with entries of generic size, as far as it lies in the subspace and across the others.
Eigen::VectorXd generic_direction(GenericNumbers& numbers, const Eigen::MatrixXd& basis,
                                  const Eigen::MatrixXd& others) {
  Eigen::VectorXd direction;
  do {
    Eigen::VectorXd parts(basis.cols());
    for (double& part : parts) {
      part = numbers.part() - 0.5;
    }
    direction = across(others, basis * parts);
  } while (direction.norm() < dependent);
  return direction.normalized();
}

}  // namespace

LowestCurvature lowest_curvature(const HessianProduct& product, const Eigen::MatrixXd& basis,
                                 int max_products) {
  GenericNumbers numbers;
  const Eigen::Index most = std::min<Eigen::Index>(max_products, basis.cols());
  Eigen::MatrixXd directions(basis.rows(), 0), images(basis.rows(), 0);
  Eigen::VectorXd next = generic_direction(numbers, basis, directions);
  while (true) {
    const auto image = product(next);
    if (!image) break;
    const Eigen::Index count = directions.cols() + 1;
    directions.conservativeResize(Eigen::NoChange, count);
    images.conservativeResize(Eigen::NoChange, count);
    directions.col(count - 1) = next;
    images.col(count - 1) = basis * (basis.transpose() * *image);
    if (count == most) break;
    next = across(directions, images.col(count - 1));
    const bool is_invariant = next.norm() <= dependent * images.col(count - 1).norm();
    next = is_invariant ? generic_direction(numbers, basis, directions) : next.normalized();
  }
  LowestCurvature lowest;
  lowest.products = static_cast<int>(directions.cols());
  if (lowest.products == 0) return lowest;
  const Eigen::MatrixXd form = directions.transpose() * images;
  lowest.form = 0.5 * (form + form.transpose());
  const SymmetricModes modes = symmetric_modes(lowest.form);
  lowest.curvature = modes.values[0];
  lowest.directions = directions;
  lowest.direction = (directions * modes.vectors.col(0)).normalized();
  return lowest;
}

}  // namespace pleuel
