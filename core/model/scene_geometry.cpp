#include "core/model/scene_geometry.hpp"

namespace pleuel {

namespace {

struct Collector {
  std::set<int> variables;

  void operator()(const Number& number) {
    if (number.is_bound()) variables.insert(number.variable);
  }
  template <std::size_t N>
  void operator()(const std::array<Number, N>& numbers) {
    for (const Number& number : numbers) (*this)(number);
  }
  void operator()(const RectangleSection& s) { (*this)(std::array{s.width, s.height}); }
  void operator()(const CircleSection& s) { (*this)(s.diameter); }
  void operator()(const TubeSection& s) { (*this)(std::array{s.outer_diameter, s.thickness}); }
  void operator()(const Material& m) { (*this)(std::array{m.young, m.poisson, m.density}); }
};

}  // namespace

std::set<int> variables_of(const Body& body, const Scene& scene) {
  Collector collect;
  if (const auto* beam = std::get_if<BeamBody>(&body.shape)) {
    collect(beam->from);
    collect(beam->to);
    collect(beam->damping.mass);
    collect(beam->damping.stiffness);
    collect(find_material(scene, beam->material));
    for (const Segment& segment : beam->segments) std::visit(collect, segment.section);
  } else if (const auto* rigid = std::get_if<RigidBody>(&body.shape)) {
    collect(rigid->at);
    collect(rigid->mass);
    collect(rigid->inertia);
  } else {
    const auto& point = std::get<PointMass>(body.shape);
    collect(point.at);
    collect(point.mass);
  }
  return collect.variables;
}

}  // namespace pleuel
