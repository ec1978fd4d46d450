#pragma once

#include <map>
#include <string>

#include "core/scene/beam_mesh.hpp"

namespace pleuel {

/// "(0.12, 0, 0)"
std::string describe(const Eigen::Vector3d& place);

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

/// A point that is not where its body has it.
struct Misplaced {
  std::string rule;  ///< "must …, which is … [m]"
  Eigen::Vector3d at;
};

/// Where joints, loads and initial deflections may lie on an elastic beam. A node of its mesh follows
/// a place that moves along the beam (core/scene/beam_mesh.hpp), as long as the order of the places
/// stays what it is at the start; all others keep their share of the length, and may not start where
/// one that moves does, or right beside it.
class BeamPlaces {
 public:
  /// @param body, scene  must outlive this
  /// @param start        at which the mesh is made
  BeamPlaces(const Body& body, const Scene& scene, const Design<double>& start);

  /// What is wrong with a place at a design: "must …, which is … [m]"; none if nothing is.
  /// @param looks_at_axis  otherwise the order of places is looked at, and those that the mesh would
  ///                       take along, but not whether they stay on the axis of the beam
  std::optional<std::string> find_misplaced(const Point& at, const Design<double>& design,
                                            bool looks_at_axis) const;

 private:
  /// The share of the length where the model has at a design what is at a share at the start.
  double modelled_share(double at_start, const Design<double>& design) const;

  /// The same of the order of places alone.
  std::optional<std::string> find_disorder(const Point& at, const Design<double>& design) const;

  /// A node that places must not pass.
  std::string describe(int node) const;

  const Body& body_;
  const Scene& scene_;
  const BeamBody& beam_;
  const Design<double> start_;
  BeamMesh mesh_;
};

/// Where points may lie on all bodies: on the axis of an elastic beam, at the same share of its length
/// in all designs or with its nodes; where a point mass is; at a place of an imported body; anywhere in
/// the space of a rigid body and of the ground.
class PlacesOnBodies {
 public:
  /// @param scene, start  must outlive this
  PlacesOnBodies(const Scene& scene, const Design<double>& start) : scene_(scene), start_(start) {}

  /// @param is_known_at_bounds  that points are on the axes of beams at the bounds of all variables, and
  ///                            so between those of plain ones
  std::optional<Misplaced> find_misplaced(const PlacedPoint& placed, const Design<double>& design,
                                          bool is_known_at_bounds);

 private:
  const BeamPlaces& of_beam(const Body& body) {
    return beams_.try_emplace(body.name, body, scene_, start_).first->second;
  }

  std::optional<Misplaced> find_off_beam(const PlacedPoint& placed, const BeamBody& beam,
                                         const Design<double>& design, bool is_known_at_bounds);
  std::optional<Misplaced> find_off_mass(const PlacedPoint& placed, const PointMass& mass,
                                         const Design<double>& design) const;
  std::optional<Misplaced> find_off_place(const PlacedPoint& placed, const ImportedBody& imported,
                                          const Design<double>& design) const;

  const Scene& scene_;
  const Design<double>& start_;
  std::map<std::string, BeamPlaces> beams_;  ///< as they are asked for
};

}  // namespace pleuel
