#pragma once

#include "core/beam/beam.hpp"
#include "core/model/scene_geometry.hpp"
#include "core/model/shear_area.hpp"
#include "core/scene/beam_mesh.hpp"

namespace pleuel {

/// The elements of a beam at a design of any scalar type.
template <class Scalar>
Beam<Scalar> resolve_beam(const BeamBody& body, const BeamMesh& mesh, const Scene& scene,
                          const Design<Scalar>& design) {
  const Material& material = find_material(scene, body.material);
  const Scalar length =
      length_of<Scalar>(resolve_point(body.to, design) - resolve_point(body.from, design));
  BeamElement<Scalar> element;
  const Scalar poisson = resolve(material.poisson, design);
  element.young = resolve(material.young, design);
  element.shear = element.young / (2.0 * (1.0 + poisson));
  element.density = resolve(material.density, design);
  if (material.strength) element.strength = resolve(*material.strength, design);
  if (material.ultimate_strength) {
    element.ultimate_strength = resolve(*material.ultimate_strength, design);
  }
  if (material.endurance_limit) {
    element.endurance_limit = resolve(*material.endurance_limit, design);
  }
  if (material.fatigue_strength) {
    element.fatigue_strength = resolve(*material.fatigue_strength, design);
  }
  element.fatigue_exponent = material.fatigue_exponent.value_or(0.0);
  Beam<Scalar> beam;
  int segment = -1;
  const std::vector<Scalar> shares = element_shares(body, mesh, design);
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
    const MeshElement& part = mesh.elements[e];
    if (part.segment != segment) {
      segment = part.segment;
      const Section& section = body.segments[segment].section;
      element.section = resolve_section(section, design);
      if (body.has_shear) {
        const ShearArea<Scalar> area = shear_area(section, element.section, poisson, design);
        element.shear_compliance_y = 1.0 / (element.shear * area.along_y);
        element.shear_compliance_z = 1.0 / (element.shear * area.along_z);
      }
    }
    element.length = length * shares[e];
    beam.elements.push_back(element);
  }
  beam.mass_damping = resolve(body.damping.mass, design);
  beam.stiffness_damping = resolve(body.damping.stiffness, design);
  return beam;
}

}  // namespace pleuel
