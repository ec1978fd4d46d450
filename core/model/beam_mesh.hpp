#pragma once

#include <string>
#include <vector>

#include "core/scene/scene.hpp"

namespace pleuel {

/// An element as a share of the beam's length, which does not depend on the design.
struct MeshElement {
  int segment = 0;
  double share = 0.0;
};

struct BeamMesh {
  std::vector<MeshElement> elements;
  std::vector<int> attached_nodes;  ///< that joints and loads act on, of elastic beams
};

/// The elements of a beam: those that the file asks for. Where a joint or a load acts inside one it
/// is divided: section forces are recovered with the fixed-end terms of inertia loads only, and so
/// have no kinks or jumps inside elements. A place nearer to a node than a hundredth of the element
/// is left inside: the node would make the element too stiff beside the others. Each of these
/// elements is divided into the `pieces` of the beam.
/// @param start      at which attached points are looked at; their share of the length is fixed
/// @param is_elastic otherwise nothing is divided
BeamMesh make_mesh(const Body& body, const Scene& scene, const Design<double>& start,
                   bool is_elastic);

/// Share of the length at which a point of the scene lies on a beam, or on a part of one.
double share_along(const BeamBody& beam, const Point& point, const Design<double>& start);

}  // namespace pleuel
