#include "core/response/motion_along.hpp"

#include "core/base/dense_solvers.hpp"
#include "core/base/eager_matrices.hpp"
#include "core/base/rotation_vector.hpp"
#include "core/beam/elastic_basis.hpp"

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
  const auto motion =
      frame_motion<double>(frame, state.q.segment(offset, size), state.v.segment(offset, size),
                           state.a.segment(offset, size));
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

}  // namespace pleuel
