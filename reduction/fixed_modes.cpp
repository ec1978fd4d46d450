#include "reduction/fixed_modes.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/dense_solvers.hpp"
#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/int_size.hpp"

namespace pleuel {

namespace {

constexpr int block_size = 4;
constexpr double residual_tolerance = 1e-6;  // the error of a value is its square

/// Basis vectors with M Q, and K⁻¹ M Q: the space that modes are looked for in.
class KrylovSpace {
 public:
  KrylovSpace(const StaticSolution& solve, const SolidMatrix& mass) : solve_(solve), mass_(mass) {}

  int size() const { return int_size(q_.row(0)); }

  /// @returns false if nothing new is left
  bool add(Eigen::MatrixXd block) {
    const int before = static_cast<int>(q_.cols());
    for (Eigen::Index j = 0; j < block.cols(); ++j) append(block.col(j));
    const Eigen::Index added = q_.cols() - before;
    if (added == 0) return false;
    const Eigen::MatrixXd image = solve_(mq_.rightCols(added));
    image_.conservativeResize(image.rows(), q_.cols());
    image_.rightCols(added) = image;
    last_ = static_cast<int>(added);
    return true;
  }

  Eigen::MatrixXd newest_images() const { return image_.rightCols(last_); }

  /// θ = 1/ω² in falling order.
  LowestModes find(int count, double& residual) const {
    const Eigen::MatrixXd projected = mq_.transpose() * image_;
    const SymmetricModes modes = symmetric_modes(0.5 * (projected + projected.transpose()));
    const int found = std::min(count, int_size(modes.values));
    LowestModes lowest{modes.values.reverse().head(found),
                       modes.vectors.rowwise().reverse().leftCols(found)};
    residual = 0.0;
    for (int i = 0; i < found; ++i) {
      const Eigen::VectorXd y = lowest.shapes.col(i);
      const Eigen::VectorXd r = image_ * y - lowest.squares(i) * (q_ * y);
      residual = std::max(residual, std::sqrt(r.dot(mass_ * r)) / lowest.squares(i));
    }
    lowest.shapes = q_ * lowest.shapes;
    lowest.squares = lowest.squares.cwiseInverse();
    return lowest;
  }

 private:
  /// Twice is enough (Parlett, The Symmetric Eigenvalue Problem, §6.9).
  void append(Eigen::VectorXd x) {
    const double before = std::sqrt(x.dot(mass_ * x));
    for (int pass = 0; pass < 2 && q_.cols() > 0; ++pass) {
      const Eigen::VectorXd parts = mq_.transpose() * x;
      x -= q_ * parts;
    }
    Eigen::VectorXd mx = mass_ * x;
    const double norm = std::sqrt(x.dot(mx));
    if (!(norm > 1e-12 * before)) return;
    const Eigen::Index column = q_.cols();
    q_.conservativeResize(x.size(), column + 1);
    mq_.conservativeResize(x.size(), column + 1);
    q_.col(column) = x / norm;
    mq_.col(column) = mx / norm;
  }

  const StaticSolution& solve_;
  const SolidMatrix& mass_;
  Eigen::MatrixXd q_, mq_, image_;
  int last_ = 0;
};

/// The same in every run: no chance decides over a result.
Eigen::MatrixXd starting_block(Eigen::Index rows) {
  Eigen::MatrixXd block(rows, block_size);
  RepeatedChance chance(12345);
  for (double& number : block.reshaped()) number = chance() / 4294967296.0 - 0.5;
  return block;
}

}  // namespace

LowestModes lowest_modes(const StaticSolution& solve, const SolidMatrix& mass, int count) {
  if (count == 0) return {Eigen::VectorXd(0), Eigen::MatrixXd(mass.rows(), 0)};
  KrylovSpace space(solve, mass);
  // The images of any vectors obey what is held.
  bool has_more = space.add(solve(mass * starting_block(mass.rows())));
  const int most = std::min(int_size(mass.diagonal()), 20 * count + 200);
  double residual = 1.0;
  while (has_more && space.size() < most) {
    has_more = space.add(space.newest_images());
    if (space.size() < count + 2 * block_size) continue;
    LowestModes modes = space.find(count, residual);
    if (residual < residual_tolerance) return modes;
  }
  LowestModes modes = space.find(count, residual);
  const bool is_whole_space = !has_more && int_size(modes.squares) == count;
  if (is_whole_space) return modes;
  throw SimulationError(
      fmt::format("the {} lowest modes with held interfaces were not found: of {} "
                  "vectors the residual is {:.1e}; ask for fewer",
                  count, space.size(), residual));
}

}  // namespace pleuel
