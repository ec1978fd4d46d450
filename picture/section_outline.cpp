#include "picture/section_outline.hpp"

#include <cmath>
#include <numbers>
#include <variant>

#include "core/base/eager_matrices.hpp"

namespace pleuel {

namespace {

using Points = std::vector<Eigen::Vector2d>;

/// @param height  along y
Points rectangle(double height, double width) {
  const double y = height / 2.0, z = width / 2.0;
  return {{y, -z}, {y, z}, {-y, z}, {-y, -z}};
}

Points ellipse(double height, double width) {
  constexpr int corners = 32;
  Points points;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / corners;
    points.emplace_back(height / 2.0 * std::cos(angle), width / 2.0 * std::sin(angle));
  }
  return points;
}

Points i_shape(double height, double width, double flange, double web) {
  const double y = height / 2.0, z = width / 2.0, inner_y = y - flange, inner_z = web / 2.0;
  return {
      {y, -z}, {y, z},   {inner_y, z},   {inner_y, inner_z},   {-inner_y, inner_z}, {-inner_y, z},
      {-y, z}, {-y, -z}, {-inner_y, -z}, {-inner_y, -inner_z}, {inner_y, -inner_z}, {inner_y, -z}};
}

struct OutlineMaker {
  const Design<double>& design;
  double of(const Number& number) const { return resolve(number, design); }

  SectionOutline operator()(const RectangleSection& s) const {
    return {rectangle(of(s.height), of(s.width)), {}};
  }
  SectionOutline operator()(const CircleSection& s) const {
    return {ellipse(of(s.diameter), of(s.diameter)), {}};
  }
  SectionOutline operator()(const TubeSection& s) const {
    const double outer = of(s.outer_diameter), hole = outer - 2.0 * of(s.thickness);
    return {ellipse(outer, outer), hole > 0.0 ? ellipse(hole, hole) : Points{}};
  }
  SectionOutline operator()(const EllipseSection& s) const {
    return {ellipse(of(s.height), of(s.width)), {}};
  }
  SectionOutline operator()(const BoxSection& s) const {
    const double walls = 2.0 * of(s.thickness);
    const double height = of(s.height) - walls, width = of(s.width) - walls;
    const bool has_hole = height > 0.0 && width > 0.0;
    return {rectangle(of(s.height), of(s.width)), has_hole ? rectangle(height, width) : Points{}};
  }
  SectionOutline operator()(const ISection& s) const {
    return {i_shape(of(s.height), of(s.width), of(s.flange_thickness), of(s.web_thickness)), {}};
  }
  SectionOutline operator()(const GeneralSection& s) const {
    const double area = of(s.area);
    return {rectangle(std::sqrt(12.0 * of(s.inertia_z) / area),
                      std::sqrt(12.0 * of(s.inertia_y) / area)),
            {},
            false};
  }
};

}  // namespace

SectionOutline section_outline(const Section& section, const Design<double>& design) {
  return std::visit(OutlineMaker{design}, section);
}

}  // namespace pleuel
