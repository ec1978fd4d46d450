#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/linear/elastic_stability.hpp"
#include "core/response/lateral_buckling_signal.hpp"
#include "core/trust/check_list.hpp"

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

/// A member by its forces in one plane, buckling out of it.
class SidewaysBuckling {
 public:
  /// @param is_alone  without what the file says to hold the beam
  SidewaysBuckling(const TrustedRun& run, const BodyModel& part, BendingPlane plane, bool is_alone)
      : name_(part.name),
        plane_(plane),
        is_alone_(is_alone),
        member_(name_, run.analysis.model, plane, !is_alone) {
    const Beam<double>& beam = member_.beam();
    length_ = beam.node_position(beam.node_count() - 1);
    full_length_ = member_.full_length();
    lateral_ = twisting_ = std::numeric_limits<double>::infinity();
    bool is_equal = true;
    for (const BeamElement<double>& element : beam.elements) {
      const SectionProperties<double>& s = element.section;
      const bool is_xy = plane_ == BendingPlane::xy;
      const double weak = is_xy ? s.inertia_y : s.inertia_z;
      const double bending = is_xy ? s.inertia_z : s.inertia_y;
      lateral_ = std::min(lateral_, element.young * weak);
      twisting_ = std::min(twisting_, element.shear * s.torsion);
      shearing_ =
          std::max(shearing_, is_xy ? element.shear_compliance_z : element.shear_compliance_y);
      is_equal = is_equal && weak >= (1.0 - 1e-9) * bending;
      for (const StressPoint<double>& point : s.points) {
        depth_ = std::max(depth_, std::abs(is_xy ? point.y : point.z));
      }
    }
    moments_matter_ = !is_equal;
  }

  /// Looks at an instant: keeps that of the largest share, if it is worth a word. Shares are sublinear in
  /// the loads, as largest eigenvalues are: share(a) ≤ share(b) + share(a − b), so that those near one
  /// that is known to be small need no look.
  void see(const State& state, double time) {
    constexpr double small = 0.5;  // of the share that counts
    if (!moments_matter_ || is_free_) return;
    const PlaneLoad& load = member_.observe(state);
    if (most_share(load) <= share_ || is_near_known(load)) return;
    is_free_ = !member_.buckling().is_held();
    if (is_free_) return;
    const double share = member_.buckling().share(load, small * share_);
    known_load_ = load;
    known_share_ = std::max(share, small * share_);
    if (share <= share_) return;
    share_ = share;
    load_ = load;
    time_ = time;
  }

  /// 0: nothing is worth a word, or the axial force does it alone (check_list.hpp).
  double share() { return share_ > near_critical && is_bent() ? share_ : 0.0; }

  /// @pre share() > 0
  Finding finding() const { return finding(1.0 / share_); }

 private:
  /// Whether the bending moment takes part.
  bool is_bent() {
    PlaneLoad pressed = load_;
    pressed.bottomRows<2>().setZero();
    return share_ > 1.01 * member_.buckling().share(pressed);
  }

  bool is_near_known(const PlaneLoad& load) const {
    if (known_load_.cols() == 0) return false;
    const PlaneLoad change = load - known_load_;
    return known_share_ + most_share(change) <= share_;
  }

