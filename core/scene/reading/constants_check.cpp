#include "core/scene/reading/constants_check.hpp"

#include <cmath>

#include <Eigen/SparseCholesky>
#include <fmt/format.h>

#include "core/base/dense_solvers.hpp"

namespace pleuel {

namespace {

/// Relative to the largest entry: other codes may write single precision or seven digits.
constexpr double tolerance = 1e-6;
/// Places closer than this share of the extent are one.
constexpr double distinct = 1e-9;

double largest(const SparseMatrix& matrix) {
  return matrix.nonZeros() > 0 ? matrix.coeffs().abs().maxCoeff() : 0.0;
}

void check_symmetry(const JsonNode& block, const std::string& key, const SparseMatrix& matrix) {
  const SparseMatrix difference = matrix - SparseMatrix(matrix.transpose());
  if (largest(difference) <= tolerance * largest(matrix)) return;
  block.at(key).fail(fmt::format("must be symmetric, but differs from its transpose by {:.3g}",
                                 largest(difference)));
}

/// By the pivots of the matrix with a diagonal of ones.
bool is_positive_definite(const SparseMatrix& matrix) {
  constexpr double least_pivot = 1e-14;
  const Eigen::VectorXd diagonal = matrix.diagonal();
  if (diagonal.minCoeff() <= 0.0) return false;
  const Eigen::VectorXd scale = diagonal.cwiseSqrt().cwiseInverse();
  const Eigen::SparseMatrix<double> scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(scaled);
  return factors.info() == Eigen::Success && factors.vectorD().minCoeff() > least_pivot;
}

/// S_xx + S_yy + S_zz is the mass matrix, if both come from one interpolation.
void check_moments(const JsonNode& block, const BodyConstants& constants) {
  for (std::size_t i : {0U, 1U, 2U}) {
    const std::string key = fmt::format("moment_{0}{0}", "xyz"[i]);
    if (block.find(key)) check_symmetry(block, key, constants.moments[i]);
  }
  const SparseMatrix sum = constants.moments[0] + constants.moments[1] + constants.moments[2];
  const SparseMatrix difference = sum - constants.mass_matrix;
  if (largest(difference) <= tolerance * largest(constants.mass_matrix)) return;
  block.fail(fmt::format(
      "must have \"mass_matrix\" = \"moment_xx\" + \"moment_yy\" + \"moment_zz\", but they differ "
      "by {:.3g} [kg], {:.3g} of the largest entry",
      largest(difference), largest(difference) / largest(constants.mass_matrix)));
}

void check_rigid_inertia(const JsonNode& block, const BodyConstants& constants) {
  if (constants.mass <= 0.0) block.at("mass").fail_with_value("must be positive [kg]");
  const Eigen::Matrix3d& second = constants.second_moment;
  const double size = second.cwiseAbs().maxCoeff();
  if ((second - second.transpose()).cwiseAbs().maxCoeff() > tolerance * size) {
    block.at("second_moment").fail_with_value("must be symmetric");
  }
  const Eigen::Matrix3d central =
      second - constants.first_moment * constants.first_moment.transpose() / constants.mass;
  if (symmetric_eigenvalues(central)(0) < -tolerance * size) {
    block.at("second_moment")
        .fail_with_value("must be at least first_moment first_momentᵀ / mass in every direction");
  }
}

void check_places(const JsonNode& node, const BodyConstants& constants) {
  const double near = distinct * size_of(constants);
  for (std::size_t i = 0; i < constants.places.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if ((constants.places[i].position - constants.places[k].position).norm() > near) continue;
      node.at(constants.places[i].name)
          .fail(fmt::format("is where the place \"{}\" is", constants.places[k].name));
    }
  }
}

}  // namespace

void check_constants(const JsonNode& node, const BodyConstants& constants) {
  const JsonNode block = node.at("invariants");
  check_rigid_inertia(block, constants);
  for (const auto& [key, matrix] : {std::pair("mass_matrix", &constants.mass_matrix),
                                    std::pair("stiffness", &constants.stiffness)}) {
    check_symmetry(block, key, *matrix);
  }
  if (block.find("damping")) check_symmetry(block, "damping", constants.damping);
  check_moments(block, constants);
  if (!is_positive_definite(constants.mass_matrix)) {
    block.at("mass_matrix").fail("must be positive definite: every coordinate moves mass");
  }
  if (!is_positive_definite(constants.stiffness)) {
    block.at("stiffness")
        .fail(
            "must be positive definite: the reference condition leaves the elastic coordinates no "
            "rigid motion");
  }
  check_places(node.at("places"), constants);
  if (!constants.stretching) return;
  const std::vector<JsonNode> elements = node.at("stiffening").at("elements").items();
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const Eigen::MatrixXd& slopes = constants.stretching->elements[i].slopes;
    const double size = slopes.cwiseAbs().maxCoeff();
    if ((slopes - slopes.transpose()).cwiseAbs().maxCoeff() > tolerance * size) {
      elements[i].at("slopes").fail_with_value("must be symmetric");
    }
  }
}

void check_derivative(const JsonNode& node, const BodyConstants& change) {
  const auto block = node.find("invariants");
  if (!block) return;
  for (const auto& [key, matrix] :
       {std::pair("mass_matrix", &change.mass_matrix), std::pair("stiffness", &change.stiffness),
        std::pair("damping", &change.damping)}) {
    if (block->find(key)) check_symmetry(*block, key, *matrix);
  }
  check_moments(*block, change);
}

}  // namespace pleuel
