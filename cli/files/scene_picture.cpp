#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "cli/files/run_picture.hpp"
#include "cli/reports/scene_report.hpp"
#include "cli/text/wrapped_text.hpp"
#include "core/base/number_text.hpp"
#include "core/model/motion_plane.hpp"
#include "core/scene/grammar/tables.hpp"
#include "core/scene/joint_kind.hpp"
#include "core/scene/shown_unit.hpp"
#include "picture/drawn_place.hpp"
#include "picture/section_outline.hpp"

namespace pleuel {

namespace {

using Values = Design<double>;

Json vector_document(const Eigen::Vector3d& v) {
  return Json::array({v.x(), v.y(), v.z()});
}

Json points_document(const std::vector<Eigen::Vector2d>& points) {
  return list_of(points, [](const Eigen::Vector2d& point) { return Json{point.x(), point.y()}; });
}

/// ", width 20 mm, height 30 mm"
class SizeTexts : public Keys {
 public:
  explicit SizeTexts(const Values& design) : design_(design) {}

  void number(const Key& key, KeyMember<Number> size, const Measure&, std::string_view) override {
    text += fmt::format(", {} {} {}", words_of(std::string(key.word)),
                        significant(unit_.shown(resolve(size.get(), design_)), 4), unit_.name);
  }

  std::string text;

 private:
  const Values& design_;
  ShownUnit unit_ = engineering_unit("m");
};

/// "rectangle, width 20 mm, height 30 mm".
std::string section_text(const Section& section, const Values& design) {
  static constexpr std::array<const char*, 6> names = {"rectangle", "circle", "tube",
                                                       "ellipse",   "box",    "I"};
  static_assert(std::variant_size_v<Section> == names.size() + 1, "and the general one");
  if (std::holds_alternative<GeneralSection>(section)) {
    return "general (drawn as the rectangle with its radii of gyration)";
  }
  SizeTexts sizes(design);
  std::visit([&](auto of_type) { describe(sizes, of_type); }, section);
  return names[section.index()] + sizes.text;
}

Json segments_document(const BeamBody& beam, const Values& design) {
  Json document = Json::array();
  double begin = 0.0;
  const std::vector<double> fractions = length_fractions(beam);
  for (std::size_t i = 0; i < beam.segments.size(); ++i) {
    const SectionOutline outline = section_outline(beam.segments[i].section, design);
    document.push_back({{"begin", begin},
                        {"end", begin + fractions[i]},
                        {"text", section_text(beam.segments[i].section, design)},
                        {"elements", beam.segments[i].elements},
                        {"outer", points_document(outline.outer)},
                        {"inner", points_document(outline.inner)}});
    begin += fractions[i];
  }
  return document;
}

const char* type_of(const Body& body) {
  static constexpr std::array<const char*, 4> names = {"beam", "rigid", "point-mass", "invariants"};
  return names[body.shape.index()];
}

/// The lowest upper limit on the von Mises stress of a body; none if there is none.
std::optional<double> stress_limit(const ProblemFile& problem, const std::string& body) {
  std::optional<double> limit;
  for (const ConstraintSettings& constraint : problem.constraints) {
    if (constraint.response.empty() || !constraint.upper) continue;
    const ResponseSettings& response = find_response(problem, constraint.response);
    const auto* stress = response.as<StressResponse>();
    const bool is_of_body = stress != nullptr && stress->part == StressPart::von_mises &&
                            std::ranges::count(stress->where.bodies, body) > 0;
    if (is_of_body && (!limit || *constraint.upper < *limit)) limit = *constraint.upper;
  }
  return limit;
}

/// The largest ones of an elastic body.
Json bent_start(const Body& body, const Values& start) {
  double displacement = 0.0, rate = 0.0;
  for (const InitialDeflection& one : body.initial_deflections) {
    displacement = std::max(displacement, std::abs(resolve(one.displacement, start)));
    rate = std::max(rate, std::abs(resolve(one.rate, start)));
  }
  return {{"displacement", displacement}, {"rate", rate}};
}

Json body_document(const ProblemFile& problem, const Body& body, const Values& start) {
  Json document = {{"name", body.name}, {"type", type_of(body)}};
  if (const auto* beam = std::get_if<BeamBody>(&body.shape)) {
    const Material& material = find_material(problem.scene, beam->material);
    document["material"] = material.name;
    document["is_rigid"] = beam->is_rigid;
    document["frames"] = beam->frames;
    if (material.strength) document["strength"] = resolve(*material.strength, start);
  } else if (const auto* imported = std::get_if<ImportedBody>(&body.shape)) {
    const std::optional<StressRecovery>& stress = imported->file->constants.stress;
    if (stress && stress->strengths.yield > 0.0) document["strength"] = stress->strengths.yield;
  }
  if (const auto limit = stress_limit(problem, body.name)) document["stress_limit"] = *limit;
  if (!body.initial_deflections.empty()) document["starts_bent"] = bent_start(body, start);
  return document;
}

Json joint_document(const Joint& joint) {
  const JointKind& kind = kind_of(joint.type);
  Json document = {{"name", joint.name},         {"type", kind.word},
                   {"freedom", kind.freedom},    {"freedoms", kind.freedoms()},
                   {"bodies", joint.bodies},     {"axis", joint.axis},
                   {"is_guide", kind.is_guide()}};
  if (kind.has_displacement()) {
    document["slides"] = "along";
  } else if (kind.slides == JointSlides::across_axis) {
    document["slides"] = "across";  // on a rod between points a body slides neither way
  }
  if (kind.has_second_axis()) document["second_axis"] = joint.second_axis;
  if (joint.drive) {
    const bool turns = joint.drive->coordinate == DrivenCoordinate::angle;
    document["drive"] = turns ? "angle" : "displacement";
  }
  return document;
}

class LoadDescription {
 public:
  Json operator()(const PointLoad& load) const {
    return {{"type", load.is_force() ? "force" : "torque"},
            {"bodies", {load.body}},
            {"direction", load.direction},
            {"follows_body", load.follows_body},
            {"unit", load.unit()}};
  }
  Json operator()(const SpringDamper& load) const {
    return {{"type", "spring"}, {"bodies", load.bodies}};
  }
  Json operator()(const JointForce& load) const {
    const bool turns = load.coordinate == DrivenCoordinate::angle;
    return {{"type", "joint-force"}, {"joint", load.joint}, {"unit", turns ? "N m" : "N"}};
  }
};

struct GeometryWriter {
  const ProblemFile& problem;
  const Values& design;
  const Scene& scene = problem.scene;

