#pragma once

#include <array>
#include <vector>

#include "core/base/band_modes.hpp"
#include "core/base/dual.hpp"
#include "core/beam/beam.hpp"

namespace pleuel {

/// The two planes in which a beam may bend.
enum class BendingPlane { xy, xz };

/// What joints hold at a node against motion out of the plane of bending.
struct LateralSupport {
  bool deflection = false, slope = false, twist = false;
};

/// A rigid body that is welded to an end of a beam and goes on along its axis.
struct RigidEnd {
  double reach = 0.0;  ///< how far beyond the end the axial force acts [m]
  double pivot = 0.0;  ///< how far beyond the end the support of its node holds the deflection [m]
};
/// At the first and the last node.
using RigidEnds = std::array<RigidEnd, 2>;

/// Section forces in the plane of bending, linear in each element: N at its start and its end (pull
/// is positive) [N], M at its start and its end [N m]. A column an element.
using PlaneLoad = Eigen::Matrix4Xd;

/// What makes a beam buckle, and how: the share of the critical load and the modes that have it.
struct LateralModes {
  double share = 0.0;      ///< 0: nothing buckles, and there are no modes
  Eigen::MatrixXd shapes;  ///< w, θ, φ of all nodes, a column each mode; φᵀ K φ = 1
};

/// Lateral(–torsional) buckling of a beam out of the plane in which it bends, by given section
/// forces. With the lateral deflection w and the twist φ, the lateral stiffness EI and
/// I₀ = I_y + I_z (Timoshenko & Gere, Theory of Elastic Stability, ch. 5 and 6),
///     Π = ½ ∫ EI w''² + GJ φ'² + s (N w'² + N (I₀/A) φ'² + 2 m M φ w'') dx,
/// or in the nodal values u of cubic w and linear φ
///     Π = ½ uᵀ (K + s G) u,    −G u = (1/s) K u.
/// Sections turn by θ = w', and where shear bends the beam by θ = w' − γ: EI θ'² + κGA γ² takes the
/// place of EI w''² and φ θ' that of φ w'', while N still acts along the slope w' of the axis. So
/// P/(1 + P/(κGA)) takes the place of Euler's load P (Engesser; Timoshenko & Gere, art. 2.17).
/// The share of the critical load is 1/s for the smallest s > 0 at which Π is no longer positive, and
/// 0 if there is none. It has columns (Euler's loads), beams whose moment twists them sideways
/// (M = π √(EI GJ)/L for a constant one), and both together. m² = 1 − EI/EI_bending, as bending in
/// the plane holds the beam straighter out of it (Kirby & Nethercot 1979); a beam that is as stiff
/// sideways has m = 0. A rigid body that carries the axial force N of an end over the reach d has
/// the slope θ of the end: it adds ½ s N d θ² to Π. Where it is held at the distance p beyond the
/// end, w ± p θ (of the last and the first node) takes the place of the deflection of the end.
/// Warping of sections is free, transverse loads act at the centroid.
class LateralBuckling {
 public:
  /// Shares up to this one are none.
  static constexpr double least_share = 1e-9;

  /// @param supports  one a node. If they let the beam turn about its axis, its first node is held.
  LateralBuckling(const Beam<double>& beam, BendingPlane plane,
                  std::vector<LateralSupport> supports, const RigidEnds& ends = {});

  /// Whether the supports hold the beam: it cannot move out of the plane without strain. Else there
  /// is nothing to ask for.
  bool is_held() const { return is_held_; }

  /// @param least  shares up to this one are 0
  /// @pre is_held()
  double share(const PlaneLoad& load, double least = least_share);
  /// The same with its mode; with two where their shares coincide (to 1e-8).
  LateralModes modes(const PlaneLoad& load);

  /// ∂share/∂load; of coinciding modes the mean.
  PlaneLoad load_slopes(const LateralModes& modes) const;
  /// The derivative of the share with respect to a design variable, at the same section forces.
  /// @param beam  with the variable seeded
  double design_slope(const Beam<Dual>& beam, const PlaneLoad& load,
                      const LateralModes& modes) const;
  /// ∂share/∂(reach, pivot) of both ends [1/m].
  RigidEnds end_slopes(const PlaneLoad& load, const LateralModes& modes) const;

 private:
  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  using UnitMatrices = std::array<Matrix6, 4>;
  /// An entry of the band of −G: what each number of the load of an element puts there.
  struct BandEntry {
    Eigen::Index element, row, column;
    Eigen::Vector4d of_load;
  };

  bool hold();
  void set_destabilizing(const PlaneLoad& load);
  double size_of(const PlaneLoad& load) const;

  BendingPlane plane_;
  std::vector<LateralSupport> supports_;
  RigidEnds ends_;
  std::vector<Matrix6> elastic_;         ///< K of each element
  std::vector<UnitMatrices> geometric_;  ///< G of each element, of unit entries of the load
  double critical_press_ = 0.0, critical_moment_ = 0.0;  ///< of simple supports [N], [N m]
  bool is_held_ = false;
  std::vector<Eigen::Index> rows_;  ///< of each nodal value among what is free, or −1
  Eigen::VectorXd scale_;           ///< of those: lengths and angles alike
  std::vector<BandEntry> entries_;
  Band destabilizing_;                             ///< −G of those, scaled
  LargestBandMode largest_ = LargestBandMode({});  ///< with K of those, scaled
};

}  // namespace pleuel
