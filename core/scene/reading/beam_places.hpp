#pragma once

#include <map>
#include <optional>
#include <string>

#include "core/scene/beam_mesh.hpp"

namespace pleuel {

/// Where joints, loads and initial deflections may lie on an elastic beam. A node of its mesh follows
/// a place that moves along the beam (core/scene/beam_mesh.hpp), as long as the order of the places
/// stays what it is at the start; all others keep their share of the length, and may not start where
/// one that moves does, or right beside it.
class BeamPlaces {
 public:
  /// @param body, scene  must outlive this
  /// @param start        at which the mesh is made
  BeamPlaces(const Body& body, const Scene& scene, const Design<double>& start);

  /// Whether a node follows some place.
  bool depends_on_design() const { return mesh_.depends_on_design(); }

  /// What is wrong with a place at a design: "must …, which is … [m]"; none if nothing is.
  std::optional<std::string> find_misplaced(const Point& at, const Design<double>& design) const;

  /// The same of places that the mesh would take along and of their order: whether they stay on the axis
  /// of the beam is not looked at.
  std::optional<std::string> find_taken_along(const Point& at, const Design<double>& design) const;

  /// The same of the order of places alone.
  std::optional<std::string> find_disorder(const Point& at, const Design<double>& design) const;

  /// Whether a change of a variable would make it another place of the body than the mesh follows,
  /// to first order.
  bool leaves(const Point& at, std::size_t variable, double change) const;

 private:
  /// The share of the length where the model has at a design what is at a share at the start.
  template <class Scalar>
  Scalar modelled_share(double at_start, const Design<Scalar>& design) const {
    if (!mesh_.depends_on_design()) return Scalar(at_start);
    const ElementPlace place = find_place(mesh_, at_start);
    const std::vector<Scalar> shares = element_shares(beam_, mesh_, design);
    Scalar share = place.xi * shares[static_cast<std::size_t>(place.element)];
    for (int e = 0; e < place.element; ++e) share += shares[static_cast<std::size_t>(e)];
    return share;
  }

  /// A node that places must not pass.
  std::string describe(int node) const;

  const Body& body_;
  const Scene& scene_;
  const BeamBody& beam_;
  const Design<double> start_;
  BeamMesh mesh_;
};

/// The places of all elastic beams, as they are asked for.
class PlacesOfBeams {
 public:
  /// @param scene, start  must outlive this
  PlacesOfBeams(const Scene& scene, const Design<double>& start) : scene_(scene), start_(start) {}

  const BeamPlaces& of(const Body& body) {
    return places_.try_emplace(body.name, body, scene_, start_).first->second;
  }

 private:
  const Scene& scene_;
  const Design<double>& start_;
  std::map<std::string, BeamPlaces> places_;
};

}  // namespace pleuel
