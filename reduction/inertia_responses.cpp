#include "reduction/inertia_responses.hpp"

#include <cmath>

#include "core/base/error.hpp"

namespace pleuel {

namespace {

/// What is left of a vector that has nothing new, relative.
constexpr double nothing_new = 1e-8;

/// Without its parts in the columns before it, and with the mean square 1. Twice is enough (Parlett, The
/// Symmetric Eigenvalue Problem, §6.9).
void make_orthogonal(Eigen::MatrixXd& vectors, Eigen::Index column) {
  Eigen::VectorXd x = vectors.col(column);
  const double size = std::sqrt(double(x.size())), before = x.norm();
  const auto others = vectors.leftCols(column);
  for (int pass = 0; pass < 2; ++pass) {
    const Eigen::VectorXd parts = others.transpose() * x / (size * size);
    x -= others * parts;
  }
  if (!(x.norm() > nothing_new * before)) {
    throw InputError(
        "/modes/inertia_responses has a generation that says nothing new; ask for fewer");
  }
  vectors.col(column) = x * (size / x.norm());
}

}  // namespace

LowestModes inertia_responses(const StaticSolution& solve, const SolidMatrix& stiffness,
                              const SolidMatrix& mass, const Eigen::MatrixXd& rigid,
                              int generations) {
  const Eigen::Index each = rigid.cols();
  LowestModes found;
  found.shapes.resize(rigid.rows(), generations * each);
  Eigen::MatrixXd last = rigid;
  for (int g = 0; g < generations; ++g) {
    last = solve(mass * last);
    found.shapes.middleCols(g * each, each) = last;
    for (Eigen::Index i = g * each; i < (g + 1) * each; ++i) {
      make_orthogonal(found.shapes, i);
    }
    last = found.shapes.middleCols(g * each, each);
  }
  found.squares = (found.shapes.transpose() * (stiffness * found.shapes)).diagonal();
  const Eigen::VectorXd inertia = (found.shapes.transpose() * (mass * found.shapes)).diagonal();
  found.squares = found.squares.cwiseQuotient(inertia);
  return found;
}

}  // namespace pleuel