  /// No share is larger: 1/s of b² s² + p s = harmless_load.
  /// A rigid fitting bears more than the same length of the beam would.
  double most_share(const PlaneLoad& load) const {
    const double pi = std::numbers::pi, longer = full_length_ / length_;
    const double moment = pi * std::sqrt(lateral_ * twisting_) / full_length_;
    const double b = largest_moment(load) / moment;
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

  Finding finding(double factor) const {
    const double moment = largest_moment(load_), press = largest_press(load_);
    std::string what = fmt::format("a bending moment of {:.3g} N m", moment);
    if (press > 1e-3 * euler_load())
      what += fmt::format(" and a pressing force of {:.3g} N", press);
    const bool is_beyond = factor * warping() < 1.0;
    std::string text = fmt::format(
        "\"{}\" {} out of the plane in which it bends (lateral-torsional buckling) under {} at t = "
        "{:.4g} s: the critical load is {:.3g} times that.",
        name_, is_beyond ? "buckles" : "comes near to buckling", what, time_, factor);
    if (is_alone_) return {fmt::format("Without what holds it (\"held\") {}", text), false};
    text += " The equations of motion do not have this buckling.";
    if (is_beyond) {
      text +=
          " Make it stiffer sideways or in torsion, limit a response of the type "
          "\"lateral-buckling\", or say where it is \"held\".";
    }
    return {text, is_beyond};
  }

  std::string name_;
  BendingPlane plane_;  ///< out of which it buckles
  bool is_alone_;
  LateralMember member_;
  bool moments_matter_ = true;
  bool is_free_ = false;  ///< nothing holds it
  double length_ = 0.0, full_length_ = 0.0, lateral_ = 0.0, twisting_ = 0.0;
  double shearing_ = 0.0, depth_ = 0.0;
  double share_ = near_critical, time_ = 0.0;
  PlaneLoad load_;
  PlaneLoad known_load_;  ///< the last that was looked at
  double known_share_ = 0.0;
};

/// In each of the planes in which it bends.
std::vector<SidewaysBuckling> planes_of(const TrustedRun& run, const BodyModel& part,
                                        bool is_alone) {
  std::vector<SidewaysBuckling> planes;
  for (const BendingPlane plane : bending_planes(part)) {
    planes.emplace_back(run, part, plane, is_alone);
  }
  return planes;
}

/// The elastic beams of a scene; one that the file says to be held a second time, alone.
std::vector<std::vector<SidewaysBuckling>> members_of(const TrustedRun& run) {
  std::vector<std::vector<SidewaysBuckling>> members;
  for (const Body& body : run.problem.scene.bodies) {
    const auto* beam = std::get_if<BeamBody>(&body.shape);
    if (beam == nullptr) continue;
    const BodyModel& part = *run.analysis.model.parts(body.name).front();
    if (!part.is_elastic) continue;
    members.push_back(planes_of(run, part, false));
    if (beam->held) members.push_back(planes_of(run, part, true));
  }
  return members;
}

}  // namespace

std::vector<Finding> check_sideways_buckling(const TrustedRun& run) {
  std::vector<std::vector<SidewaysBuckling>> members = members_of(run);
  if (members.empty()) return {};
  for (Eigen::Index i = 0; i < run.analysis.trajectory.time.size(); ++i) {
    const State state = run.analysis.trajectory.state_at(static_cast<int>(i));
    for (auto& planes : members) {
      for (SidewaysBuckling& plane : planes) plane.see(state, run.analysis.trajectory.time(i));
    }
  }
  std::vector<Finding> findings;
  for (auto& planes : members) {
    double worst = 0.0;
    const SidewaysBuckling* told = nullptr;
    for (SidewaysBuckling& plane : planes) {
      if (plane.share() <= worst) continue;
      worst = plane.share();
      told = &plane;
    }
    if (told != nullptr) findings.push_back(told->finding());
  }
  return findings;
}