  Json bodies() const {
    return list_of(scene.bodies, [&](const Body& body) { return body_geometry(body); });
  }

  Json joints() const {
    return list_of(scene.joints, [&](const Joint& joint) {
      const Point& second = second_point(joint);
      Json entry = {{"places", {place(joint.bodies[0], joint.at), place(joint.bodies[1], second)}}};
      if (joint.drive) entry["drive"] = curve(joint.drive->motion, LawOf::motion);
      return entry;
    });
  }

  Json loads() const {
    return list_of(scene.loads, [&](const Load& load) { return std::visit(*this, load.element); });
  }

  /// Of a spread force the middle of its stretch.
  Json operator()(const PointLoad& load) const {
    if (!load.to) return at_place(load);
    PointLoad middle = load;
    const Eigen::Vector3d sum = resolve_point(load.at, design) + resolve_point(*load.to, design);
    middle.at = {0.5 * sum.x(), 0.5 * sum.y(), 0.5 * sum.z()};
    return at_place(middle);
  }
  Json operator()(const SpringDamper& load) const {
    return {{"places", {place(load.bodies[0], load.at[0]), place(load.bodies[1], load.at[1])}},
            {"text", spring_text(load, design)}};
  }
  Json operator()(const JointForce& load) const {
    Json document = {{"places", Json::array()}, {"text", spring_text(load, design)}};
    if (load.motor && !depends_on_state(*load.motor))
      document["value"] = curve(*load.motor, LawOf::load);
    return document;
  }

