#include "core/linear/linearization.hpp"

#include <array>

#include "core/base/eager_matrices.hpp"
#include "core/base/rotation_vector.hpp"

namespace pleuel {

namespace {

constexpr int in_space = 3, in_plane = 2;  // translations of a frame

/// The coefficients while they are set, block by block.
struct Blocks {
  Eigen::MatrixXd T, V, P, Q;

  /// Those that change nothing.
  explicit Blocks(Eigen::Index n)
      : T(Eigen::MatrixXd::Identity(n, n)), V(Eigen::MatrixXd::Zero(n, n)), P(V), Q(V) {}

  Turning take() const { return {T.sparseView(), V.sparseView(), P.sparseView(), Q.sparseView()}; }
};

void set_translation(int first, int size, const BodyTurn& turn, Blocks& turning) {
  const Eigen::Matrix3d omega = skew(turn.omega), alpha = skew(turn.alpha);
  const auto set = [&](Eigen::MatrixXd& all, const Eigen::Matrix3d& block) {
    all.block(first, first, size, size) = block.topLeftCorner(size, size);
  };
  set(turning.T, turn.axes);
  set(turning.V, turn.axes * omega);
  set(turning.P, 2.0 * turn.axes * omega);
  set(turning.Q, turn.axes * (omega * omega + alpha));
}

void set_points(const Mechanism& mechanism, const BodyTurn& fastest, Blocks& turning) {
  const int size = translations_of_points(mechanism);
  for (const int point : mechanism.points) set_translation(point, size, fastest, turning);
}

void set_rotation(int first, const BodyTurn& turn, Blocks& turning) {
  const Eigen::Matrix3d omega = skew(turn.omega);
  turning.V.block<3, 3>(first, first) = omega;
  turning.P.block<3, 3>(first, first) = omega;
  turning.Q.block<3, 3>(first, first) = skew(turn.alpha);
}

/// The same in the axes R of the rotor, which turn with W and Ẇ (global): with δψ = B y, B = Aᵀ R,
/// w = Aᵀ W and dB/dt = (w − ω)~ B
///     δω = B ẏ + w̃ B y,   δα = B ÿ + (2w − ω)~ B ẏ + ((Aᵀ Ẇ − ω × w)~ + w̃ (w − ω)~) B y
void set_rotation(int first, const BodyTurn& own, const BodyTurn& rotor, Blocks& turning) {
  const Eigen::Matrix3d B = own.axes.transpose() * rotor.axes;
  const Eigen::Vector3d w = B * rotor.omega;
  const Eigen::Vector3d change = B * rotor.alpha - own.omega.cross(w);
  turning.T.block<3, 3>(first, first) = B;
  turning.V.block<3, 3>(first, first) = skew(w) * B;
  turning.P.block<3, 3>(first, first) = skew<double>(2.0 * w - own.omega) * B;
  turning.Q.block<3, 3>(first, first) = (skew(change) + skew(w) * skew<double>(w - own.omega)) * B;
}

}  // namespace

std::vector<TurningBody> turning_bodies(const Mechanism& mechanism, const State& state) {
  std::vector<TurningBody> bodies;
  for (const int rotation : mechanism.rotations) {
    const BodyTurn turn{rotation_of(state.q.segment<3>(rotation)), state.v.segment<3>(rotation),
                        state.a.segment<3>(rotation)};
    bodies.push_back({rotation - in_space, rotation, rotation + 3, turn});
  }
  for (const int angle : mechanism.angles) {
    const Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
    const BodyTurn turn{rotation_of(state.q(angle) * normal), state.v(angle) * normal,
                        state.a(angle) * normal};
    bodies.push_back({angle - in_plane, angle, angle + 1, turn});
  }
  return bodies;
}

int translations_of_points(const Mechanism& mechanism) {
  return mechanism.angles.empty() ? in_space : in_plane;
}

BodyTurn fastest_turn(const Mechanism& mechanism, const State& state) {
  BodyTurn fastest;
  for (const TurningBody& body : turning_bodies(mechanism, state)) {
    if (body.turn.omega.norm() > fastest.omega.norm()) fastest = body.turn;
  }
  return fastest;
}

Turning standing_axes(const Mechanism& mechanism, const State& state) {
  Blocks standing(state.q.size());
  for (const int first : mechanism.rotations) {
    standing.P.block<3, 3>(first, first) = -skew<double>(state.v.segment<3>(first));
  }
  return standing.take();
}

Turning turning_of(const Mechanism& mechanism, const State& state) {
  Blocks turning(state.q.size());
  for (const TurningBody& body : turning_bodies(mechanism, state)) {
    const int translations = body.rotation - body.first;
    set_translation(body.first, translations, body.turn, turning);
    if (translations == in_space) set_rotation(body.rotation, body.turn, turning);
  }
  set_points(mechanism, fastest_turn(mechanism, state), turning);
  return turning.take();
}

Turning rotor_turning(const Mechanism& mechanism, const State& state) {
  return rotor_turning(mechanism, state, fastest_turn(mechanism, state));
}

Turning rotor_turning(const Mechanism& mechanism, const State& state, const BodyTurn& rotor) {
  Blocks turning(state.q.size());
  for (const TurningBody& body : turning_bodies(mechanism, state)) {
    const int translations = body.rotation - body.first;
    set_translation(body.first, translations, rotor, turning);
    if (translations == in_space) set_rotation(body.rotation, body.turn, rotor, turning);
  }
  set_points(mechanism, rotor, turning);
  return turning.take();
}

Linearization linearize(const Mechanism& mechanism, const State& state, const Turning& axes,
                        bool is_damped) {
  System& system = *mechanism.system;
  const int n = system.coordinates(), m = system.multipliers();
  constexpr std::array<Weights, 3> weights{{{.q = 1.0}, {.v = 1.0}, {.a = 1.0}}};
  std::vector<System::Matrix> matrices(weights.size(), system.make_matrix());
  Eigen::VectorXd residual;
  system.linearize(state, weights, ConstraintLevel::position, residual, matrices);
  const auto& [T, V, P, Q] = axes;
  using Sparse = Eigen::SparseMatrix<double>;
  const Sparse of_q = matrices[0].topLeftCorner(n, n), of_v = matrices[1].topLeftCorner(n, n),
               of_a = matrices[2].topLeftCorner(n, n), phi = matrices[0].bottomLeftCorner(m, n);
  const Sparse left = T.transpose();
  const Sparse rates = left * Sparse(of_a * P) + left * Sparse(of_v * T);
  const Sparse skew = Sparse(rates.transpose());
  Linearization found;
  found.is_damped = is_damped;
  found.M = Sparse(left * Sparse(of_a * T));
  found.G = is_damped ? rates : Sparse(0.5 * (rates - skew));
  found.K = Sparse(left * Sparse(of_a * Q) + left * Sparse(of_v * V) + left * Sparse(of_q * T));
  found.phi = Sparse(phi * T);
  found.left_out = system.left_out();
  return found;
}

Linearization linearize(const Mechanism& mechanism, const State& state, bool is_damped) {
  return linearize(mechanism, state, standing_axes(mechanism, state), is_damped);
}

}  // namespace pleuel
