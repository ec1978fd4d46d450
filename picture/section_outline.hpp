#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/scene/scene.hpp"
#include "picture/motion.hpp"

namespace pleuel {

/// The outline of a section, anticlockwise seen against local x: points (y, z) [m].
struct SectionOutline {
  std::vector<Eigen::Vector2d> outer;
  std::vector<Eigen::Vector2d> inner;  ///< of a hole; empty without one
  bool is_exact = true;                ///< false: of a section that is known by its properties only
};

/// Of a general section: the rectangle with its radii of gyration.
SectionOutline section_outline(const Section& section, const Design<double>& design);

/// The surface of a body at an instant.
struct SweptSurface {
  Eigen::Matrix3Xd points;              ///< global [m]
  Eigen::VectorXd stress;               ///< at the points [Pa]; empty where there is none
  std::vector<std::vector<int>> faces;  ///< polygons of points, anticlockwise seen from outside
};

/// The outlines of a beam's sections along its deformed axis, with their holes and end faces, one
/// closed surface a segment. Sections stand normal to the axis, turned as the body frame is;
/// between stations positions and stresses are interpolated.
/// @param motion   of the beam
/// @param instant  a column of it
SweptSurface swept_beam(const BeamBody& beam, const Design<double>& design, const BodyTrack& motion,
                        Eigen::Index instant);

}  // namespace pleuel
