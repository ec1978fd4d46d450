#include "core/model/divided_beams.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/find_named.hpp"
#include "core/base/int_size.hpp"
#include "core/model/effect_decisions.hpp"
#include "core/model/scene_geometry.hpp"
#include "core/scene/beam_mesh.hpp"
#include "core/scene/held_points.hpp"

namespace pleuel {

namespace {

/// Places nearer to the end of a stretch than this share of the beam belong to it.
constexpr double part_tolerance = 1e-9;

/// Elements so many that each frame has one.
std::vector<Segment> refine_segments(const BeamBody& beam) {
  int elements = 0;
  for (const Segment& segment : beam.segments) elements += segment.elements;
  const std::vector<double> fractions = length_fractions(beam);
  const int factor = (beam.frames + elements - 1) / elements;
  std::vector<Segment> segments = beam.segments;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    segments[i].elements *= factor;
    segments[i].fraction = fractions[i];
  }
  return segments;
}

/// Shares of the length of all nodes.
std::vector<double> node_shares(const std::vector<Segment>& segments) {
  std::vector<double> shares{0.0};
  double begin = 0.0;
  for (const Segment& segment : segments) {
    for (int i = 1; i <= segment.elements; ++i) {
      shares.push_back(begin + *segment.fraction * i / segment.elements);
    }
    begin += *segment.fraction;
  }
  shares.back() = 1.0;
  return shares;
}

/// Nodes at which stretches end: those nearest to equal shares, each stretch with an element.
std::vector<int> cut_nodes(const std::vector<double>& shares, int frames) {
  const int last = int_size(shares) - 1;
  std::vector<int> nodes{0};
  for (int k = 1; k < frames; ++k) {
    const double wanted = static_cast<double>(k) / frames;
    const int first = nodes.back() + 1, end = last - (frames - k);
    int best = first;
    for (int node = first; node <= end; ++node) {
      const auto distance = [&](int i) { return std::abs(shares[i] - wanted); };
      if (distance(node) < distance(best)) best = node;
    }
    nodes.push_back(best);
  }
  nodes.push_back(last);
  return nodes;
}

/// The stretch between two nodes of a beam.
BeamBody cut(const BeamBody& beam, const std::vector<Segment>& segments, int first, int last,
             BeamPart part) {
  BeamBody stretch = beam;
  stretch.frames = 1;
  stretch.segments = segments;
  int node = 0;
  for (Segment& segment : stretch.segments) {
    const int end = node + segment.elements;
    const int inside = std::max(0, std::min(end, last) - std::max(node, first));
    segment.fraction = *segment.fraction * inside / segment.elements;
    segment.elements = inside;
    node = end;
  }
  part.first_element = first;
  stretch.part = std::move(part);
  return stretch;
}

class Division {
 public:
  Division(const Scene& scene, const EffectSettings& effects, const Design<double>& start)
      : scene_(scene), effects_(effects), start_(start) {}

  DividedScene run() {
    DividedScene divided;
    for (const Body& body : scene_.bodies) add(body, divided.scene);
    std::vector<Joint> joints = std::move(divided.scene.joints);
    std::vector<Body> bodies = std::move(divided.scene.bodies);
    divided.scene = scene_;
    divided.divisions = int_size(joints);
    divided.scene.bodies = std::move(bodies);
    if (!parts_.empty()) move_attachments(divided.scene);
    divided.scene.joints.insert(divided.scene.joints.begin(), joints.begin(), joints.end());
    return divided;
  }

 private:
  void add(const Body& body, Scene& divided) {
    const auto* beam = std::get_if<BeamBody>(&body.shape);
    const bool is_divided =
        beam != nullptr && beam->frames > 1 && decide_effects(body, effects_).elasticity;
    if (!is_divided) {
      divided.bodies.push_back(body);
      return;
    }
    const std::vector<Segment> segments = refine_segments(*beam);
    const std::vector<double> shares = node_shares(segments);
    const std::vector<int> nodes = cut_nodes(shares, beam->frames);
    std::vector<Body>& parts = parts_[body.name];
    for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
      const auto share = [&](int node) { return shares[node]; };
      Body part = body;
      part.name = unique_name(fmt::format("{} (frame {})", body.name, k + 1));
      part.shape = cut(*beam, segments, nodes[k], nodes[k + 1],
                       {body.name, share(nodes[k]), share(nodes[k + 1])});
      if (k > 0) divided.joints.push_back(weld(body.name, k, parts.back(), part));
      parts.push_back(part);
      divided.bodies.push_back(std::move(part));
    }
  }

