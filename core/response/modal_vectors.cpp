#include "core/response/modal_vectors.hpp"

#include <random>
#include <vector>

#include "core/base/dense_solvers.hpp"
#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/int_size.hpp"
#include "core/response/motion_along.hpp"

namespace pleuel {

double number_of(ModeNumber of, std::complex<double> s) {
  switch (of) {
    case ModeNumber::damping_ratio:
      return -s.real() / std::abs(s);
    case ModeNumber::growth_rate:
      return s.real();
    default:
      return frequency_of(s);
  }
}

double change_of_number(ModeNumber of, std::complex<double> s, std::complex<double> change) {
  switch (of) {
    case ModeNumber::damping_ratio:  // of −Re e^{iφ}, which turns by Im(s'/s)
      return s.imag() / std::abs(s) * (change / s).imag();
    case ModeNumber::growth_rate:
      return change.real();
    default:
      return vibrates(s) ? change.imag() : -change.real();
  }
}

namespace {

/// Eigenvalues that differ by less, relatively, are one, several times.
constexpr double coincidence_of_eigenvalues = 1e-6;
/// Relative distance from the eigenvalue at which its vectors are sought.
constexpr double detuning = 1e-9;

/// Combines columns until their first n rows are orthonormal (modified Gram–Schmidt).
void orthonormalize(Eigen::Index n, Eigen::MatrixXcd& x) {
  for (Eigen::Index j = 0; j < x.cols(); ++j) {
    for (Eigen::Index i = 0; i < j; ++i) {
      const std::complex<double> along = x.col(i).head(n).dot(x.col(j).head(n));
      x.col(j) -= along * x.col(i);
    }
    const double length = x.col(j).head(n).norm();
    x.col(j) /= length;
  }
}

/// Inverse iteration of a block of vectors, x ← P⁻¹ P_s x: others shrink by the detuning over their
/// distance, a thousandth and less.
/// @param n  number of coordinates, which come first
Eigen::MatrixXcd null_vectors(const Eigen::MatrixXcd& pencil, const Eigen::MatrixXcd& slope,
                              Eigen::Index n, Eigen::Index count) {
  const ComplexLu solver(pencil);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Eigen::MatrixXcd x = Eigen::MatrixXcd::NullaryExpr(
      pencil.rows(), count, [&] { return std::complex<double>(uniform(random), uniform(random)); });
  for (int iteration = 0; iteration < 5; ++iteration) {
    x = solver.solve(slope * x);
    orthonormalize(n, x);
  }
  return x;
}

/// Which eigenvalues coincide with one.
std::vector<int> coinciding(const Eigen::VectorXcd& modes, int mode) {
  std::vector<int> found;
  for (int i = 0; i < int_size(modes); ++i) {
    const double distance = std::abs(modes(i) - modes(mode));
    if (distance < coincidence_of_eigenvalues * std::abs(modes(mode)) || i == mode) {
      found.push_back(i);
    }
  }
  return found;
}

}  // namespace

ModalVectors modal_vectors(const Linearization& linearized, const Eigen::VectorXcd& modes,
                           int mode) {
  const Eigen::Index n = linearized.M.rows(), m = linearized.phi.rows();
  ModalVectors vectors;
  vectors.s = modes(mode);
  const auto count = std::ssize(coinciding(modes, mode));
  // Not exactly at the eigenvalue, where the pencil is singular.
  const std::complex<double> s = vectors.s * (1.0 + detuning);
  const Pencil pencil = pencil_at(linearized, s);
  Eigen::MatrixXcd slope = Eigen::MatrixXcd::Zero(n + m, n + m);
  slope.topLeftCorner(n, n) = 2.0 * s * linearized.M + linearized.G;
  const Eigen::MatrixXcd right = null_vectors(pencil.matrix, slope, n, count);
  const Eigen::MatrixXcd left = null_vectors(pencil.matrix.adjoint(), slope.adjoint(), n, count);
  vectors.right = right.topRows(n);
  vectors.left = left.topRows(n);
  vectors.right_multipliers = pencil.kappa * right.bottomRows(m);
  vectors.left_multipliers = pencil.kappa * left.bottomRows(m);
  return vectors;
}

LinearizedModes::LinearizedModes(const Model& of_model, const State& at, bool is_damped)
    : model(of_model),
      state(at),
      linearized(linearize(model.mechanism, state, is_damped)),
      modes(modes_of(linearized)) {}

namespace {

/// How many of the modes that coincide with one count, which is the first of them.
class ModeCount {
 public:
  ModeCount(const LinearizedModes& mechanism, const ModeChoice& choice)
      : mechanism_(mechanism), choice_(choice) {
    if (!choice.axis) return;
    const Eigen::Map<const Eigen::Vector3d> axis(choice.axis->data());
    along_ = mass_along(mechanism.model, mechanism.state, axis);
  }

  Eigen::Index operator()(int mode) const {
    const auto& [model, state, linearized, modes] = mechanism_;
    if (choice_.of == ModeNumber::damping_ratio && !vibrates(modes(mode))) return 0;
    if (!choice_.axis) return 1;
    if (coinciding(modes, mode).front() != mode) return 0;
    const Eigen::MatrixXcd vectors = modal_vectors(linearized, modes, mode).right;
    return combinations_along(vectors, linearized.M, along_).cols();
  }

 private:
  const LinearizedModes& mechanism_;
  const ModeChoice& choice_;
  Eigen::MatrixXd along_;
};

}  // namespace

int find_mode(const LinearizedModes& mechanism, const ModeChoice& choice) {
  const ModeCount count(mechanism, choice);
  const Eigen::VectorXcd& modes = mechanism.modes;
  const auto badness = [&](int mode) {
    const double number = number_of(choice.of, modes(mode));
    return choice.of == ModeNumber::damping_ratio ? -number : number;
  };
  Eigen::Index counted = 0;
  int worst = -1;
  for (int mode = 0; mode < int_size(modes); ++mode) {
    const bool may_be_worst = worst < 0 || badness(mode) > badness(worst);
    if (choice.number == ModeChoice::worst && !may_be_worst) continue;
    const Eigen::Index more = count(mode);
    counted += more;
    if (more > 0) worst = mode;
    if (choice.number != ModeChoice::worst && choice.number < counted) return mode;
  }
  if (choice.number == ModeChoice::worst && worst >= 0) return worst;
  refuse_mode("the mechanism", counted, choice);
}

}  // namespace pleuel
