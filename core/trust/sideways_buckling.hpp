#pragma once

#include <optional>
#include <vector>

#include "core/response/analysis.hpp"
#include "core/trust/finding.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// Beams whose bending moment makes them buckle out of the plane in which they bend, by
/// lateral–torsional buckling, which the equations of motion do not have. Mentioned from three
/// quarters of the critical load on, serious beyond it, unless the file says that the beam is held.
/// The section forces of each instant count as if they lasted, neighbours at joints as rigid. What
/// compression does alone, or with neighbours, is asked of the whole mechanism (check_list.hpp).
/// Warping of sections helps short I beams: a bent beam is said to buckle only beyond what flanges
/// at the edges of its section could bear.
std::vector<Finding> check_sideways_buckling(const TrustedRun& run);

/// Whether the response `buckling` of a member says more than is true of the mechanism: it takes the
/// member as pinned at both ends, by itself; the rod of a hydraulic cylinder buckles together with
/// its barrel. Told where the mechanism buckles by smaller loads than the limit of the response is
/// for, or without a limit by less than twice its loads. Its factor is that of linear buckling at
/// the instant of the peak (elastic_stability.hpp), in the coordinates of the motion: in a plane, of
/// buckling in it. Drives hold. Not serious: the response is what it says it is. Nothing is said of
/// mechanisms with springs, nor without geometric stiffening.
std::vector<Finding> check_promised_buckling(const TrustedRun& run);

/// By what factor the loads of an instant buckle a mechanism, by linear buckling
/// (elastic_stability.hpp): its stiffness against that of the same position without deformation,
/// motion, weight and loads. In the coordinates of the motion: in a plane, of buckling in it. Drives
/// hold.
class LoadFactor {
 public:
  /// @param analysis  of the problem at the design x; has to outlive this
  LoadFactor(const ProblemFile& problem, const Eigen::VectorXd& x, const Analysis& analysis);

  /// Whether it can be told: not of many coordinates, nor of mechanisms with springs, which loads
  /// turn at once.
  bool is_known() const { return free_.has_value(); }
  /// Infinite where nothing buckles, as without geometric stiffening; not a number where motions
  /// of bodies are held by what is no joint.
  double at(int instant) const;

 private:
  const Analysis& analysis_;
  std::optional<Model> free_;  ///< without weight and loads
};

}  // namespace pleuel
