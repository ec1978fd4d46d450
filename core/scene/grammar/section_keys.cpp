#include "core/scene/grammar/tables.hpp"

namespace pleuel {

namespace {

constexpr Measure size = {quantities::length, Range::positive};

}  // namespace

const std::vector<ObjectKind<Section>>& section_kinds() {
  static const std::vector<ObjectKind<Section>> kinds = {
      {"rectangle", RectangleSection()}, {"circle", CircleSection()}, {"tube", TubeSection()},
      {"ellipse", EllipseSection()},     {"box", BoxSection()},       {"i", ISection()},
      {"general", GeneralSection()}};
  return kinds;
}

void describe(Keys& keys, Section& section) {
  std::visit([&](auto& kind) { describe(keys, kind); }, section);
}

void describe(Keys& keys, RectangleSection& s) {
  keys.number("width", s.width, size, "Along local z {}; out of the plane of a planar mechanism.");
  keys.number("height", s.height, size, "Along local y {}; in the plane of a planar mechanism.");
}

void describe(Keys& keys, CircleSection& s) {
  keys.number("diameter", s.diameter, size, "{}");
}

void describe(Keys& keys, TubeSection& s) {
  keys.number("outer_diameter", s.outer_diameter, size, "{}");
  keys.number("thickness", s.thickness, size, "Of the wall {}, at most the radius.");
}

void describe(Keys& keys, EllipseSection& s) {
  keys.number("width", s.width, size, "Full axis along local z {}.");
  keys.number("height", s.height, size, "Full axis along local y {}.");
}

void describe(Keys& keys, BoxSection& s) {
  keys.about("Rectangular tube.");
  keys.number("width", s.width, size, "Outer, along local z {}.");
  keys.number("height", s.height, size, "Outer, along local y {}.");
  keys.number("thickness", s.thickness, size, "Of the walls {}, at most half the shorter side.");
}

void describe(Keys& keys, ISection& s) {
  keys.about("Web along local y, flanges along local z. Warping is not modelled.");
  keys.number("width", s.width, size, "Of the flanges {}.");
  keys.number("height", s.height, size, "Over both flanges {}.");
  keys.number("flange_thickness", s.flange_thickness, size, "{}, at most half the height.");
  keys.number("web_thickness", s.web_thickness, size,
              "{}, at most the width and three times the flange thickness.");
}

void describe(Keys& keys, GeneralSection& s) {
  constexpr Measure area = {quantities::area, Range::positive};
  constexpr Measure inertia = {quantities::second_moment_of_area, Range::positive};
  keys.about("Any section, by its numbers; y and z are its principal axes.");
  keys.number("area", s.area, area, "{}");
  keys.number("inertia_y", s.inertia_y, inertia, "Integral of z^2 {}: bending along local z.");
  keys.number("inertia_z", s.inertia_z, inertia, "Integral of y^2 {}: bending along local y.");
  keys.number("torsion", s.torsion, inertia, "Torsion constant {}.");
  keys.number(optional_key("shear_area_y"), s.shear_area_y, area,
              "Area that carries a shear force along local y {}: the area times the shear "
              "coefficient. For beams with shear.");
  keys.number(optional_key("shear_area_z"), s.shear_area_z, area,
              "Of a shear force along local z {}.");
  keys.together("shear_area_y", "shear_area_z");
  keys.list("points", "point", s.points, "Where stress is evaluated.");
}

void describe(Keys& keys, GeneralStressPoint& s) {
  keys.fixed("y", s.y, {quantities::length}, "{}");
  keys.fixed("z", s.z, {quantities::length}, "{}");
  keys.fixed("shear", s.shear, {quantities::torsional_shear, Range::not_negative},
             "Torsional shear stress per torque {}.");
}

}  // namespace pleuel
