#include "core/trust/sideways_buckling.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/response/lateral_buckling_signal.hpp"
#include "core/scene/joint_kind.hpp"
#include "core/trust/common_buckling.hpp"

namespace pleuel {

namespace {

/// The share of the critical load that is worth a word.
constexpr double near_critical = 0.75;
/// Below this share of the loads of the simplest closed forms (squared moment, axial force) nothing
/// can buckle: a free end under a constant moment takes half of that of supported ends, a free
/// column a quarter.
constexpr double harmless_load = 0.05;
/// A member is straight whose moments are less than its Euler load makes of this share of its length.
constexpr double straight_offset = 1e-6;

double largest_moment(const PlaneLoad& load) {
  return load.bottomRows<2>().cwiseAbs().maxCoeff();
}
double largest_press(const PlaneLoad& load) {
  return std::max(0.0, -load.topRows<2>().minCoeff());
}

BendingPlane other_plane(BendingPlane plane) {
  return plane == BendingPlane::xy ? BendingPlane::xz : BendingPlane::xy;
}

/// A member by its forces in one plane, buckling out of it, or in it by its axial force alone.
class SidewaysBuckling {
 public:
  enum class Way { out_of_plane, in_plane };

  SidewaysBuckling(const TrustedRun& run, const BodyModel& part, BendingPlane plane, Way way)
      : name_(part.name),
        is_planar_(part.frame.rotation == RotationCoordinates::angle),
        way_(way),
        plane_(way == Way::out_of_plane ? plane : other_plane(plane)),
        observed_(name_, run.analysis.model, plane),
        judged_(name_, run.analysis.model, plane_) {
    const Beam<double>& beam = judged_.beam();
    length_ = beam.node_position(beam.node_count() - 1);
    full_length_ = judged_.full_length();
    lateral_ = twisting_ = weakest_ = std::numeric_limits<double>::infinity();
    bool is_equal = true;
    for (const BeamElement<double>& element : beam.elements) {
      const SectionProperties<double>& s = element.section;
      const bool is_xy = plane_ == BendingPlane::xy;
      const double weak = is_xy ? s.inertia_y : s.inertia_z;
      const double bending = is_xy ? s.inertia_z : s.inertia_y;
      lateral_ = std::min(lateral_, element.young * weak);
      twisting_ = std::min(twisting_, element.shear * s.torsion);
      weakest_ = std::min({weakest_, element.young * weak, element.young * bending});
      shearing_ =
          std::max(shearing_, is_xy ? element.shear_compliance_z : element.shear_compliance_y);
      is_equal = is_equal && weak >= (1.0 - 1e-9) * bending;
      for (const StressPoint<double>& point : s.points) {
        depth_ = std::max(depth_, std::abs(is_xy ? point.y : point.z));
      }
    }
    moments_matter_ = way == Way::out_of_plane && !is_equal;
  }

  /// Looks at an instant: keeps that of the largest share, if it is worth a word; in its plane of
  /// those until the member bends.
  void see(const State& state, double time) {
    if (is_over_) return;
    PlaneLoad load = observed_.observe(state);
    pressed_ = std::max(pressed_, largest_press(load) / (euler_load() * weakest_ / lateral_));
    if (way_ == Way::in_plane) {
      is_over_ = largest_moment(load) > straight_offset * length_ * euler_load();
      load.bottomRows<2>().setZero();
    }
    if (is_over_ || most_share(load) <= share_) return;
    is_over_ = !judged_.buckling().is_held();
    if (is_over_) return;
    const double share = judged_.buckling().share(load, share_);
    if (share <= share_) return;
    share_ = share;
    load_ = load;
    time_ = time;
  }

  /// Whether it is pressed, in a mechanism that moves in a plane, enough to buckle with others: as
  /// part of a column as long as all elastic beams together.
  /// @param all  that length [m]
  bool is_pressed_in_plane(double all) const {
    const double share = full_length_ / all;
    return is_planar_ && way_ == Way::out_of_plane && pressed_ > harmless_load * share * share;
  }
  double full_length() const { return full_length_; }
  const std::string& name() const { return name_; }

  /// 0: nothing is worth a word.
  double share() const { return share_ > near_critical ? share_ : 0.0; }

  /// Whether the bending moment takes part.
  /// @pre share() > 0
  bool is_bent() {
    PlaneLoad pressed = load_;
    pressed.bottomRows<2>().setZero();
    return share_ > 1.01 * judged_.buckling().share(pressed);
  }
  bool is_planar() const { return is_planar_; }

  /// @pre share() > 0
  Doubt doubt() { return doubt(1.0 / share_, is_bent()); }

 private:
  /// No share is larger: 1/s of b² s² + p s = harmless_load.
  /// A rigid fitting bears more than the same length of the beam would.
  double most_share(const PlaneLoad& load) const {
    const double pi = std::numbers::pi, longer = full_length_ / length_;
    const double moment = pi * std::sqrt(lateral_ * twisting_) / full_length_;
    const double b = moments_matter_ ? largest_moment(load) / moment : 0.0;
    const double press = largest_press(load);
    const double p = press * (longer * longer / euler_load() + harmless_load * shearing_);
    return (p + std::sqrt(p * p + 4.0 * b * b * harmless_load)) / (2.0 * harmless_load);
  }