  std::string unique_name(std::string name) const {
    while (find_named(scene_.bodies, name)) name += '\'';
    return name;
  }

  /// At the start design: where elastic beams are held is a share of their length.
  Joint weld(const std::string& beam, std::size_t number, const Body& before,
             const Body& after) const {
    Joint joint;
    joint.name = fmt::format("\"{}\" between its frames {} and {}", beam, number, number + 1);
    joint.type = JointType::fixed;
    joint.bodies = {before.name, after.name};
    const Eigen::Vector3d at = body_pose(after, start_).origin;
    joint.at = {at.x(), at.y(), at.z()};
    return joint;
  }

  void move_attachments(Scene& divided) const {
    split_stretches(divided.loads);
    const auto move_held = [&](std::string& body, const Point& at, const PointKey&) {
      move(body, at);
    };
    for (Joint& joint : divided.joints) visit_held_points(joint, move_held);
    for (Load& load : divided.loads) visit_held_points(load, move_held);
  }

  /// Forces that are spread over several frames become one for each of them.
  void split_stretches(std::vector<Load>& loads) const {
    std::vector<Load> split;
    for (const Load& load : loads) {
      const auto* force = std::get_if<PointLoad>(&load.element);
      const bool is_split = force != nullptr && force->to && parts_.contains(force->body);
      if (!is_split) {
        split.push_back(load);
        continue;
      }
      for (const Body& part : parts_.at(force->body)) add_piece(load, *force, part, split);
    }
    loads = std::move(split);
  }

  /// Of the stretch of a force, what lies on one part of the beam.
  void add_piece(const Load& load, const PointLoad& force, const Body& part,
                 std::vector<Load>& split) const {
    const auto& beam = std::get<BeamBody>(part.shape);
    if (share_of_stretch(beam, {force.at, *force.to}, start_) <= part_tolerance) return;
    const Pose<double> pose = body_pose(part, start_);
    const auto on_part = [&](const Point& point) -> Point {
      const double share = share_along(beam, point, start_);
      if (share >= 0.0 && share <= 1.0) return point;
      const double length =
          (beam.part->end - beam.part->begin) * (position(beam.to) - position(beam.from)).norm();
      const Eigen::Vector3d end = pose.origin + (share > 1.0 ? length : 0.0) * pose.rotation.col(0);
      return {end.x(), end.y(), end.z()};
    };
    PointLoad piece = force;
    piece.body = part.name;
    piece.whole = {force.at, *force.to};
    piece.at = on_part(force.at);
    piece.to = on_part(*force.to);
    split.push_back({load.name, std::move(piece)});
  }

  Eigen::Vector3d position(const Point& point) const { return resolve_point(point, start_); }

  /// From a beam to the stretch of it that a point lies on.
  void move(std::string& body, const Point& at) const {
    const auto found = parts_.find(body);
    if (found == parts_.end()) return;
    for (const Body& part : found->second) {
      body = part.name;
      if (share_along(std::get<BeamBody>(part.shape), at, start_) <= 1.0 + part_tolerance) return;
    }
  }

  const Scene& scene_;
  const EffectSettings& effects_;
  const Design<double>& start_;
  std::map<std::string, std::vector<Body>> parts_;  ///< by the name of the beam
};

}  // namespace

DividedScene divide_beams(const Scene& scene, const EffectSettings& effects,
                          const Design<double>& start) {
  return Division(scene, effects, start).run();
}

Scene without_divisions(Scene scene) {
  for (Body& body : scene.bodies) {
    if (auto* beam = std::get_if<BeamBody>(&body.shape)) beam->frames = 1;
  }
  return scene;
}

const std::string& name_in_scene(const Body& body) {
  const auto* beam = std::get_if<BeamBody>(&body.shape);
  return beam != nullptr && beam->part ? beam->part->body : body.name;
}

}  // namespace pleuel