 private:
  Json curve(const TimeFunction& function, LawOf purpose) const {
    const auto [times, values] = law_points(function, problem.simulation.end_time, design, purpose);
    Eigen::MatrixXd curve(2, times.size());
    curve.row(0) = Eigen::Map<const Eigen::RowVectorXd>(times.data(), curve.cols());
    curve.row(1) = Eigen::Map<const Eigen::RowVectorXd>(values.data(), curve.cols());
    return packed_numbers(curve);
  }

  Json at_place(const PointLoad& load) const {
    Json document = {{"places", {place(load.body, load.at)}}};
    if (depends_on_state(load.value)) {
      const bool turns = load.over->coordinate == DrivenCoordinate::angle;
      document["text"] =
          fmt::format("over the {} of {}", turns ? "angle" : "displacement", load.over->joint);
    } else {
      document["value"] = curve(load.value, LawOf::load);
    }
    return document;
  }

  Json place(const std::string& body, const Point& at) const {
    const DrawnPlace drawn = drawn_place(scene, body, at, design);
    Json document = {{"body", drawn.body}, {"at", vector_document(resolve_point(at, design))}};
    const bool is_on_axis = drawn.body >= 0 && drawn.share >= 0.0 &&
                            std::holds_alternative<BeamBody>(scene.bodies[drawn.body].shape);
    if (is_on_axis) {
      document["share"] = drawn.share;
    } else {
      document["point"] = vector_document(drawn.point);
    }
    return document;
  }

  double distance(const Point& one, const Point& other) const {
    return (resolve_point(other, design) - resolve_point(one, design)).norm();
  }

  Json body_geometry(const Body& body) const {
    const Pose<double> pose = body_pose(body, design);
    Json document = {{"origin", vector_document(pose.origin)},
                     {"axes",
                      {vector_document(Eigen::Vector3d(pose.rotation.col(0))),
                       vector_document(Eigen::Vector3d(pose.rotation.col(1))),
                       vector_document(Eigen::Vector3d(pose.rotation.col(2)))}}};
    if (const auto* beam = std::get_if<BeamBody>(&body.shape)) {
      document["length"] = distance(beam->from, beam->to);
      document["segments"] = segments_document(*beam, design);
    } else if (const auto* imported = std::get_if<ImportedBody>(&body.shape)) {
      document["length"] = distance(imported->from, imported->to);
    } else if (const auto* rigid = std::get_if<RigidBody>(&body.shape)) {
      document["mass"] = resolve(rigid->mass, design);
    } else {
      document["mass"] = resolve(std::get<PointMass>(body.shape).mass, design);
    }
    return document;
  }
};

Values values_of_vector(const Eigen::VectorXd& x) {
  return {x.begin(), x.end()};
}

}  // namespace

Json scene_picture(const ProblemFile& problem) {
  const Values start = values_of_vector(start_design(problem));
  const auto& [gx, gy, gz] = problem.scene.gravity;
  Json document = {{"gravity", {resolve(gx, start), resolve(gy, start), resolve(gz, start)}},
                   {"end_time", problem.simulation.end_time}};
  const PlaneAnalysis plane = find_motion_plane(problem.scene, start);
  if (plane.plane) document["plane_normal"] = vector_document(plane.plane->normal);
  document["bodies"] = list_of(
      problem.scene.bodies, [&](const Body& body) { return body_document(problem, body, start); });
  document["joints"] = list_of(problem.scene.joints, joint_document);
  document["loads"] = list_of(problem.scene.loads, [](const Load& load) {
    Json entry = std::visit(LoadDescription{}, load.element);
    entry["name"] = load.name;
    return entry;
  });
  return document;
}

Json geometry_picture(const ProblemFile& problem, const Eigen::VectorXd& x) {
  const Values design = values_of_vector(x);
  const GeometryWriter writer{problem, design};
  return {{"bodies", writer.bodies()}, {"joints", writer.joints()}, {"loads", writer.loads()}};
}

}  // namespace pleuel
