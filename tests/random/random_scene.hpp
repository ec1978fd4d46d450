#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "core/scene/problem_file.hpp"

/// Random mechanisms as problem files, the same for the same seed on every machine.
namespace pleuel::test {

using Json = nlohmann::ordered_json;

/// A four-bar, a slider-crank in the plane or in space, or a chain of 2 to 6 links, which one the
/// seed decides, with random sections, frames, reductions, formulations, stiffness (four decades),
/// speeds (up to 0.8 of the first resonance of the slowest member) and loads. Numbers in SI units.
Json random_scene(unsigned seed);

/// Whether all of it moves in a plane.
bool is_planar(const Json& scene);

/// The whole mechanism, with gravity and loads, turned.
Json rotated(const Json& scene, const Eigen::Matrix3d& rotation);

/// Other names of bodies, joints, materials, loads and variables.
Json renamed(const Json& scene);

/// Lengths in mm, moduli in MPa, forces in kN, times in ms …
Json in_other_units(const Json& scene);

/// All six coordinates of a frame.
Json in_space(const Json& scene);

/// A rotation about an axis that is none of the axes.
Eigen::Matrix3d general_rotation(unsigned seed);

ProblemFile read(const Json& scene);

}  // namespace pleuel::test
