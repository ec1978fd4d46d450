#include "core/trust/turning_axes.hpp"

#include <array>

#include "core/response/mechanism_modes.hpp"

namespace pleuel {

namespace {

/// How rates and accelerations of coordinates follow from y, ẏ and ÿ:
///     δq = T y,  δv = T ẏ + V y,  δa = T ÿ + P ẏ + Q y
struct Turning {
  Eigen::MatrixXd T, V, P, Q;
};

FrameMotion<double> motion_of(const BodyFrame& frame, const State& state) {
  const auto of = [&](const Eigen::VectorXd& all) {
    return Coordinates<double>(all.segment(frame.offset, frame.size()));
  };
  return frame_motion<double>(frame, of(state.q), of(state.v), of(state.a));
}

Turning turning_of(const Model& model, const State& state) {
  const Eigen::Index n = state.q.size();
  Turning turning{Eigen::MatrixXd::Identity(n, n), Eigen::MatrixXd::Zero(n, n),
                  Eigen::MatrixXd::Zero(n, n), Eigen::MatrixXd::Zero(n, n)};
  FrameMotion<double> fastest;
  fastest.A.setIdentity();
  fastest.omega.setZero();
  fastest.alpha.setZero();
  for (const BodyModel& body : model.bodies) {
    if (body.frame.rotations() != 3) continue;
    const FrameMotion<double> motion = motion_of(body.frame, state);
    if (motion.omega.norm() > fastest.omega.norm()) fastest = motion;
  }
  for (const BodyModel& body : model.bodies) {
    const BodyFrame& frame = body.frame;
    if (frame.translations() != 3) continue;
    const bool turns = frame.rotations() == 3;
    const FrameMotion<double> motion = turns ? motion_of(frame, state) : fastest;
    const Eigen::Matrix3d omega = skew<double>(motion.omega), alpha = skew<double>(motion.alpha);
    const Eigen::Matrix3d axes = frame.basis.transpose() * motion.A;
    const int r = frame.offset;
    turning.T.block<3, 3>(r, r) = axes;
    turning.V.block<3, 3>(r, r) = axes * omega;
    turning.P.block<3, 3>(r, r) = 2.0 * axes * omega;
    turning.Q.block<3, 3>(r, r) = axes * (omega * omega + alpha);
    if (!turns) continue;
    const int p = r + 3;
    turning.V.block<3, 3>(p, p) = omega;
    turning.P.block<3, 3>(p, p) = omega;
    turning.Q.block<3, 3>(p, p) = alpha;
  }
  return turning;
}

}  // namespace

Eigen::VectorXd frequencies_in_turning_axes(const Model& model, const State& state) {
  System& system = *model.mechanism.system;
  const int n = system.coordinates(), m = system.multipliers();
  constexpr std::array<Weights, 3> weights{{{.q = 1.0}, {.v = 1.0}, {.a = 1.0}}};
  std::vector<System::Matrix> matrices(weights.size(), system.make_matrix());
  Eigen::VectorXd residual;
  system.linearize(state, weights, ConstraintLevel::position, residual, matrices);
  const auto motion_rows = [&](std::size_t i) {
    return Eigen::MatrixXd(Eigen::MatrixXd(matrices[i]).topLeftCorner(n, n));
  };
  const Eigen::MatrixXd of_q = motion_rows(0), of_v = motion_rows(1), of_a = motion_rows(2);
  const auto [T, V, P, Q] = turning_of(model, state);
  const Eigen::MatrixXd rates = T.transpose() * (of_a * P + of_v * T);
  FrozenMechanism frozen;
  frozen.M = T.transpose() * of_a * T;
  frozen.G = 0.5 * (rates - rates.transpose());
  frozen.K = T.transpose() * (of_a * Q + of_v * V + of_q * T);
  frozen.phi = Eigen::MatrixXd(matrices[0]).bottomLeftCorner(m, n) * T;
  frozen.left_out = system.left_out();
  const Eigen::VectorXcd modes = modes_of(frozen);
  Eigen::VectorXd frequencies(modes.size());
  for (Eigen::Index i = 0; i < modes.size(); ++i) frequencies(i) = frequency_of(modes(i));
  return frequencies;
}

}  // namespace pleuel
