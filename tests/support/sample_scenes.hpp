#pragma once

#include <string>
#include <vector>

#include "core/model/model.hpp"
#include "core/scene/problem_file.hpp"
#include "tests/support/test.hpp"

/// Small mechanisms that together contain every kind of body, joint, drive and load, with all kinds
/// of numbers bound to variables.
struct SampleScene {
  std::string name;
  pleuel::Scene scene;
  pleuel::EffectSettings effects;
  pleuel::Design<double> design;
  std::vector<std::string> variables;  ///< names, in the order of the design

  pleuel::Model build() const { return build_at(design); }
  pleuel::Model build_at(const pleuel::Design<double>& x) const {
    return pleuel::build_model(scene, effects, design, x);
  }

  /// Scene, effects and variables.
  pleuel::ProblemFile problem() const {
    pleuel::ProblemFile problem;
    problem.scene = scene;
    problem.effects = effects;
    for (std::size_t i = 0; i < design.size(); ++i) {
      problem.variables.push_back({variables[i], design[i], 0.0, 0.0, ""});
    }
    return problem;
  }
};

/// Slider-crank in the x–y plane with a driven flexible crank, a two-segment rod, a slider in a
/// guide; beside it a block on an inclined prismatic guide that carries a beam. Gravity in the
/// plane.
SampleScene planar_sample();

/// Its driven slider-crank alone, one element a segment, without gravity: at rest at first and soft
/// enough for steps in the asymptotic range.
SampleScene smooth_planar_sample();

/// The same mechanism, moved without its planarity: forced into space.
SampleScene planar_sample_in_space();

/// An open spatial chain with every type of joint between every type of body.
SampleScene spatial_sample();

/// An open chain and loose bodies in space: spherical, universal, cylindrical, planar and distance
/// joints, drives of every function of time, loads and force elements of every kind, joints and
/// loads between nodes, initial velocities.
SampleScene spatial_joints_sample();

/// What these joints, drives and loads become in a plane: axes normal to it and in it, along and
/// against its normal.
SampleScene planar_joints_sample();

/// Beams with Craig–Bampton modes (tangent and mean-axis frame, modal damping), a mean axis without
/// modes, a frame at the far end, and a rigid beam. In the plane, and forced into space, where the
/// round ones have pairs of equal frequencies.
SampleScene reduced_sample();
SampleScene reduced_sample_in_space();

/// Those in space of the planar and in the plane of the reduced sample with beams that shear bends,
/// too, one of them of a general section with shear areas of its own.
SampleScene sheared_sample_in_space();
SampleScene sheared_reduced_sample();

/// Made once: every test of a suite is named after one.
const std::vector<SampleScene>& all_samples();
/// How many there are, for instantiating test suites.
inline constexpr int sample_count = 9;

/// A beam of steel from the origin along x, turning about z on a bearing in the origin; gravity
/// along −y. No variables.
pleuel::Scene swinging_beam(double length, const pleuel::Section& section, int elements);

/// The name of a test whose parameter is the place of its sample among all_samples().
inline std::string sample_name(const testing::TestParamInfo<int>& info) {
  return all_samples()[info.param].name;
}
