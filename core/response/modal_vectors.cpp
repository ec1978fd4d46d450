#include "core/response/modal_vectors.hpp"

#include <optional>
#include <random>
#include <vector>

#include "core/base/dense_solvers.hpp"
#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/int_size.hpp"
#include "core/base/rotation_vector.hpp"
#include "core/beam/elastic_basis.hpp"
#include "core/model/body_frames.hpp"

namespace pleuel {

namespace {

/// Beyond one half, so that what turns about the axis of a square beam is no motion along y or z.
constexpr double most = 0.5 + 1e-6;

/// Integrals over a body in one configuration, in body axes, for a direction e.
struct IntegralsAlong {
  Eigen::Vector3d first;           ///< ∫ρ p
  Eigen::Matrix3d second;          ///< ∫ρ p pᵀ
  Eigen::RowVectorXd shape;        ///< ∫ρ e·S
  Eigen::Matrix3Xd first_shape;    ///< ∫ρ p (e·S)
  Eigen::MatrixXd shape_products;  ///< ∫ρ (e·S)ᵀ (e·S)

  /// @param q  elastic coordinates
  IntegralsAlong(const Invariants<double>& body, const Eigen::VectorXd& q,
                 const Eigen::Vector3d& e) {
    const Eigen::VectorXd mixed = body.mixed * q;
    first = body.first_moment + body.shape * q;
    second = body.second_moment;
    shape = e.transpose() * body.shape;
    first_shape = Eigen::Matrix3Xd::Zero(3, body.size());
    shape_products = Eigen::MatrixXd::Zero(body.size(), body.size());
    for (int k = 0; k < 3; ++k) {
      for (int l = 0; l < 3; ++l) {
        second(k, l) += mixed(3 * k + l) + mixed(3 * l + k);
        first_shape.row(k) += e(l) * body.mixed.row(3 * k + l);
      }
    }
    for (std::size_t pair = 0; pair < body.pairs.size(); ++pair) {
      const auto [k, l] = body.pairs[pair];
      const Eigen::MatrixXd moments = dense_matrix(body.pattern, body.moments.col(pair));
      const Eigen::RowVectorXd moved = q.transpose() * moments;
      second(k, l) += moved.dot(q);
      first_shape.row(k) += e(l) * moved;
      shape_products += e(k) * e(l) * moments;
    }
  }
};

/// Adds the share of a body.
void add_body(const BodyModel& body, const State& state, const Eigen::Vector3d& d,
              Eigen::MatrixXd& sum) {
  const BodyFrame& frame = body.frame;
  const int offset = frame.offset, size = frame.size(), n = body.elastic_size();
  const FrameMotion<double> motion = frame_motion(frame, state);
  const Eigen::Vector3d e = motion.A.transpose() * d;
  const IntegralsAlong integrals(body.invariants, state.q.segment(offset + size, n), e);
  const int moves = frame.translations(), turns = frame.rotations();
  // p × e = −ẽ p, and d·ṙ as a row of the coordinates of the frame.
  const Eigen::Matrix3d lever = -skew<double>(e);
  const Eigen::MatrixXd turn = motion.G.transpose() * lever;  // turns × 3
  const Eigen::VectorXd move = frame.basis.transpose() * d;
  auto block = sum.block(offset, offset, size + n, size + n);
  block.topLeftCorner(moves, moves) += body.invariants.mass * move * move.transpose();
  block.block(moves, 0, turns, moves) += turn * integrals.first * move.transpose();
  block.block(moves, moves, turns, turns) += turn * integrals.second * turn.transpose();
  block.block(size, 0, n, moves) += integrals.shape.transpose() * move.transpose();
  block.block(size, moves, n, turns) += (turn * integrals.first_shape).transpose();
  block.bottomRightCorner(n, n) += integrals.shape_products;
}

}  // namespace

Eigen::MatrixXd elastic_mass_along(const Invariants<double>& body, const Eigen::Vector3d& d) {
  Eigen::VectorXd entries = Eigen::VectorXd::Zero(body.pattern.nonzeros());
  for (std::size_t pair = 0; pair < body.pairs.size(); ++pair) {
    const auto [k, l] = body.pairs[pair];
    entries += d(k) * d(l) * body.moments.col(pair);
  }
  return dense_matrix(body.pattern, entries);
}

Eigen::MatrixXd mass_along(const Model& model, const State& state, const Eigen::Vector3d& d) {
  const Eigen::Index n = state.q.size();
  Eigen::MatrixXd lower = Eigen::MatrixXd::Zero(n, n);
  for (const BodyModel& body : model.bodies) add_body(body, state, d, lower);
  return lower.selfadjointView<Eigen::Lower>();
}

Eigen::MatrixXcd combinations_along(const Eigen::MatrixXcd& modes, const Eigen::MatrixXd& mass,
                                    const Eigen::MatrixXd& along) {
  const Eigen::MatrixXcd adjoint = modes.adjoint();
  const HermitianModes shares = hermitian_modes(adjoint * along * modes, adjoint * mass * modes);
  return shares.vectors.rightCols((shares.values.array() > most).count());
}

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

MotionAxes::Kind axes_of(const ModeChoice& choice) {
  const bool turns = choice.of == ModeNumber::growth_rate && !choice.axis;
  return turns ? MotionAxes::Kind::rotor : MotionAxes::Kind::standing;
}

LinearizedModes::LinearizedModes(const Model& of_model, const State& at, bool is_damped,
                                 MotionAxes::Kind kind)
    : model(of_model),
      state(at),
      axes(model.mechanism, state, kind),
      linearized(linearize(model.mechanism, state, axes.at(state), is_damped)),
      modes(modes_of(linearized)) {}

Eigen::MatrixXd LinearizedModes::mass_along(const std::array<double, 3>& d) const {
  const Eigen::MatrixXd T = axes.at(state).T;
  const Eigen::Map<const Eigen::Vector3d> direction(d.data());
  return T.transpose() * pleuel::mass_along(model, state, direction) * T;
}

namespace {

/// How many of the modes that coincide with one count, which is the first of them.
class ModeCount {
 public:
  ModeCount(const LinearizedModes& mechanism, const ModeChoice& choice, bool only_vibrations)
      : mechanism_(mechanism), choice_(choice), only_vibrations_(only_vibrations) {
    if (choice.axis) along_ = mechanism.mass_along(*choice.axis);
  }

