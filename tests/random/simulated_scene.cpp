#include "tests/random/simulated_scene.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/response/monitors.hpp"

namespace pleuel::test {

namespace {

constexpr int most_attempts = 6;
constexpr double largest_rotation = 0.2, aimed_rotation = 0.15;  ///< [rad]
constexpr double slow = 0.4;

}  // namespace

SimulatedScene simulated_scene(unsigned seed) {
  return simulated(random_scene(seed));
}

SimulatedScene simulated(RandomMechanism mechanism) {
  SimulatedScene scene;
  scene.mechanism = std::move(mechanism);
  for (int attempt = 0; attempt < most_attempts; ++attempt) {
    scene.problem = read(scene.mechanism.file);
    try {
      scene.analysis = analyze(scene.problem, start_design(scene.problem));
    } catch (const SimulationError& error) {
      scene.failure = error.what();
      scene.mechanism = with_half_the_step(slowed(scene.mechanism, slow));
      continue;
    }
    const Trajectory& trajectory = scene.analysis->trajectory;
    const double rotation = monitor(scene.analysis->model, trajectory).elastic_rotation;
    if (rotation > largest_rotation) {
      scene.failure = "bends too far";
      const double factor = std::max(slow, std::sqrt(aimed_rotation / rotation));
      scene.mechanism = slowed(scene.mechanism, factor);
    } else if (trajectory.split_steps > 0) {
      scene.failure = "needs other steps";
      scene.mechanism = with_half_the_step(scene.mechanism);
    } else {
      return scene;
    }
  }
  scene.analysis.reset();
  return scene;
}

Eigen::VectorXd magnitudes_of(const Analysis& analysis) {
  Eigen::VectorXd magnitudes = values_of(analysis).cwiseAbs();
  for (std::size_t i = 0; i < analysis.histories.size(); ++i) {
    const Eigen::MatrixXd& history = analysis.histories[i];
    if (history.size() == 0) continue;
    magnitudes(i) = history.cwiseAbs().maxCoeff();
  }
  return magnitudes;
}

Eigen::VectorXd start_values(const Json& scene) {
  const ProblemFile problem = read(scene);
  return values_of(*analyze(problem, start_design(problem)));
}

}  // namespace pleuel::test
