#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/model/joint_holds.hpp"

namespace pleuel {

struct BuildContext;  // core/model/build_context.hpp

/// A distance along the axis of a beam, beyond one of its ends; negative before it.
struct EndDistance {
  double value = 0.0;                          ///< [m]
  std::vector<std::pair<int, double>> slopes;  ///< by the design variables that it depends on
};

/// What a joint holds of a beam and its fittings, as if they were one.
struct EndHold {
  int end = 0;  ///< 0 or 1: beginning or end of the beam; -1: a place between them
  bool is_of_fitting = false;
  EndDistance distance;  ///< of a joint of a fitting
  JointHold hold;        ///< at a place of the beam
};

/// Rigid bodies that are welded to the ends of a beam, and rigid ones that are welded to them: the
/// axial force of the beam goes on in them, and their joints hold it. Bodies with a joint to the
/// beam elsewhere are no fittings.
class EndFittings {
 public:
  /// @param scene  with the beam undivided
  /// @returns      nothing where no end has a fitting
  static std::optional<EndFittings> of(const Body& beam, const Scene& scene,
                                       const BuildContext& context);

  bool is_fitted(int end) const { return reaches_[end].has_value(); }
  /// To the furthest place where something acts on the fitting: a force, a spring, a joint or its
  /// weight and inertia.
  /// @pre is_fitted(end)
  const EndDistance& reach(int end) const { return *reaches_[end]; }
  /// Of all joints of fittings, and of those that the beam has besides.
  std::vector<EndHold> holds() const;

 private:
  /// Places that are closer than this share of a length are one.
  static constexpr double same_place = 1e-9;

  struct Joined {
    int end;
    double position;  ///< along the beam, at the start [m]
    EndDistance distance;
  };
  class Builder;

  std::string beam_;
  double length_ = 0.0, before_ = 0.0, total_ = 0.0;  ///< at the start [m]
  std::array<std::optional<EndDistance>, 2> reaches_;
  std::vector<Joined> joints_;  ///< of the fittings
  JointHolds as_one_;           ///< of the scene whose beam has the joints of its fittings
};

}  // namespace pleuel
