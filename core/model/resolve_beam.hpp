#pragma once

#include "core/beam/beam.hpp"
#include "core/model/scene_geometry.hpp"
#include "core/model/shear_area.hpp"
#include "core/scene/beam_mesh.hpp"

namespace pleuel {

template <class Scalar>
Strengths<Scalar> resolve_strengths(const Material& material, const Design<Scalar>& design) {
  Strengths<Scalar> strengths;
  const auto take = [&](const std::optional<Number>& number, Scalar& strength) {
    if (number) strength = resolve(*number, design);
  };
  take(material.strength, strengths.yield);
  take(material.ultimate_strength, strengths.ultimate);
  take(material.endurance_limit, strengths.endurance_limit);
  take(material.fatigue_strength, strengths.fatigue);
  strengths.fatigue_exponent = material.fatigue_exponent.value_or(0.0);
  return strengths;
}

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
  element.strengths = resolve_strengths(material, design);
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
