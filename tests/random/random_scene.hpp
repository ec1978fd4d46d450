#pragma once

#include <memory>
#include <string>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "core/response/analysis.hpp"
#include "core/scene/problem_file.hpp"

/// Random mechanisms as problem files, the same for the same seed on every machine.

namespace pleuel::test {

using Json = nlohmann::ordered_json;

struct RandomMechanism {
  Json file;
  std::string kind;  ///< four-bar, slider-crank, spatial slider-crank, chain
  bool is_spatial = false;
  /// Speed of the drive over the lowest angular frequency of a member between hinges; zero: none.
  double resonance_share = 0.0;
  double weight = 0.0;  ///< acceleration of gravity under which its members hardly sag [m/s²]
};

/// A four-bar, a slider-crank in the plane or in space, or a chain of 2 to 6 links, which one the
/// seed decides, with random sections, frames, reductions, formulations, stiffness (four decades),
/// speeds (up to 0.8 of the first resonance of the slowest member) and loads. Numbers in SI units.
RandomMechanism random_scene(unsigned seed);

/// The same rigid motion in 1/factor of the time, with forces that are factor² as large: all
/// deformation is about factor² as large.
RandomMechanism slowed(RandomMechanism scene, double factor);

/// Whether all of it moves in a plane.
bool is_planar(const Json& scene);

/// The whole mechanism, with gravity and loads, turned.
Json rotated(const Json& scene, const Eigen::Matrix3d& rotation);

/// Twice as many steps.
RandomMechanism with_half_the_step(RandomMechanism scene);

/// The same with what makes it ring: loads that jump, at the start or later, gravity that acts on
/// an undeformed start or one that has settled, and members that are damped so much that they
/// creep.
RandomMechanism suddenly_loaded(RandomMechanism scene, unsigned seed);

/// Every number of the geometry, the materials and the forces changed by ± a share of itself, the
/// sign as a seed decides: what it does to answers is what round-off does to them, if the share is
/// that of round-off.
Json nudged(const Json& scene, unsigned seed, double share);

/// Other names of bodies, joints, materials, loads and variables.
Json renamed(const Json& scene);

/// Lengths in mm, moduli in MPa, forces in kN, times in ms …
Json in_other_units(const Json& scene);

/// All six coordinates of a frame.
Json in_space(const Json& scene);

/// A rotation about an axis that is none of the axes.
Eigen::Matrix3d general_rotation(unsigned seed);

/// In any thread.
ProblemFile read(const Json& scene);

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

/// The seeds of the random scenes of this executable: [first_seed, end_seed).
extern const unsigned first_seed, end_seed;
/// So many of the seeds have to run, with margin for other compilers.
extern const int least_scenes;

}  // namespace pleuel::test
