#include <algorithm>
#include <cmath>
#include <set>

#include "core/model/build_context.hpp"
#include "core/model/end_fittings.hpp"
#include "core/model/scene_geometry.hpp"
#include "core/scene/held_points.hpp"
#include "core/scene/joint_kind.hpp"
#include "core/scene/visit_numbers.hpp"

namespace pleuel {

namespace {

/// Where something acts: a point, or the centre of mass of a rigid beam.
struct Place {
  const Point* point = nullptr;
  const Body* beam = nullptr;
};

bool is_rigid_piece(const Scene& scene, const std::string& name) {
  const Body* body = find_named(scene.bodies, name);
  if (body == nullptr) return false;
  if (const auto* beam = std::get_if<BeamBody>(&body->shape)) return beam->is_rigid;
  return std::holds_alternative<RigidBody>(body->shape);
}

template <class Scalar>
Vector3<Scalar> centre_of(const BeamBody& beam, const Design<Scalar>& design) {
  const std::vector<double> shares = length_fractions(beam);
  Scalar area(0), moment(0);
  double begin = 0.0;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const Scalar part = shares[i] * resolve_section(beam.segments[i].section, design).area;
    area += part;
    moment += part * (begin + 0.5 * shares[i]);
    begin += shares[i];
  }
  const Vector3<Scalar> from = resolve_point(beam.from, design);
  const Vector3<Scalar> way = resolve_point(beam.to, design) - from;
  return from + Scalar(moment / area) * way;
}

template <class Scalar>
Vector3<Scalar> resolve_place(const Place& place, const Design<Scalar>& design) {
  return place.point ? resolve_point(*place.point, design)
                     : centre_of(std::get<BeamBody>(place.beam->shape), design);
}

/// From the beginning of a beam on, along its axis.
template <class Scalar>
Scalar position(const BeamBody& beam, const Vector3<Scalar>& point, const Design<Scalar>& design) {
  const Vector3<Scalar> from = resolve_point(beam.from, design);
  const Vector3<Scalar> way = resolve_point(beam.to, design) - from;
  return Vector3<Scalar>(point - from).dot(way) / length_of<Scalar>(way);
}

template <class Scalar>
Scalar distance(const BeamBody& beam, int end, const Place& place, const Design<Scalar>& design) {
  const Scalar along = position(beam, resolve_place(place, design), design);
  return end == 0 ? Scalar(-along)
                  : Scalar(along - position(beam, resolve_point(beam.to, design), design));
}

}  // namespace

class EndFittings::Builder {
 public:
  Builder(const Body& body, const Scene& scene, const BuildContext& context)
      : body_(body), beam_(std::get<BeamBody>(body.shape)), scene_(scene), context_(context) {
    const Vector3<double> to = resolve_point(beam_.to, context.start);
    built_.beam_ = body.name;
    built_.length_ = position(beam_, to, context.start);
  }

  std::optional<EndFittings> build() {
    for (int end = 0; end < 2; ++end) {
      const std::set<std::string> bodies = bodies_at(end);
      if (!bodies.empty()) add(end, bodies);
    }
    if (!built_.is_fitted(0) && !built_.is_fitted(1)) return std::nullopt;
    put_together();
    return std::move(built_);
  }

 private:
  double start_position(const Point& point) const {
    return position(beam_, resolve_point(point, context_.start), context_.start);
  }
  bool is_at(int end, const Point& point) const {
    const double at = start_position(point), least = same_place * built_.length_;
    return end == 0 ? at <= least : at >= built_.length_ - least;
  }

  /// Of the fitting, or none.
  std::set<std::string> bodies_at(int end) const {
    std::set<std::string> bodies;
    std::vector<std::string> next = {body_.name};
    while (!next.empty()) {
      const std::string name = next.back();
      next.pop_back();
      for (const Joint& joint : scene_.joints) {
        if (joint.type != JointType::fixed) continue;
        const std::size_t side = joint.bodies[0] == name ? 0 : 1;
        const std::string& other = joint.bodies[1 - side];
        if (joint.bodies[side] != name || !is_rigid_piece(scene_, other)) continue;
        if (name == body_.name && !is_at(end, joint.at)) continue;
        if (bodies.insert(other).second) next.push_back(other);
      }
    }
    return is_only_at(end, bodies) ? bodies : std::set<std::string>();
  }

