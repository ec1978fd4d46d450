#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/scene/problem_file.hpp"
#include "core/scene/scene.hpp"

namespace pleuel {

/// A design for which the scene must make sense.
struct SampleDesign {
  Design<double> design;
  std::string where;  ///< end of a message: empty for the start design
};

/// The start design, then with each variable at either bound.
std::vector<SampleDesign> sample_designs(const std::vector<DesignVariable>& variables);

/// A point of a joint, a load or an initial deflection that belongs to a body.
struct PlacedPoint {
  std::vector<std::string> path;  ///< in the scene: {"loads", "tip", "at"}; of lists the index
  const Point* point;
  const Body* body;  ///< null: the ground, which is everywhere

  /// "/scene/loads/tip/at"
  std::string pointer() const;
};

/// Of all joints, loads and initial deflections; they refer to the scene.
std::vector<PlacedPoint> placed_points(const Scene& scene);

/// Whether a place is at the share of the length of a beam, up to the rounding of written numbers.
bool is_on_beam(const BeamBody& beam, double share, const Eigen::Vector3d& at,
                const Design<double>& design);

/// What is wrong with a point of an imported body at a design: "must …, got …"; none if it is where
/// the place of the file is that is nearest at the start.
std::optional<std::string> find_off_place(const Body& body, const Point& at,
                                          const Design<double>& start,
                                          const Design<double>& design);

/// Whether a place is that of a point mass, likewise.
bool is_on_mass(const PointMass& mass, const Eigen::Vector3d& at, const Scene& scene,
                const Design<double>& design);

}  // namespace pleuel
