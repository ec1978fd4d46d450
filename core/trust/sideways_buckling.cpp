#include "core/trust/sideways_buckling.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "core/beam/beam_place.hpp"
#include "core/model/scene_geometry.hpp"
#include "core/trust/beam_state.hpp"
#include "core/trust/lateral_stability.hpp"

namespace pleuel {

namespace {

/// The share of the critical load that is worth a word.
constexpr double near_critical = 0.75;
/// Directions within some 6° of a right angle count as normal, as in 0.1 = sin 6°.
constexpr double normal = 0.1;
/// Below this share of the loads of the simplest closed forms (squared moment, axial force) nothing
/// can buckle: a free end under a constant moment takes half of that of supported ends, a free
/// column a quarter.
constexpr double harmless_load = 0.05;

/// What joints hold of a body in space, as if its neighbours were rigid.
class Supports {
 public:
  Supports(const TrustedRun& run, const Body& body, const Beam<double>& beam, BendingPlane plane)
      : run_(run),
        body_(body),
        beam_(beam),
        design_(run.x.begin(), run.x.end()),
        axes_(body_pose(body, design_).rotation),
        lateral_(axes_.col(plane == BendingPlane::xy ? 2 : 1)),
        transverse_(axes_.col(plane == BendingPlane::xy ? 1 : 2)) {}

  std::vector<LateralSupport> find() const {
    std::vector<LateralSupport> supports(static_cast<std::size_t>(beam_.node_count()));
    for (const Joint& joint : run_.problem.scene.joints) {
      for (std::size_t side = 0; side < 2; ++side) {
        if (joint.bodies[side] != body_.name) continue;
        const Joint& at = joint;
        LateralSupport& support = supports[node_of(at, side)];
        const LateralSupport held = held_by(at, at.bodies[1 - side]);
        support.deflection = support.deflection || held.deflection;
        support.slope = support.slope || held.slope;
        support.twist = support.twist || held.twist;
      }
    }
    return supports;
  }

 private:
  std::size_t node_of(const Joint& joint, std::size_t side) const {
    const bool is_other_end = joint.type == JointType::distance && side == 1;
    const Eigen::Vector3d point = resolve_point(is_other_end ? joint.to : joint.at, design_);
    const double x = (point - body_pose(body_, design_).origin).dot(axes_.col(0));
    const double length = beam_.node_position(beam_.node_count() - 1);
    const double share = std::clamp(x / length, 0.0, 1.0);
    const BeamPlace place = find_place(beam_, share);
    return static_cast<std::size_t>(place.node());
  }

  /// A neighbour holds where it is held itself.
  bool is_held(const std::string& neighbour) const {
    if (neighbour == ground_name) return true;
    return std::any_of(
        run_.problem.scene.joints.begin(), run_.problem.scene.joints.end(),
        [&](const Joint& joint) {
          const bool is_its = joint.bodies[0] == neighbour || joint.bodies[1] == neighbour;
          return is_its && joint.bodies[0] != body_.name && joint.bodies[1] != body_.name;
        });
  }
  bool is_point(const std::string& neighbour) const {
    const auto& bodies = run_.problem.scene.bodies;
    return std::any_of(bodies.begin(), bodies.end(), [&](const Body& body) {
      return body.name == neighbour && std::holds_alternative<PointMass>(body.shape);
    });
  }

  LateralSupport held_by(const Joint& joint, const std::string& neighbour) const {
    LateralSupport held;
    if (!is_held(neighbour)) return held;
    const Eigen::Vector3d axis = to_vector(joint.axis).normalized();
    const Eigen::Vector3d second = to_vector(joint.second_axis).normalized();
    const bool is_lateral = std::abs(axis.dot(lateral_)) > 1.0 - normal;
    const auto turns_about = [&](const Eigen::Vector3d& direction) {
      return std::abs(axis.dot(direction)) > normal;
    };
    const bool slope_free = turns_about(transverse_), twist_free = turns_about(axes_.col(0));
    switch (joint.type) {
      case JointType::fixed:
        return {true, true, true};
      case JointType::prismatic:
        held = {!is_lateral, true, true};
        break;
      case JointType::revolute:
        held = {true, !slope_free, !twist_free};
        break;
      case JointType::cylindrical:
        held = {!is_lateral, !slope_free, !twist_free};
        break;
      case JointType::planar:
        held = {is_lateral, !slope_free, !twist_free};
        break;
      case JointType::universal:
        held = {true, !slope_free && std::abs(second.dot(transverse_)) <= normal,
                !twist_free && std::abs(second.dot(axes_.col(0))) <= normal};
        break;
      case JointType::spherical:
        held = {true, false, false};
        break;
      case JointType::point_on_line:
        held = {!is_lateral, false, false};
        break;
      case JointType::distance:
        break;
    }
    if (is_point(neighbour)) held.slope = held.twist = false;
    return held;
  }

