#pragma once

#include <memory>
#include <string>

#include "core/response/analysis.hpp"
#include "tests/random/random_scene.hpp"

namespace pleuel::test {

/// A random scene that runs.
struct SimulatedScene {
  RandomMechanism mechanism;
  ProblemFile problem;
  std::unique_ptr<Analysis> analysis;  ///< null: it does not run, however slow
  std::string failure;                 ///< why not
};

/// The same slower, where members bend beyond what linear elasticity is good for or the simulation
/// fails: what is called unstable elsewhere may be chaotic there, and has no values to compare.
/// With smaller steps where some were split, which neighbouring designs may not need: values jump
/// there.
SimulatedScene simulated(RandomMechanism mechanism);

/// Of random_scene().
SimulatedScene simulated_scene(unsigned seed);

/// max |history| of each response; of constants their magnitude.
Eigen::VectorXd magnitudes_of(const Analysis& analysis);

/// Values at the start design.
Eigen::VectorXd start_values(const Json& scene);

}  // namespace pleuel::test
