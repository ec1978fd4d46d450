#include "picture/rigid_motion.hpp"

#include "core/mobility/lock.hpp"

namespace pleuel {

RigidMotion rigid_motion(const Scene& scene, const Model& model, double end, double step) {
  std::vector<double> time;
  std::vector<Eigen::VectorXd> positions;
  const auto see = [&](double now, const Eigen::VectorXd& q) {
    time.push_back(now);
    positions.push_back(q);
  };
  RigidMotion rigid{follow_drives(model, end, step, see), {}};
  if (positions.empty()) see(0.0, model.mechanism.guess.q);
  const Eigen::VectorXd instants = Eigen::Map<Eigen::VectorXd>(time.data(), std::ssize(time));
  rigid.motion = sample_motion(scene, model, instants,
                               [&](Eigen::Index i, State& state) { state.q = positions[i]; });
  for (BodyTrack& body : rigid.motion.bodies) body.stress.resize(0, 0);
  return rigid;
}

}  // namespace pleuel
