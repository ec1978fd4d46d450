#include "core/trust/load_factor.hpp"

#include "core/base/eager_matrices.hpp"
#include "core/linear/elastic_stability.hpp"
#include "core/trust/stability.hpp"

namespace pleuel {

namespace {

/// The model without weight and loads.
Model unloaded_model(const ProblemFile& problem, const Eigen::VectorXd& x,
                     EffectChoice spatial_motion) {
  Scene scene = problem.scene;
  scene.gravity = {0.0, 0.0, 0.0};
  scene.loads.clear();
  EffectSettings effects = problem.effects;
  effects.spatial_motion = spatial_motion;
  const Eigen::VectorXd start = start_design(problem);
  return build_model(scene, effects, {start.begin(), start.end()}, {x.begin(), x.end()});
}

}  // namespace

LoadFactor::LoadFactor(const ProblemFile& problem, const Eigen::VectorXd& x,
                       const Analysis& analysis)
    : analysis_(analysis) {
  const Mechanism& mechanism = analysis.model.mechanism;
  const int coordinates = mechanism.system->coordinates(),
            multipliers = mechanism.system->multipliers();
  if (!mechanism.springs.empty() || coordinates > most_judged_coordinates) return;
  // What moves in space because of its loads may move in a plane without.
  for (const EffectChoice choice : {problem.effects.spatial_motion, EffectChoice::on}) {
    Model model = unloaded_model(problem, x, choice);
    const System& system = *model.mechanism.system;
    if (system.coordinates() != coordinates || system.multipliers() != multipliers) continue;
    free_ = std::move(model);
    return;
  }
}

double LoadFactor::at(int instant) const {
  const Mechanism& mechanism = analysis_.model.mechanism;
  State loaded;
  analysis_.trajectory.states->load(instant, loaded);
  const State unloaded = without_forces(mechanism, loaded);
  return buckling_load_factor({free_->mechanism, unloaded}, {mechanism, loaded}, 1.0);
}

}  // namespace pleuel
