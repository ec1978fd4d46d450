#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/beam/lateral_buckling.hpp"
#include "core/model/model.hpp"
#include "core/response/signal.hpp"

namespace pleuel {

/// How an end of a beam goes on in a rigid body that is welded to it (RigidEnd).
struct FittedEnd {
  EndDistance reach, pivot;
};

/// A beam of the scene with all that its lateral buckling is made of.
class LateralMember {
 public:
  /// @param name   of an elastic beam with section forces; of a divided one all parts count
  /// @param model  must outlive the member
  /// @param counts_outside  whether what the file says to hold the beam does
  LateralMember(const std::string& name, const Model& model, BendingPlane plane,
                bool counts_outside = true);

  const Beam<double>& beam() const { return beam_; }
  /// Of the beam with what its fittings add at its ends [m].
  double full_length() const;
  /// By the joints of the beam, whose neighbours are taken to be rigid, and those of its fittings.
  LateralBuckling& buckling();

  /// N and M in the plane, at both ends of each element, as stress is made from them.
  const PlaneLoad& observe(const State& state);
  /// gradient += Σ weights · ∂load/∂(…)
  void add_gradient(const State& state, const PlaneLoad& weights, SignalGradient& gradient);
  /// gradient += weight Σ slopes · ∂(reach, pivot)/∂x
  void add_gradient(const RigidEnds& slopes, double weight, SignalGradient& gradient) const;
  /// The beam with a design variable seeded, for each that it depends on.
  const std::vector<std::pair<int, Beam<Dual>>>& beam_x();

 private:
  /// Of the joints, where they are at the design of the model.
  std::vector<JointHold> holds() const;
  void hold_from_outside(std::vector<LateralSupport>& supports) const;

  std::string name_;
  const Model& model_;
  BendingPlane plane_;
  bool counts_outside_;
  std::vector<const BodyModel*> parts_;
  Beam<double> beam_;
  double length_;
  std::vector<std::pair<int, Beam<Dual>>> beam_x_;  ///< once it is needed
  std::optional<LateralBuckling> buckling_;         ///< once it is needed
  std::array<FittedEnd, 2> ends_;                   ///< with it
  std::unique_ptr<Signal> forces_;
  PlaneLoad load_;
};

/// The planes in which a body of the model bends by its motion: one, or in space both.
std::vector<BendingPlane> bending_planes(const BodyModel& body);

/// The section forces of a beam at an instant over those at which it buckles out of the plane in
/// which it bends (core/beam/lateral_buckling.hpp), 0 where it does not [–]. In space a channel for
/// each plane in which its joints hold it.
/// @returns  null where they hold it in none
std::unique_ptr<Signal> make_lateral_buckling_signal(const std::string& name, const Model& model);

}  // namespace pleuel