  const TrustedRun& run_;
  const Body& body_;
  const Beam<double>& beam_;
  Design<double> design_;
  Eigen::Matrix3d axes_;
  Eigen::Vector3d lateral_, transverse_;
};

using Parts = std::vector<const BodyModel*>;

/// The elements of all parts of a beam in one.
Beam<double> whole_beam(const Parts& parts) {
  Beam<double> beam = parts.front()->beam;
  for (std::size_t i = 1; i < parts.size(); ++i) {
    const std::vector<BeamElement<double>>& more = parts[i]->beam.elements;
    beam.elements.insert(beam.elements.end(), more.begin(), more.end());
  }
  return beam;
}

/// The section forces of one beam over time.
class BeamHistory {
 public:
  BeamHistory(const Parts& parts, BendingPlane plane) : parts_(parts), plane_(plane) {}

  PlaneLoad at(const State& state) const {
    PlaneLoad load;
    for (const BodyModel* part : parts_) add(*part, state, load);
    return load;
  }

 private:
  void add(const BodyModel& part, const State& state, PlaneLoad& load) const {
    const Beam<double>& beam = part.beam;
    const Eigen::MatrixXd nodal = nodal_displacements(part, state);
    const bool is_xy = plane_ == BendingPlane::xy;
    for (int e = 0; e + 1 < beam.node_count(); ++e) {
      const BeamElement<double>& element = beam.elements[e];
      const auto end = [&](int node) {  // deflection and slope in the plane
        return is_xy ? std::array{nodal(1, node), nodal(5, node)}
                     : std::array{nodal(2, node), -nodal(4, node)};
      };
      const auto a = end(e), b = end(e + 1);
      const double inertia = is_xy ? element.section.inertia_z : element.section.inertia_y;
      const auto moment = [&](double xi) {
        const auto h = hermite(xi, element.length, 2);
        return element.young * inertia * (h[0] * a[0] + h[1] * a[1] + h[2] * b[0] + h[3] * b[1]);
      };
      load.axial.push_back(element.young * element.section.area * elongation_of(part, nodal, e) /
                           element.length);
      load.moment.push_back({moment(0.0), moment(1.0)});
    }
  }

  const Parts& parts_;
  BendingPlane plane_;
};

double largest_moment(const PlaneLoad& load) {
  double largest = 0.0;
  for (const auto& ends : load.moment) {
    largest = std::max({largest, std::abs(ends[0]), std::abs(ends[1])});
  }
  return largest;
}
double largest_press(const PlaneLoad& load) {
  double largest = 0.0;
  for (double axial : load.axial) largest = std::max(largest, -axial);
  return largest;
}

class SidewaysBuckling {
 public:
  SidewaysBuckling(const TrustedRun& run, const Body& body, Parts parts)
      : run_(run),
        body_(body),
        parts_(std::move(parts)),
        beam_(whole_beam(parts_)),
        is_planar_(frame().rotation == RotationCoordinates::angle),
        plane_(plane()) {
    length_ = beam_.node_position(beam_.node_count() - 1);
    lateral_ = twisting_ = std::numeric_limits<double>::infinity();
    bool is_equal = true;
    for (const BeamElement<double>& element : beam_.elements) {
      const SectionProperties<double>& s = element.section;
      const bool is_xy = plane_ == BendingPlane::xy;
      const double weak = is_xy ? s.inertia_y : s.inertia_z;
      const double bending = is_xy ? s.inertia_z : s.inertia_y;
      lateral_ = std::min(lateral_, element.young * weak);
      twisting_ = std::min(twisting_, element.shear * s.torsion);
      is_equal = is_equal && weak >= (1.0 - 1e-9) * bending;
      for (const StressPoint<double>& point : s.points) {
        depth_ = std::max(depth_, std::abs(is_xy ? point.y : point.z));
      }
    }
    moments_matter_ = !is_equal;
  }

  std::vector<Doubt> find() {
    find_worst();
    if (worst_ < harmless_load) return {};
    std::vector<LateralSupport> supports = Supports(run_, body_, beam_, plane_).find();
    double factor = factor_of(supports, load_);
    if (std::isnan(factor)) {  // nothing keeps it from turning about its axis
      supports.front().twist = true;
      factor = factor_of(supports, load_);
    }
    if (std::isnan(factor) || factor > 1.0 / near_critical) return {};
    PlaneLoad straight = load_;
    for (auto& ends : straight.moment) ends = {0.0, 0.0};
    const double as_column = factor_of(supports, straight);
    return {doubt(factor, as_column > 1.01 * factor)};
  }

