#pragma once

#include "core/scene/problem_file.hpp"

namespace pleuel {

/// A scene in which each frame of a divided beam is a body of its own.
struct DividedScene {
  Scene scene;
  int divisions = 0;  ///< the first so many joints weld the frames of a beam to each other
};

/// Deformation is linear in a body frame only, so a beam that bends far is divided: each frame
/// carries one stretch of it, and a fixed joint at the node between two stretches makes both ends
/// one. Rotations against a frame are a share of those of the whole beam, and the error of linear
/// elasticity falls as the square of the number of frames.
///
/// Stretches end at the nodes of the beam's elements that are nearest to equal shares of its
/// length; where there are too few elements, each is divided. Joints and loads go to the stretch
/// that they lie on. Beams without elasticity stay in one piece.
/// @param start  at which places along the beams are looked at
DividedScene divide_beams(const Scene& scene, const EffectSettings& effects,
                          const Design<double>& start);

/// The same scene with one frame a beam.
Scene without_divisions(Scene scene);

/// What the user calls a body: the name of the whole beam for a part of one.
const std::string& name_in_scene(const Body& body);

}  // namespace pleuel