namespace {

/// The model without weight and loads.
Model unloaded_model(const ProblemFile& problem, const Eigen::VectorXd& x,
                     EffectChoice spatial_motion) {
  Scene scene = problem.scene;
  scene.gravity = {0.0, 0.0, 0.0};
  scene.loads.clear();
  EffectSettings effects = problem.effects;
  effects.spatial_motion = spatial_motion;
  const Eigen::VectorXd start = start_design(problem);
  return build_model(scene, effects, {start.begin(), start.end()}, {x.begin(), x.end()},
                     std::nullopt);
}

/// By what factor the loads of an instant buckle a mechanism, by linear buckling
/// (elastic_stability.hpp): its stiffness against that of the same position without deformation,
/// motion, weight and loads. In the coordinates of the motion: in a plane, of buckling in it. Drives
/// hold.
class LoadFactor {
 public:
  explicit LoadFactor(const TrustedRun& run) : analysis_(run.analysis) {
    const Mechanism& mechanism = analysis_.model.mechanism;
    const int coordinates = mechanism.system->coordinates(),
              multipliers = mechanism.system->multipliers();
    if (!mechanism.springs.empty() || coordinates > most_judged_coordinates) return;
    // What moves in space because of its loads may move in a plane without.
    for (const EffectChoice choice : {run.problem.effects.spatial_motion, EffectChoice::on}) {
      Model model = unloaded_model(run.problem, run.x, choice);
      const System& system = *model.mechanism.system;
      if (system.coordinates() != coordinates || system.multipliers() != multipliers) continue;
      free_ = std::move(model);
      return;
    }
  }

  /// Whether it can be told: not of many coordinates, nor of mechanisms with springs, which loads
  /// turn at once.
  bool is_known() const { return free_.has_value(); }

  /// Infinite where nothing buckles, as without geometric stiffening; not a number where motions
  /// of bodies are held by what is no joint.
  double at(int instant) const {
    const Mechanism& mechanism = analysis_.model.mechanism;
    const State loaded = analysis_.trajectory.state_at(instant);
    const State unloaded = without_forces(mechanism, loaded);
    return buckling_load_factor({free_->mechanism, unloaded}, {mechanism, loaded}, 1.0);
  }

 private:
  const Analysis& analysis_;
  std::optional<Model> free_;  ///< without weight and loads
};

/// When a history is largest, within the window of its response.
int instant_of_peak(const Analysis& analysis, std::size_t response) {
  const StepRange range = analysis.responses[response].steps(analysis.trajectory.time);
  Eigen::Index peak = 0;
  analysis.histories[response].row(0).segment(range.first, range.steps()).maxCoeff(&peak);
  return range.first + static_cast<int>(peak);
}

/// The smallest upper limit on a response, or one half.
double largest_allowed(const ProblemFile& problem, const std::string& response) {
  std::optional<double> allowed;
  for (const ConstraintSettings& limit : problem.constraints) {
    if (limit.response != response || !limit.upper) continue;
    allowed = std::min(allowed.value_or(*limit.upper), *limit.upper);
  }
  return allowed.value_or(0.5);
}

}  // namespace

std::vector<Finding> check_promised_buckling(const TrustedRun& run) {
  constexpr double notable = 1.1;
  const auto& responses = run.problem.responses;
  const bool is_asked = std::ranges::any_of(
      responses, [](const ResponseSettings& one) { return one.is<BucklingResponse>(); });
  if (!is_asked) return {};
  const LoadFactor load_factor(run);
  if (!load_factor.is_known()) return {};
  std::vector<Finding> findings;
  for (std::size_t i = 0; i < responses.size(); ++i) {
    const ResponseSettings& response = responses[i];
    const auto* column = response.as<BucklingResponse>();
    if (column == nullptr) continue;
    const int peak = instant_of_peak(run.analysis, i);
    const double promised = run.analysis.histories[i](0, peak);
    const double factor = load_factor.at(peak);
    const double allowed = largest_allowed(run.problem, response.name);
    if (!(factor > 0.0) || 1.0 / factor < std::max(allowed, notable * promised)) continue;
    findings.push_back(
        {fmt::format(
             "\"{0}\" takes \"{1}\" by itself, pinned at both ends: it would buckle at "
             "{2:.3g} times what presses it at t = {3:.4g} s. Together with the bodies that "
             "it is connected to, something buckles at {4:.3g} times the loads of that "
             "instant. For {5:.3g} times limit \"{0}\" to some {6:.2g}.",
             response.name, column->body, 1.0 / promised, run.analysis.trajectory.time(peak),
             factor, 1.0 / allowed, promised * factor * allowed),
         false,
         {response.name}});
  }
  return findings;
}

}  // namespace pleuel
