#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/scene/scene.hpp"

namespace pleuel {

/// The outline of a section, anticlockwise seen against local x: points (y, z) [m].
struct SectionOutline {
  std::vector<Eigen::Vector2d> outer;
  std::vector<Eigen::Vector2d> inner;  ///< of a hole; empty without one
  bool is_exact = true;                ///< false: of a section that is known by its properties only
};

/// Of a general section: the rectangle with its radii of gyration.
SectionOutline section_outline(const Section& section, const Design<double>& design);

}  // namespace pleuel
