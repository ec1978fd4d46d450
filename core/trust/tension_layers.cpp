#include <algorithm>
#include <cmath>

#include "core/base/eager_matrices.hpp"
#include "core/response/lateral_buckling_signal.hpp"
#include "core/trust/bent_beams.hpp"

namespace pleuel {

namespace {

/// Lengths of an element over √(EI/N): below, runs with half or twice the elements tell.
constexpr double long_element = 3.0;
/// Of the largest stress of axial force and bending: what may be missed of it without a word.
constexpr double small_stress_share = 0.05;
/// Instants that are looked at, at most.
constexpr Eigen::Index most_instants = 200;

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
      if (element.length < long_element * reach) continue;
      missed_ = std::max(missed_, bending * element.length / reach);
    }
  }

  /// Of the largest stress.
  double missed_share() const { return largest_stress_ > 0.0 ? missed_ / largest_stress_ : 0.0; }

 private:
  LateralMember member_;
  BendingPlane plane_;
  double largest_stress_ = 0.0, missed_ = 0.0;  ///< [Pa]
};

}  // namespace

std::vector<ConcernedBeam> find_taut(const TrustedRun& run) {
  std::vector<ConcernedBeam> found;
  const Trajectory& trajectory = run.analysis.trajectory;
  const Eigen::Index stride = 1 + trajectory.time.size() / most_instants;
  for (const Body& body : run.problem.scene.bodies) {
    if (!std::holds_alternative<BeamBody>(body.shape)) continue;
    const BodyModel& part = *run.analysis.model.parts(body.name).front();
    if (!part.is_elastic || !part.has_stiffening) continue;
    std::vector<TautPlane> planes;
    for (const BendingPlane plane : bending_planes(part)) {
      planes.emplace_back(body.name, run.analysis.model, plane);
    }
    for (Eigen::Index i = 0; i < trajectory.time.size(); i += stride) {
      const State state = trajectory.state_at(static_cast<int>(i));
      for (TautPlane& plane : planes) plane.see(state);
    }
    double most = 0.0;
    for (const TautPlane& plane : planes) most = std::max(most, plane.missed_share());
    if (most > small_stress_share) found.push_back({body.name, most});
  }
  return found;
}

}  // namespace pleuel
