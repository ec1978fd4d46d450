#pragma once

#include <string>
#include <vector>

#include "core/model/model.hpp"

/// Small mechanisms that together contain every kind of body, section, joint and drive, with all
/// kinds of numbers bound to variables.
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
};

/// Slider-crank in the x–y plane with a driven flexible crank, a two-segment rod, a slider in a
/// guide; beside it a block on an inclined prismatic guide that carries a beam. Gravity in the
/// plane.
SampleScene planar_sample();

/// The same mechanism, moved without its planarity: forced into space.
SampleScene planar_sample_in_space();

/// An open spatial chain with every type of joint between every type of body.
SampleScene spatial_sample();

std::vector<SampleScene> all_samples();

/// A beam of steel from the origin along x, turning about z on a bearing in the origin; gravity
/// along −y. No variables.
pleuel::Scene swinging_beam(double length, const pleuel::Section& section, int elements);
