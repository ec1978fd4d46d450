#pragma once

#include <optional>
#include <string>

#include "core/scene/beam_mesh.hpp"

namespace pleuel {

/// Where joints, loads and initial deflections may lie on an elastic beam. A node of its mesh follows
/// a place that moves along the beam (core/scene/beam_mesh.hpp), as long as the order of the places
/// stays what it is at the start; all others keep their share of the length.
class BeamPlaces {
 public:
  /// @param body, scene  must outlive this
  /// @param start        at which the mesh is made
  BeamPlaces(const Body& body, const Scene& scene, const Design<double>& start);

  /// What is wrong with a place at a design: "must …, which is … [m]"; none if nothing is.
  std::optional<std::string> find_misplaced(const Point& at, const Design<double>& design) const;

  /// The same of the order of places alone.
  std::optional<std::string> find_disorder(const Point& at, const Design<double>& design) const;

  /// Whether a change of a variable would make it another place of the body than the mesh follows,
  /// to first order.
  bool leaves(const Point& at, std::size_t variable, double change) const;

 private:
  /// Which place a node follows where this place is; null: it keeps its share.
  const Point* followed_at(double share) const;
  std::optional<std::string> find_moved(double share, const Eigen::Vector3d& there,
                                        const Design<double>& design, const char* why) const;

  const Body& body_;
  const BeamBody& beam_;
  const Design<double> start_;
  BeamMesh mesh_;
};

}  // namespace pleuel