  /// Of two pins.
  double euler_load() const {
    const double pi = std::numbers::pi;
    return pi * pi * lateral_ / (length_ * length_);
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
    if (press > 1e-3 * euler_load()) {
      what += fmt::format("{}a pressing force of {:.3g} N", is_bent ? " and " : "", press);
    }
    const bool is_beyond = factor * (is_bent ? warping() : 1.0) < 1.0;
    const bool is_out_of_plane = way_ == Way::out_of_plane;
    const char* unseen = (is_planar_ && is_out_of_plane) || is_bent
                             ? "The equations of motion do not have this buckling."
                             : "In the motion a member that is exactly straight stays so.";
    const char* remedy = is_out_of_plane
                             ? " Make it stiffer sideways or in torsion, hold it, or limit a "
                               "response of the type \"lateral-buckling\"."
                             : " Make it stiffer, or hold it.";
    const std::string column =
        fmt::format("as a column, along local {}", plane_ == BendingPlane::xy ? "z" : "y");
    return {fmt::format(
                "\"{}\" {} {} ({}) under {} at t = {:.4g} s: the critical load is {:.3g} times "
                "that. {}{}",
                name_, is_beyond ? "buckles" : "comes near to buckling",
                is_out_of_plane ? "out of the plane in which it bends" : "in the plane of motion",
                is_bent ? "lateral-torsional buckling" : column, what, time_, factor, unseen,
                is_beyond ? remedy : ""),
            is_beyond && !is_bent};
  }

  std::string name_;
  bool is_planar_;
  Way way_;
  BendingPlane plane_;  ///< out of which it buckles
  LateralMember observed_, judged_;
  bool moments_matter_ = true;
  bool is_over_ = false;  ///< nothing holds it, or it bends in its plane, as the motion shows
  double length_ = 0.0, full_length_ = 0.0, lateral_ = 0.0, twisting_ = 0.0;
  double weakest_ = 0.0;  ///< smallest bending stiffness, of both planes [N m²]
  double shearing_ = 0.0, depth_ = 0.0;
  double share_ = near_critical, time_ = 0.0;
  double pressed_ = 0.0;  ///< largest press over the smallest Euler load of two pins
  PlaneLoad load_;
};

/// The ways in which a member may buckle.
std::vector<SidewaysBuckling> ways_of(const TrustedRun& run, const BodyModel& part) {
  using Way = SidewaysBuckling::Way;
  const std::vector<BendingPlane> planes = bending_planes(part);
  std::vector<SidewaysBuckling> ways;
  for (const BendingPlane plane : planes) ways.emplace_back(run, part, plane, Way::out_of_plane);
  // With springs, which hold members or give way under them, see unstable_members.hpp.
  const bool has_springs = !run.analysis.model.mechanism.springs.empty();
  if (planes.size() == 1 && !has_springs) {
    ways.emplace_back(run, part, planes.front(), Way::in_plane);
  }
  return ways;
}

/// Whether the mechanism has another elastic body, which counts as rigid here, but gives way with it.
bool has_elastic_neighbour(const Model& model, const std::string& name) {
  return std::any_of(model.bodies.begin(), model.bodies.end(), [&](const BodyModel& body) {
    return body.name != name && body.elastic_size() > 0;
  });
}

/// Whether bodies may lean out of the plane of motion, or are loaded by springs: what presses a
/// member then changes its direction with it.
bool may_lean(const Scene& scene) {
  const bool has_springs = std::any_of(
      scene.loads.begin(), scene.loads.end(),
      [](const auto& load) { return std::holds_alternative<SpringDamper>(load.element); });
  return has_springs ||
         std::any_of(scene.joints.begin(), scene.joints.end(), [](const Joint& joint) {
           const JointKind& kind = kind_of(joint.type);
           return kind.turns >= JointTurns::about_both_axes ||
                  kind.slides == JointSlides::at_distance;
         });
}

}  // namespace

std::vector<Doubt> doubt_sideways_buckling(const TrustedRun& run) {
  std::vector<std::vector<SidewaysBuckling>> members;
  for (const Body& body : run.problem.scene.bodies) {
    if (!std::holds_alternative<BeamBody>(body.shape)) continue;
    const BodyModel& part = *run.analysis.model.parts(body.name).front();
    if (part.is_elastic) members.push_back(ways_of(run, part));
  }
  if (members.empty()) return {};
  State state;
  for (Eigen::Index i = 0; i < run.analysis.trajectory.time.size(); ++i) {
    run.analysis.trajectory.states->load(static_cast<int>(i), state);
    for (auto& ways : members) {
      for (SidewaysBuckling& way : ways) way.see(state, run.analysis.trajectory.time(i));
    }
  }
  double all = 0.0;
  for (const auto& ways : members) all += ways.front().full_length();
  const bool is_leaning = may_lean(run.problem.scene);
  const bool has_springs = !run.analysis.model.mechanism.springs.empty();
  std::vector<Doubt> doubts;
  std::vector<std::string> pressed;
  for (auto& ways : members) {
    auto worst = std::max_element(ways.begin(), ways.end(), [](const auto& one, const auto& other) {
      return one.share() < other.share();
    });
    if (worst->share() > 0.0) {
      const bool is_judged_with_springs = has_springs && !worst->is_planar() && !worst->is_bent();
      if (!is_judged_with_springs) doubts.push_back(worst->doubt());
    }
    const std::string& name = ways.front().name();
    if (ways.front().is_pressed_in_plane(all) &&
        (is_leaning || has_elastic_neighbour(run.analysis.model, name))) {
      pressed.push_back(name);
    }
  }
  const bool is_refused = std::any_of(doubts.begin(), doubts.end(),
                                      [](const Doubt& doubt) { return doubt.is_serious; });
  if (pressed.empty() || is_refused) return doubts;
  for (Doubt& doubt : doubt_common_buckling(run, pressed)) doubts.push_back(std::move(doubt));
  return doubts;
}

}  // namespace pleuel
