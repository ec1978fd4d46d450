#include "optimization/polish.hpp"

#include <algorithm>

#include "core/base/dense_solvers.hpp"
#include "core/base/eager_matrices.hpp"
#include "optimization/backends.hpp"
#include "optimization/generic_numbers.hpp"

namespace pleuel {

namespace {

constexpr double near_optimum = 0.1;  ///< KKT residual
constexpr double near_limits = 1e-2;  ///< relative violation
constexpr double part_of_gain = 0.1;  ///< that is left of Tolerances::gain without a polish
constexpr double tolerance = 1e-10;   ///< a small part changes the objective by little
constexpr double least_terms = 1e-6;  ///< of T_max: balanced up to here
constexpr int consecutive_failures = 3;
/// Evaluations without gradients: near an optimum a full step does, or noise is all there is.
constexpr int line_search = 10;

Eigen::VectorXd balance(const KktAudit& audit) {
  const double largest = audit.terms.maxCoeff();
  if (!(largest > 0.0)) return Eigen::VectorXd::Ones(audit.terms.size());
  return (audit.terms / largest).cwiseMax(least_terms).cwiseInverse().cwiseSqrt();
}

}  // namespace

bool is_worth_polishing(const Verdict& verdict, const Tolerances& tolerances) {
  if (verdict.status == Status::verified) {
    return verdict.gain_left > part_of_gain * tolerances.gain;
  }
  return !verdict.gradients_are_disproved && !verdict.better_neighbour &&
         verdict.design.max_violation <= near_limits && verdict.audit.residual <= near_optimum;
}

Eigen::VectorXd polish(EvaluationCache& cache, const EvaluatedDesign& from, const KktAudit& audit,
                       const PolishBudget& budget) {
  return run_backend(cache, from, polisher, tolerance,
                     {budget.iterations, budget.evaluations, consecutive_failures, line_search, 0},
                     balance(audit))
      .x;
}

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
