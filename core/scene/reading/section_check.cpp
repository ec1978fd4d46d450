#include "core/scene/reading/section_check.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace pleuel {
namespace {

/// Sizes that exceed their limit by less than this share of it are written numbers, rounded.
constexpr double rounding_tolerance = 1e-9;

struct SectionCheck {
  const JsonNode& node;
  const Design<double>& start;

  void expect_at_most(const char* key, const Number& size, double limit, const char* name,
                      const char* owner = "") const {
    const double value = resolve(size, start);
    if (value <= limit * (1.0 + rounding_tolerance)) return;
    node.at(key).fail(
        fmt::format("must not exceed {} {:g} [m]{}, got {:g}", name, limit, owner, value));
  }

  void operator()(const RectangleSection&) const {}
  void operator()(const CircleSection&) const {}
  void operator()(const EllipseSection&) const {}
  void operator()(const GeneralSection&) const {}
  void operator()(const TubeSection& tube) const {
    expect_at_most("thickness", tube.thickness, 0.5 * resolve(tube.outer_diameter, start),
                   "the radius", " of the tube");
  }
  void operator()(const BoxSection& box) const {
    const double shorter = std::min(resolve(box.width, start), resolve(box.height, start));
    expect_at_most("thickness", box.thickness, 0.5 * shorter, "half the shorter side",
                   " of the box");
  }
  /// The torsion constant of an I is known up to a web of three times the flange.
  void operator()(const ISection& i) const {
    expect_at_most("flange_thickness", i.flange_thickness, 0.5 * resolve(i.height, start),
                   "half the height");
    expect_at_most("web_thickness", i.web_thickness, resolve(i.width, start), "the width");
    expect_at_most("web_thickness", i.web_thickness, 3.0 * resolve(i.flange_thickness, start),
                   "three times the flange thickness");
  }
};

}  // namespace

void check_section(const JsonNode& node, const Section& section, const Design<double>& start) {
  std::visit(SectionCheck{node, start}, section);
}

}  // namespace pleuel
