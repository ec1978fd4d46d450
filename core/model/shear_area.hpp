#pragma once

#include "core/scene/scene.hpp"
#include "core/section/section_properties.hpp"
#include "core/section/shear_coefficient.hpp"

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

}  // namespace pleuel