  Eigen::Index operator()(int mode) const {
    const auto& [model, state, axes, linearized, modes] = mechanism_;
    if (only_vibrations_ && !vibrates(modes(mode))) return 0;
    if (!choice_.axis) return 1;
    if (coinciding(modes, mode).front() != mode) return 0;
    const Eigen::MatrixXcd vectors = modal_vectors(linearized, modes, mode).right;
    return combinations_along(vectors, linearized.M, along_).cols();
  }

 private:
  const LinearizedModes& mechanism_;
  const ModeChoice& choice_;
  bool only_vibrations_;
  Eigen::MatrixXd along_;
};

/// The number of modes that count, and the place of the one that is asked for.
struct SoughtMode {
  Eigen::Index counted = 0;
  std::optional<int> place = {};
};

SoughtMode look_for_mode(const LinearizedModes& mechanism, const ModeChoice& choice,
                         bool only_vibrations) {
  const ModeCount count(mechanism, choice, only_vibrations);
  const Eigen::VectorXcd& modes = mechanism.modes;
  const auto badness = [&](int mode) {
    const double number = number_of(choice.of, modes(mode));
    return choice.of == ModeNumber::damping_ratio ? -number : number;
  };
  SoughtMode found;
  for (int mode = 0; mode < int_size(modes); ++mode) {
    if (choice.number == ModeChoice::worst) {
      if (found.place && badness(mode) <= badness(*found.place)) continue;
      if (count(mode) > 0) found.place = mode;
      continue;
    }
    found.counted += count(mode);
    if (choice.number < found.counted) return {found.counted, mode};
  }
  return found;
}

}  // namespace

int find_mode(const LinearizedModes& mechanism, const ModeChoice& choice) {
  const bool is_ratio = choice.of == ModeNumber::damping_ratio;
  SoughtMode found = look_for_mode(mechanism, choice, is_ratio);
  if (!found.place && is_ratio && choice.number == ModeChoice::worst) {
    found = look_for_mode(mechanism, choice, false);  // damped so much that nothing vibrates
  }
  if (found.place) return *found.place;
  refuse_mode("the mechanism", found.counted, choice);
}

}  // namespace pleuel