  bool is_only_at(int end, const std::set<std::string>& bodies) const {
    return std::ranges::all_of(scene_.joints, [&](const Joint& joint) {
      for (std::size_t side = 0; side < 2; ++side) {
        if (joint.bodies[side] != body_.name || !bodies.contains(joint.bodies[1 - side])) continue;
        return joint.type == JointType::fixed && is_at(end, joint.at);
      }
      return true;
    });
  }

  void add(int end, const std::set<std::string>& bodies) {
    std::vector<Place> places;
    for (const std::string& name : bodies) {
      add_mass(*find_named(scene_.bodies, name), places);
      fitted_[name] = end;
    }
    add_loads(bodies, places);
    for (const Joint& joint : scene_.joints) {
      for (std::size_t side = 0; side < 2; ++side) {
        const std::string& other = joint.bodies[1 - side];
        if (!bodies.contains(joint.bodies[side])) continue;
        if (bodies.contains(other) || other == body_.name) continue;
        const Point& point = side == 0 ? joint.at : second_point(joint);
        places.push_back({&point});
        built_.joints_.push_back({end, start_position(point), differentiated(end, places.back())});
      }
    }
    const auto value = [&](const Place& place) {
      return distance(beam_, end, place, context_.design);
    };
    const auto furthest = std::ranges::max_element(
        places, [&](const Place& one, const Place& other) { return value(one) < value(other); });
    if (furthest != places.end()) built_.reaches_[end] = differentiated(end, *furthest);
  }

  static void add_mass(const Body& body, std::vector<Place>& places) {
    const auto* rigid = std::get_if<RigidBody>(&body.shape);
    places.push_back(rigid ? Place{&rigid->at} : Place{nullptr, &body});
  }

  void add_loads(const std::set<std::string>& bodies, std::vector<Place>& places) const {
    for (const Load& load : scene_.loads) {
      if (!has_forces(load)) continue;
      visit_held_points(load, [&](const std::string& body, const Point& at, const PointKey&) {
        if (bodies.contains(body)) places.push_back({&at});
      });
    }
  }

  EndDistance differentiated(int end, const Place& place) const {
    EndDistance result{distance(beam_, end, place, context_.design), {}};
    std::set<int> variables;
    add_variables_of(beam_.from, variables);
    add_variables_of(beam_.to, variables);
    if (place.point) add_variables_of(*place.point, variables);
    if (place.beam) variables.merge(variables_of(*place.beam, scene_));
    for (const int variable : context_.differentiated(std::move(variables))) {
      const Dual dual = distance(beam_, end, place, context_.seeded(variable));
      result.slopes.emplace_back(variable, derivative_of(dual));
    }
    return result;
  }

  /// The scene whose beam is so long that it has all joints of its fittings.
  void put_together() {
    double after = built_.length_;
    for (const Joined& joint : built_.joints_) {
      built_.before_ = std::max(built_.before_, -joint.position);
      after = std::max(after, joint.position);
    }
    built_.total_ = built_.before_ + after;
    Scene scene;
    scene.bodies = scene_.bodies;
    auto& beam = std::get<BeamBody>(find_named(scene.bodies, body_.name)->shape);
    const Pose<double> pose = beam_pose(beam_, context_.start);
    for (int i = 0; i < 3; ++i) {
      beam.from[i] = pose.origin(i) - built_.before_ * pose.rotation(i, 0);
      beam.to[i] = pose.origin(i) + after * pose.rotation(i, 0);
    }
    for (Joint joint : scene_.joints) {
      for (std::string& body : joint.bodies) {
        if (is_of_fitting(body)) body = body_.name;
      }
      if (joint.bodies[0] != joint.bodies[1]) scene.joints.push_back(std::move(joint));
    }
    built_.as_one_ = JointHolds(scene, context_.start);
  }

  bool is_of_fitting(const std::string& body) const {
    const auto found = fitted_.find(body);
    return found != fitted_.end() && built_.is_fitted(found->second);
  }

  const Body& body_;
  const BeamBody& beam_;
  const Scene& scene_;
  const BuildContext& context_;
  std::unordered_map<std::string, int> fitted_;
  EndFittings built_;
};

std::optional<EndFittings> EndFittings::of(const Body& beam, const Scene& scene,
                                           const BuildContext& context) {
  return Builder(beam, scene, context).build();
}

}  // namespace pleuel
