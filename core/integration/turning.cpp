#include "core/integration/turning.hpp"

#include "core/base/rotation_vector.hpp"
#include "core/base/skew.hpp"

namespace pleuel {

namespace {

FastestTurn turn_of(const State& state, int rotation) {
  return {rotation_of(state.q.segment<3>(rotation)), state.v.segment<3>(rotation),
          state.a.segment<3>(rotation)};
}

void set_translation(int first, const FastestTurn& turn, Turning& turning) {
  const Eigen::Matrix3d omega = skew(turn.omega), alpha = skew(turn.alpha);
  turning.T.block<3, 3>(first, first) = turn.axes;
  turning.V.block<3, 3>(first, first) = turn.axes * omega;
  turning.P.block<3, 3>(first, first) = 2.0 * turn.axes * omega;
  turning.Q.block<3, 3>(first, first) = turn.axes * (omega * omega + alpha);
}

void set_rotation(int first, const FastestTurn& turn, Turning& turning) {
  const Eigen::Matrix3d omega = skew(turn.omega);
  turning.V.block<3, 3>(first, first) = omega;
  turning.P.block<3, 3>(first, first) = omega;
  turning.Q.block<3, 3>(first, first) = skew(turn.alpha);
}

/// The same of translations and rotations alike in the axes R of the rotor, which turn with W and Ẇ
/// (global): with δψ = B y, B = Aᵀ R, w = Aᵀ W and dB/dt = (w − ω)~ B
///     δω = B ẏ + w̃ B y,   δα = B ÿ + (2w − ω)~ B ẏ + ((Aᵀ Ẇ − ω × w)~ + w̃ (w − ω)~) B y
void set_rotor(int first, const FastestTurn& own, const FastestTurn& rotor, Turning& turning) {
  set_translation(first, rotor, turning);
  const Eigen::Matrix3d B = own.axes.transpose() * rotor.axes;
  const Eigen::Vector3d w = B * rotor.omega;
  const Eigen::Vector3d change = B * rotor.alpha - own.omega.cross(w);
  const int rotation = first + 3;
  turning.T.block<3, 3>(rotation, rotation) = B;
  turning.V.block<3, 3>(rotation, rotation) = skew(w) * B;
  turning.P.block<3, 3>(rotation, rotation) = skew<double>(2.0 * w - own.omega) * B;
  turning.Q.block<3, 3>(rotation, rotation) =
      (skew(change) + skew(w) * skew<double>(w - own.omega)) * B;
}

}  // namespace

FastestTurn fastest_turn(const Mechanism& mechanism, const State& state) {
  FastestTurn fastest;
  for (const int rotation : mechanism.rotations) {
    const FastestTurn turn = turn_of(state, rotation);
    if (turn.omega.norm() > fastest.omega.norm()) fastest = turn;
  }
  return fastest;
}

Turning turning_of(const Mechanism& mechanism, const State& state) {
  const Eigen::Index n = state.q.size();
  Turning turning{Eigen::MatrixXd::Identity(n, n), Eigen::MatrixXd::Zero(n, n),
                  Eigen::MatrixXd::Zero(n, n), Eigen::MatrixXd::Zero(n, n)};
  for (const int rotation : mechanism.rotations) {
    const FastestTurn turn = turn_of(state, rotation);
    set_translation(rotation - 3, turn, turning);
    set_rotation(rotation, turn, turning);
  }
  const FastestTurn fastest = fastest_turn(mechanism, state);
  for (const int point : mechanism.points) set_translation(point, fastest, turning);
  return turning;
}

Turning rotor_turning(const Mechanism& mechanism, const State& state) {
  const Eigen::Index n = state.q.size();
  Turning turning{Eigen::MatrixXd::Identity(n, n), Eigen::MatrixXd::Zero(n, n),
                  Eigen::MatrixXd::Zero(n, n), Eigen::MatrixXd::Zero(n, n)};
  const FastestTurn rotor = fastest_turn(mechanism, state);
  for (const int rotation : mechanism.rotations) {
    set_rotor(rotation - 3, turn_of(state, rotation), rotor, turning);
  }
  for (const int point : mechanism.points) set_translation(point, rotor, turning);
  return turning;
}

}  // namespace pleuel
