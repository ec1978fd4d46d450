#include "picture/rigid_motion.hpp"

#include <utility>

#include "core/base/error.hpp"
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

Motion rigid_motion(const ProblemFile& problem, const Eigen::VectorXd& x) {
  const Eigen::VectorXd start = start_design(problem);
  try {
    const Model model = build_model(problem.scene, problem.effects, {start.begin(), start.end()},
                                    {x.begin(), x.end()}, problem.sensitivity.invariants);
    RigidMotion rigid =
        rigid_motion(problem.scene, model, problem.simulation.end_time, problem.simulation.step);
    return rigid.motion.time.size() > 1 ? std::move(rigid.motion) : Motion();
  } catch (const SimulationError&) {
    return {};
  }
}

}  // namespace pleuel
