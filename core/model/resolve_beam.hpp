#pragma once

#include "core/beam/beam.hpp"
#include "core/model/scene_geometry.hpp"
#include "core/scene/beam_mesh.hpp"
#include "core/scene/scene.hpp"
#include "core/section/section_properties.hpp"

namespace pleuel {

/// κA of shear forces along local y and z [m²].
template <class Scalar>
struct ShearArea {
  Scalar along_y, along_z;
};

/// With Cowper's κ, or as a general section says; where that does not, κ is a rectangle's.
/// @param properties  of the section at the design
/// @param nu          Poisson's ratio
template <class Scalar>
ShearArea<Scalar> shear_area(const Section& section, const SectionProperties<Scalar>& properties,
                             const Scalar& nu, const Design<Scalar>& design) {
  struct Visitor {
    const Scalar& area;
    const Scalar& nu;
    const Design<Scalar>& design;

    Scalar of(const Number& number) const { return resolve(number, design); }
    ShearArea<Scalar> same(const Scalar& kappa) const {
      const Scalar both = kappa * area;
      return {both, both};
    }
    ShearArea<Scalar> operator()(const RectangleSection&) const {
      return same(rectangle_shear_coefficient(nu));
    }
    ShearArea<Scalar> operator()(const CircleSection&) const {
      return same(round_shear_coefficient(nu, Scalar(0)));
    }
    ShearArea<Scalar> operator()(const TubeSection& s) const {
      const Scalar ratio = 1.0 - 2.0 * of(s.thickness) / of(s.outer_diameter);
      return same(round_shear_coefficient(nu, ratio));
    }
    ShearArea<Scalar> operator()(const EllipseSection& s) const {
      const Scalar height = of(s.height), width = of(s.width);
      return {area * ellipse_shear_coefficient(nu, height, width),
              area * ellipse_shear_coefficient(nu, width, height)};
    }
    ShearArea<Scalar> operator()(const BoxSection& s) const {
      const Scalar t = of(s.thickness), width = of(s.width) - t, height = of(s.height) - t;
      return {area * box_shear_coefficient(nu, ThinWalls<Scalar>{height, width, t, t}),
              area * box_shear_coefficient(nu, ThinWalls<Scalar>{width, height, t, t})};
    }
    /// Along z the flanges carry the force, as two rectangles.
    ShearArea<Scalar> operator()(const ISection& s) const {
      const Scalar flange = of(s.flange_thickness), web = of(s.web_thickness);
      const Scalar width = of(s.width), height = of(s.height) - flange;
      const Scalar kappa = i_shear_coefficient(nu, ThinWalls<Scalar>{height, width, web, flange});
      return {area * kappa, 2.0 * width * flange * rectangle_shear_coefficient(nu)};
    }
    ShearArea<Scalar> operator()(const GeneralSection& s) const {
      if (s.shear_area_y && s.shear_area_z) return {of(*s.shear_area_y), of(*s.shear_area_z)};
      return same(rectangle_shear_coefficient(nu));
    }
  };
  return std::visit(Visitor{properties.area, nu, design}, section);
}

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
