#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "core/base/diameter.hpp"
#include "core/base/eager_matrices.hpp"
#include "core/base/find_named.hpp"
#include "core/model/scene_geometry.hpp"
#include "core/scene/acting_laws.hpp"
#include "core/scene/held_points.hpp"
#include "core/scene/joint_kind.hpp"
#include "core/scene/time_breaks.hpp"
#include "core/trust/check_list.hpp"

namespace pleuel {

namespace {

constexpr double far_away = 100.0;       // of the size of the rest
constexpr double far_beyond = 100.0;     // of the simulated time
constexpr double most_slender = 5000.0;  // lengths over depths; wires included
// Radii of gyration and lengths of springs, of the mechanism's size.
constexpr double largest_length = 10.0;
// From foams to osmium, from rubber to what is meant as rigid, from the moon's third to Jupiter's
// tenfold.
constexpr double least_density = 10.0, most_density = 25e3;  // [kg/m³]
constexpr double least_young = 1e6,
                 most_young = 1e18;  // [Pa]; stiff beyond reason may be meant as rigid
// What is denser than ceramics is stiffer than plastics (Ashby, Materials Selection in Mechanical
// Design, 2011, ch. 3).
constexpr double dense = 5000.0, least_young_of_dense = 1e9;  // [kg/m³], [Pa]
// Faster than spindles turn, with rims faster than trains.
constexpr double most_turn = 1000.0, most_rim_speed = 50.0;  // [rad/s], [m/s]
constexpr double least_gravity = 0.5, most_gravity = 250.0;  // [m/s²]

struct Place {
  std::string pointer;
  Eigen::Vector3d position;
};

double distance_to(const Eigen::Vector3d& point, const std::vector<Eigen::Vector3d>& others) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& other : others) least = std::min(least, (point - other).norm());
  return least;
}

class Proportions {
 public:
  Proportions(const ProblemFile& problem, const Eigen::VectorXd& x)
      : scene_(problem.scene),
        end_time_(problem.simulation.end_time),
        design_(x.begin(), x.end()) {}

  std::vector<Finding> find() {
    collect_places();
    check_distances();
    for (const Body& body : scene_.bodies) {
      if (const auto* beam = std::get_if<BeamBody>(&body.shape)) check_beam(body.name, *beam);
      if (const auto* rigid = std::get_if<RigidBody>(&body.shape)) check_rigid(body.name, *rigid);
    }
    for (const Material& material : scene_.materials) check_material(material);
    for (const Joint& joint : scene_.joints) check_speed(joint);
    for (const Load& load : scene_.loads) {
      if (const auto* spring = std::get_if<SpringDamper>(&load.element)) {
        check_spring(load.name, *spring);
      }
    }
    for (const ActingLaw& law : acting_laws(scene_)) {
      check_duration(law);
      if (law.is_motion() && law.is_displacement) check_way(law);
    }
    check_gravity();
    return std::move(findings_);
  }

 private:
  void add(const std::string& text) {
    findings_.push_back({text + ". Is a unit missing, or another one meant?"});
  }

  // Where things are.

  void place(const std::string& pointer, const Point& point) {
    places_.push_back({pointer, resolve_point(point, design_)});
  }

  void collect_places() {
    for (const Body& body : scene_.bodies) {
      const std::string at = "/scene/bodies/" + body.name;
      if (const auto* imported = std::get_if<ImportedBody>(&body.shape)) {
        const Pose<double> pose = beam_pose(*imported, design_);
        for (const BodyPlace& one : imported->file->constants.places) {
          places_.push_back({at, pose.origin + pose.rotation * one.position});
        }
      } else {
        visit_body_points(body, [&](const Point& point, const PointKey& key) {
          place(fmt::format("{}/{}", at, key.key), point);
        });
      }
    }
    for (const Joint& joint : scene_.joints) place_held("/scene/joints/", joint);
    for (const Load& load : scene_.loads) {
      if (has_forces(load)) place_held("/scene/loads/", load);
    }
  }

  /// @param list  in which the joint or load stands
  template <class Holder>
  void place_held(const std::string& list, const Holder& holder) {
    visit_held_places(holder, [&](const Point& at, const PointKey& key) {
      place(list + holder.name + "/" + key.key, at);
    });
  }

  /// A point, or few at one place or near each other, far from the rest. Where many are far, the
  /// rest may be a small crank.
  void check_distances() {
    std::set<std::size_t> named;
    for (const std::size_t i : suspects()) {
      if (named.contains(i)) continue;
      const auto [near, rest] = split(i);
      if (near.size() > most_far_away() || rest.empty()) continue;
      std::vector<Eigen::Vector3d> others;
      for (const std::size_t k : rest) others.push_back(places_[k].position);
      const double size = diameter(others);
      const double distance = distance_to(places_[i].position, others);
      // Points that are meant to be one, a little apart, are nothing that another one is far from.
      if (size <= deepest_section() || distance <= far_away * size) continue;
      named.insert(near.begin(), near.end());
      add(
          fmt::format("{} is {:.3g} m away from all other points of the mechanism, which lie "
                      "within {:.3g} m of each other",
                      places_[i].pointer, distance, size));
    }
  }

