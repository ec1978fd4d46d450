#include "core/trust/sideways_buckling.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "core/response/lateral_buckling_signal.hpp"

namespace pleuel {

namespace {

/// The share of the critical load that is worth a word.
constexpr double near_critical = 0.75;
/// Below this share of the loads of the simplest closed forms (squared moment, axial force) nothing
/// can buckle: a free end under a constant moment takes half of that of supported ends, a free
/// column a quarter.
constexpr double harmless_load = 0.05;

double largest_moment(const PlaneLoad& load) {
  return load.bottomRows<2>().cwiseAbs().maxCoeff();
}
double largest_press(const PlaneLoad& load) {
  return std::max(0.0, -load.topRows<2>().minCoeff());
}

class SidewaysBuckling {
 public:
  SidewaysBuckling(const TrustedRun& run, const BodyModel& part)
      : run_(run),
        name_(part.name),
        is_planar_(part.frame.rotation == RotationCoordinates::angle),
        plane_(plane_of(part)),
        member_(name_, run.analysis.model, plane_) {
    const Beam<double>& beam = member_.beam();
    length_ = beam.node_position(beam.node_count() - 1);
    lateral_ = twisting_ = std::numeric_limits<double>::infinity();
    bool is_equal = true;
    for (const BeamElement<double>& element : beam.elements) {
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
    LateralBuckling& buckling = member_.buckling();
    if (!buckling.is_held()) return {};
    find_worst();
    if (worst_ < harmless_load) return {};
    const double share = buckling.share(load_);
    if (share < near_critical) return {};
    PlaneLoad straight = load_;
    straight.bottomRows<2>().setZero();
    return {doubt(1.0 / share, share > 1.01 * buckling.share(straight))};
  }

 private:
  /// Of the motion, or in space that of the stiffer axis.
  static BendingPlane plane_of(const BodyModel& part) {
    const std::vector<BendingPlane> planes = bending_planes(part);
    if (planes.size() == 1) return planes.front();
    const SectionProperties<double>& s = part.beam.elements.front().section;
    return s.inertia_z >= s.inertia_y ? BendingPlane::xy : BendingPlane::xz;
  }

  void find_worst() {
    const double pi = std::numbers::pi;
    const double moment = pi * std::sqrt(lateral_ * twisting_) / length_;
    const double press = pi * pi * lateral_ / (length_ * length_);
    State state;
    for (Eigen::Index i = 0; i < run_.analysis.trajectory.time.size(); ++i) {
      run_.analysis.trajectory.states->load(static_cast<int>(i), state);
      const PlaneLoad& load = member_.observe(state);
      const double bent = moments_matter_ ? largest_moment(load) / moment : 0.0;
      const double share = bent * bent + largest_press(load) / press;
      if (share <= worst_) continue;
      worst_ = share;
      load_ = load;
      time_ = run_.analysis.trajectory.time(i);
    }
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
                name_, is_beyond ? "buckles" : "comes near to buckling",
                is_bent ? "lateral-torsional buckling" : "about its weak axis", what, time_, factor,
                unseen, is_beyond ? " Make it stiffer sideways or in torsion, or hold it." : ""),
            is_beyond && !is_bent};
  }

  const TrustedRun& run_;
  std::string name_;
  bool is_planar_;
  BendingPlane plane_;
  LateralMember member_;
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
    const BodyModel& part = *run.analysis.model.parts(body.name).front();
    if (!part.is_elastic) continue;
    const std::vector<Doubt> found = SidewaysBuckling(run, part).find();
    doubts.insert(doubts.end(), found.begin(), found.end());
  }
  return doubts;
}

}  // namespace pleuel