 private:
  const BodyFrame& frame() const { return parts_.front()->frame; }

  /// Of the motion, or in space that of the stiffer axis.
  BendingPlane plane() const {
    if (is_planar_) {
      const Eigen::Vector3d out = frame().reference.transpose() * frame().axis;
      return std::abs(out.z()) > 0.5 ? BendingPlane::xy : BendingPlane::xz;
    }
    const SectionProperties<double>& s = beam_.elements.front().section;
    return s.inertia_z >= s.inertia_y ? BendingPlane::xy : BendingPlane::xz;
  }

  void find_worst() {
    const BeamHistory history(parts_, plane_);
    const double pi = std::numbers::pi;
    const double moment = pi * std::sqrt(lateral_ * twisting_) / length_;
    const double press = pi * pi * lateral_ / (length_ * length_);
    State state;
    for (Eigen::Index i = 0; i < run_.analysis.trajectory.time.size(); ++i) {
      run_.analysis.trajectory.states->load(static_cast<int>(i), state);
      PlaneLoad load = history.at(state);
      const double bent = moments_matter_ ? largest_moment(load) / moment : 0.0;
      const double share = bent * bent + largest_press(load) / press;
      if (share <= worst_) continue;
      worst_ = share;
      load_ = std::move(load);
      time_ = run_.analysis.trajectory.time(i);
    }
  }

  double factor_of(const std::vector<LateralSupport>& supports, const PlaneLoad& load) const {
    return lateral_load_factor(beam_, plane_, supports, load);
  }

  /// What restrained warping could add at most: flanges that hold all of the lateral stiffness, at
  /// the edges of the section.
  double warping() const {
    const double pi = std::numbers::pi;
    return std::sqrt(1.0 + pi * pi * lateral_ * depth_ * depth_ / (length_ * length_ * twisting_));
  }

  /// Serious where compression alone is too large. Where a bending moment takes part the numbers
  /// hold for a member that is held sideways, as the motion takes it to be.
  /// @param is_bent  whether the bending moment takes part
  Doubt doubt(double factor, bool is_bent) const {
    const double moment = largest_moment(load_), press = largest_press(load_);
    std::string what;
    if (is_bent) what = fmt::format("a bending moment of {:.3g} N m", moment);
    const double pi = std::numbers::pi;
    if (press > 1e-3 * pi * pi * lateral_ / (length_ * length_)) {
      what += fmt::format("{}a pressing force of {:.3g} N", is_bent ? " and " : "", press);
    }
    const bool is_beyond = factor * (is_bent ? warping() : 1.0) < 1.0;
    const char* unseen = is_planar_ || is_bent
                             ? "The equations of motion do not have this buckling."
                             : "In the motion a member that is exactly straight stays so.";
    return {fmt::format(
                "\"{}\" {} out of the plane in which it bends ({}) under {} at t = {:.4g} s: the "
                "critical load is {:.3g} times that. {}{}",
                body_.name, is_beyond ? "buckles" : "comes near to buckling",
                is_bent ? "lateral-torsional buckling" : "about its weak axis", what, time_, factor,
                unseen, is_beyond ? " Make it stiffer sideways or in torsion, or hold it." : ""),
            is_beyond && !is_bent};
  }

  const TrustedRun& run_;
  const Body& body_;
  Parts parts_;
  Beam<double> beam_;
  bool is_planar_;
  BendingPlane plane_;
  bool moments_matter_ = true;
  double length_ = 0.0, lateral_ = 0.0, twisting_ = 0.0, depth_ = 0.0;
  double worst_ = 0.0, time_ = 0.0;
  PlaneLoad load_;
};

}  // namespace

std::vector<Doubt> doubt_sideways_buckling(const TrustedRun& run) {
  std::vector<Doubt> doubts;
  for (const Body& body : run.problem.scene.bodies) {
    if (!std::holds_alternative<BeamBody>(body.shape)) continue;
    const Parts parts = run.analysis.model.parts(body.name);
    if (!parts.front()->is_elastic) continue;
    const std::vector<Doubt> found = SidewaysBuckling(run, body, parts).find();
    doubts.insert(doubts.end(), found.begin(), found.end());
  }
  return doubts;
}

}  // namespace pleuel