  /// So many points may be far from the rest.
  std::size_t most_far_away() const { return std::max<std::size_t>(2, places_.size() / 3); }

  /// The points that may be far away from all others. If some are, the others are more than half of
  /// all, so that the median m of each coordinate lies in their box: they are within √3 of their
  /// size from m, and the far ones more than 98 times their size.
  std::vector<std::size_t> suspects() const {
    std::vector<std::size_t> all(places_.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    if (2 * most_far_away() >= places_.size()) return all;
    const Eigen::Vector3d middle = median();
    std::vector<double> distances;
    for (const Place& place : places_) distances.push_back((place.position - middle).norm());
    std::vector<double> sorted = distances;
    const auto last = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() - 1) -
                      static_cast<std::ptrdiff_t>(most_far_away());
    std::nth_element(sorted.begin(), last, sorted.end());
    std::erase_if(all, [&](std::size_t i) { return distances[i] < 0.5 * far_away * *last; });
    return all;
  }

  Eigen::Vector3d median() const {
    Eigen::Vector3d middle;
    std::vector<double> values(places_.size());
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      for (std::size_t i = 0; i < values.size(); ++i) values[i] = places_[i].position(axis);
      const auto half = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
      std::nth_element(values.begin(), half, values.end());
      middle(axis) = *half;
    }
    return middle;
  }

  /// The points that lie, as seen from all others, where point i is; and the others.
  std::pair<std::vector<std::size_t>, std::vector<std::size_t>> split(std::size_t i) const {
    std::vector<std::pair<double, std::size_t>> by_distance;
    for (std::size_t k = 0; k < places_.size(); ++k) {
      by_distance.emplace_back((places_[k].position - places_[i].position).norm(), k);
    }
    std::ranges::sort(by_distance);
    const double farthest = by_distance.back().first;
    std::pair<std::vector<std::size_t>, std::vector<std::size_t>> parts;
    for (const auto& [distance, k] : by_distance) {
      (distance * 2.0 < farthest ? parts.first : parts.second).push_back(k);
    }
    return parts;
  }

  double mechanism_size() {
    if (size_) return *size_;
    std::vector<Eigen::Vector3d> points;
    for (const Place& place : places_) points.push_back(place.position);
    size_ = diameter(points);
    return *size_;
  }

  // What bodies are.

  void check_beam(const std::string& name, const BeamBody& beam) {
    const double length =
        (resolve_point(beam.to, design_) - resolve_point(beam.from, design_)).norm();
    double most = 0.0, least = std::numeric_limits<double>::infinity();
    for (const Segment& segment : beam.segments) {
      const double depth = depth_of(resolve_section(segment.section, design_));
      most = std::max(most, depth);
      least = std::min(least, depth);
    }
    const std::string at = "/scene/bodies/" + name;
    if (most > length) {
      add(fmt::format("{}/section is {:.3g} m deep, more than the beam is long ({:.3g} m)", at,
                      most, length));
    } else if (length > most_slender * least) {
      add(
          fmt::format("{} is {:.3g} m long, {:.0f} times as much as its section is deep "
                      "({:.3g} m)",
                      at, length, length / least, least));
    }
  }

  double deepest_section() const {
    double deepest = 0.0;
    for (const Body& body : scene_.bodies) {
      const auto* beam = std::get_if<BeamBody>(&body.shape);
      if (!beam) continue;
      for (const Segment& segment : beam->segments) {
        deepest = std::max(deepest, depth_of(resolve_section(segment.section, design_)));
      }
    }
    return deepest;
  }

  /// √(12 I/A) about the stiffer axis: of a rectangle its larger side.
  static double depth_of(const SectionProperties<double>& section) {
    return std::sqrt(12.0 * std::max(section.inertia_y, section.inertia_z) / section.area);
  }

  void check_rigid(const std::string& name, const RigidBody& rigid) {
    double inertia = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      inertia = std::max(inertia, resolve(rigid.inertia[i], design_));
    }
    const double radius = std::sqrt(inertia / resolve(rigid.mass, design_));
    const double size = mechanism_size();
    if (size == 0.0 || !(radius > largest_length * size)) return;
    add(
        fmt::format("/scene/bodies/{}/inertia is that of a body of {:.3g} m (radius of gyration), "
                    "in a mechanism of {:.3g} m",
                    name, radius, size));
  }

  void check_material(const Material& material) {
    const bool is_used = std::ranges::any_of(scene_.bodies, [&](const Body& body) {
      const auto* beam = std::get_if<BeamBody>(&body.shape);
      return beam && beam->material == material.name;
    });
    if (!is_used) return;
    const std::string at = "/scene/materials/" + material.name;
    const double density = resolve(material.density, design_);
    const double young = resolve(material.young, design_);
    if (density < least_density || density > most_density) {
      add(fmt::format("{}/density is {:.4g} kg/m³, which no solid has (steel: 7850)", at, density));
    }
    if (young < least_young || young > most_young) {
      add(fmt::format("{}/young is {:.4g} Pa, which no solid has (steel: 2.1e11)", at, young));
    } else if (density > dense && young < least_young_of_dense) {
      add(fmt::format("{}/young is {:.4g} Pa, which no solid of {:.4g} kg/m³ has (steel: 2.1e11)",
                      at, young, density));
    }
  }

  /// A speed of a drive that is meant to be in rpm.
  void check_speed(const Joint& joint) {
    if (!is_driven(joint, DrivenCoordinate::angle)) return;
    const auto* steady = std::get_if<ConstantSpeedDrive>(&joint.drive->motion);
    const auto* ramp = std::get_if<RampToSpeedDrive>(&joint.drive->motion);
    if (steady == nullptr && ramp == nullptr) return;
    const double speed = std::abs(resolve(steady ? steady->speed : ramp->speed, design_));
    const double rim = speed * reach_of(joint.bodies[1]);
    if (speed <= most_turn || rim <= most_rim_speed) return;
    add(fmt::format(
        "/scene/joints/{}/drive/speed is {:.4g} rad/s ({:.5g} rpm), at which \"{}\" moves "
        "at {:.3g} m/s",
        joint.name, speed, speed * 30.0 / std::numbers::pi, joint.bodies[1], rim));
  }

  /// Of a beam its length, else the size of the mechanism.
  double reach_of(const std::string& name) {
    const Body* body = find_named(scene_.bodies, name);
    const auto* beam = body ? std::get_if<BeamBody>(&body->shape) : nullptr;
    if (beam == nullptr) return mechanism_size();
    return (resolve_point(beam->to, design_) - resolve_point(beam->from, design_)).norm();
  }

  void check_spring(const std::string& name, const SpringDamper& spring) {
    if (!spring.free_length) return;
    const double length = resolve(*spring.free_length, design_), size = mechanism_size();
    if (size == 0.0 || length <= largest_length * size) return;
    add(fmt::format("/scene/loads/{}/free_length is {:.3g} m, in a mechanism of {:.3g} m", name,
                    length, size));
  }

  /// When a law has done what it is for; 0: it goes on for ever, or nobody knows.
  double end_of(const TimeFunction& function) const {
    if (const auto* start = std::get_if<RampToSpeedDrive>(&function)) {
      return resolve(start->ramp, design_);
    }
    const auto* table = std::get_if<TableFunction>(&function);
    const bool is_known = std::holds_alternative<RampFunction>(function) ||
                          std::holds_alternative<HalfSineFunction>(function) ||
                          (table != nullptr && table->repetition == Repetition::none);
    const std::vector<double> times =
        is_known ? sharp_times(function, end_time_) : std::vector<double>();
    return times.empty() ? 0.0 : times.back();
  }

  void check_duration(const ActingLaw& law) {
    const double end = end_of(law.function);
    if (end <= far_beyond * end_time_) return;
    add(fmt::format("{} goes on until t = {:.4g} s, of which {:.3g} s are simulated", law.pointer(),
                    end, end_time_));
  }

  /// Of a drive or a target that slides.
  void check_way(const ActingLaw& law) {
    constexpr int samples = 64;
    const TimeLaw<double> motion = resolve_time_law(law.function, design_, LawOf::motion);
    double way = 0.0;
    for (int i = 1; i <= samples; ++i) {
      way =
          std::max(way, std::abs(motion.at(end_time_ * i / samples).value - motion.at(0.0).value));
    }
    const double size = mechanism_size();
    if (size == 0.0 || way <= far_away * size) return;
    add(fmt::format("{} goes {:.3g} m far, in a mechanism of {:.3g} m", law.pointer(), way, size));
  }

  void check_gravity() {
    const double gravity = resolve_point(scene_.gravity, design_).norm();
    if (gravity == 0.0 || (gravity >= least_gravity && gravity <= most_gravity)) return;
    add(fmt::format("/scene/gravity is {:.4g} m/s² (on the earth: 9.81)", gravity));
  }

  const Scene& scene_;
  double end_time_;
  Design<double> design_;
  std::vector<Place> places_;
  std::optional<double> size_;  ///< of the mechanism, once it is asked for
  std::vector<Finding> findings_;
};

}  // namespace

std::vector<Finding> check_proportions(const TrustedRun& run) {
  return check_proportions_before(run.problem, run.x);
}

std::vector<Finding> check_proportions_before(const ProblemFile& problem,
                                              const Eigen::VectorXd& x) {
  return Proportions(problem, x).find();
}

}  // namespace pleuel
