#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/response/lateral_buckling_signal.hpp"
#include "core/scene/response_parts.hpp"
#include "core/trust/check_list.hpp"

namespace pleuel {

namespace {

/// Lengths of an element over √(EI/N): below, runs with other elements tell.
constexpr double long_element = 3.0;
/// Of the largest stress of axial force and bending: what may be missed of it without a word.
constexpr double small_stress_share = 0.05;
/// Instants that are looked at, at most.
constexpr Eigen::Index most_instants = 200;

/// The element of a member that misses most.
struct Tautness {
  double pull = 0.0, reach = 0.0, length = 0.0;  ///< [N]; √(EI/N), of the element [m]
  double missed = 0.0;                           ///< stress that may be missed [Pa]
};

/// In one plane.
class TautPlane {
 public:
  TautPlane(const std::string& name, const Model& model, BendingPlane plane)
      : member_(name, model, plane), plane_(plane) {}

  void see(const State& state) {
    const PlaneLoad& load = member_.observe(state);
    for (Eigen::Index e = 0; e < load.cols(); ++e) {
      const BeamElement<double>& element = member_.beam().elements[static_cast<std::size_t>(e)];
      const SectionProperties<double>& section = element.section;
      const bool is_xy = plane_ == BendingPlane::xy;
      const double inertia = is_xy ? section.inertia_z : section.inertia_y;
      double depth = 0.0;
      for (const StressPoint<double>& point : section.points) {
        depth = std::max(depth, std::abs(is_xy ? point.y : point.z));
      }
      const double pull = load.col(e).head<2>().maxCoeff();
      const double axial = load.col(e).head<2>().cwiseAbs().maxCoeff() / section.area;
      const double bending = load.col(e).tail<2>().cwiseAbs().maxCoeff() * depth / inertia;
      largest_stress_ = std::max(largest_stress_, axial + bending);
      if (!(pull > 0.0)) continue;
      const double reach = std::sqrt(element.young * inertia / pull);
      const double missed = bending * element.length / reach;
      if (element.length < long_element * reach || missed <= worst_.missed) continue;
      worst_ = {pull, reach, element.length, missed};
    }
  }

  std::optional<Tautness> worst() const {
    if (worst_.missed <= small_stress_share * largest_stress_) return std::nullopt;
    return worst_;
  }

 private:
  LateralMember member_;
  BendingPlane plane_;
  double largest_stress_ = 0.0;
  Tautness worst_;
};

/// What is made from bending moments of a body.
std::vector<std::string> bent_responses(const ProblemFile& problem, const std::string& body) {
  return names_made_of(problem, [&](const ResponseSettings& response) {
    const bool is_of_moments =
        (response.type == ResponseType::stress && response.part != StressPart::axial) ||
        (response.type == ResponseType::section_force &&
         response.section_part != SectionForcePart::axial) ||
        response.type == ResponseType::fatigue || response.type == ResponseType::fatigue_damage;
    return is_of_moments && std::ranges::find(response.bodies, body) != response.bodies.end();
  });
}

}  // namespace

std::vector<Finding> check_tension_layers(const TrustedRun& run) {
  std::vector<Finding> findings;
  const Trajectory& trajectory = run.analysis.trajectory;
  const Eigen::Index stride = 1 + trajectory.time.size() / most_instants;
  for (const Body& body : run.problem.scene.bodies) {
    if (!std::holds_alternative<BeamBody>(body.shape)) continue;
    const BodyModel& part = *run.analysis.model.parts(body.name).front();
    const std::vector<std::string> responses = bent_responses(run.problem, body.name);
    if (!part.is_elastic || !part.has_stiffening || responses.empty()) continue;
    std::vector<TautPlane> planes;
    for (const BendingPlane plane : bending_planes(part)) {
      planes.emplace_back(body.name, run.analysis.model, plane);
    }
    for (Eigen::Index i = 0; i < trajectory.time.size(); i += stride) {
      const State state = trajectory.state_at(static_cast<int>(i));
      for (TautPlane& plane : planes) plane.see(state);
    }
    std::optional<Tautness> worst;
    for (const TautPlane& plane : planes) {
      const std::optional<Tautness> one = plane.worst();
      if (one && (!worst || one->missed > worst->missed)) worst = one;
    }
    if (!worst) continue;
    findings.push_back(
        {fmt::format("\"{}\" is taut: under a pull of {:.3g} N it bends within some {:.2g} "
                     "m of where it is held or loaded across, which an element of {:.2g} "
                     "m does not see; stress there may be larger by far. Divide it by "
                     "short \"segments\" there.",
                     body.name, worst->pull, worst->reach, worst->length),
         true, responses});
  }
  return findings;
}

}  // namespace pleuel
