#pragma once

/// What a problem file asks for: one struct for each kind of response.

#include <array>
#include <compare>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/scene/mode_choice.hpp"
#include "core/scene/scene.hpp"

namespace pleuel {

enum class OverTime { max, min, max_abs, rms, mean, integral, final };

/// How often a coordinate is differentiated with respect to time.
enum class TimeDerivative { none, first, second, third };

/// In place of the number of a component of a vector (0 … 2): its magnitude is asked for.
inline constexpr int magnitude_direction = -1;

/// A point of a body.
struct ResponsePoint {
  std::string body = {};
  double at = 0.0;         ///< of a beam: place along it, 0 … 1
  std::string place = {};  ///< of an imported body: its name
  auto operator<=>(const ResponsePoint&) const = default;
};

/// What of a vector in global axes is asked for.
struct MotionComponent {
  int direction = 1;  ///< 0 … 2 = x, y, z, or magnitude_direction
  /// In place of it: along this unit vector.
  std::optional<std::array<double, 3>> along = {};
  auto operator<=>(const MotionComponent&) const = default;
};

/// The places that a stress is the largest of.
struct StressPlaces {
  std::vector<std::string> bodies = {};
  std::optional<int> segment = {};     ///< of a beam: only this segment, from 0
  std::optional<double> station = {};  ///< of a beam: only at this place along it, 0 … 1
  std::string place = {};  ///< of an imported body: a point or a group of them; empty: all
  auto operator<=>(const StressPlaces&) const = default;
};

struct MassResponse {
  std::vector<std::string> bodies = {};  ///< empty: all
  auto operator<=>(const MassResponse&) const = default;
};

/// What of the stress at a point is asked for.
enum class StressPart {
  von_mises,
  normal,      ///< signed: axial and bending
  axial,       ///< N/A
  bending,     ///< without N/A
  shear,       ///< of torsion
  utilization  ///< von Mises stress over the strength of the material
};

struct StressResponse {
  StressPlaces where = {};
  StressPart part = StressPart::von_mises;
  auto operator<=>(const StressResponse&) const = default;
};

/// Of shear forces and torsion.
struct ShearStressResponse {
  StressPlaces where = {};
  auto operator<=>(const ShearStressResponse&) const = default;
};

/// How much mean stress a cycle bears beside its amplitude (core/response/fatigue.hpp).
enum class FatigueCriterion { goodman, gerber, soderberg };

/// By the largest cycle of a window of time, or by all of them.
enum class FatigueNumber { utilization, damage };

struct FatigueResponse {
  StressPlaces where = {};
  FatigueNumber kind = FatigueNumber::utilization;
  FatigueCriterion criterion = FatigueCriterion::goodman;
  auto operator<=>(const FatigueResponse&) const = default;
};

/// Section forces of a beam, local axes: those of the part behind the section on the part before it.
enum class SectionForcePart {
  axial,     ///< N, positive: tension
  moment_y,  ///< bends in the plane of x and z
  moment_z,  ///< bends in the plane of x and y
  torque,    ///< about the axis of the beam
  shear_y,   ///< across it, along local y
  shear_z
};

/// From which side a section is looked at where a load or a joint acts.
enum class SectionSide { before, behind };

inline bool is_force(SectionForcePart part) {
  return part == SectionForcePart::axial || part == SectionForcePart::shear_y ||
         part == SectionForcePart::shear_z;
}

struct SectionForceResponse {
  std::string body = {};
  std::optional<double> station = {};  ///< place along the beam, 0 … 1; none: anywhere
  SectionForcePart part = SectionForcePart::axial;
  std::optional<SectionSide> side = {};
  auto operator<=>(const SectionForceResponse&) const = default;
};

/// Of a beam, or of the stiffening of an imported body, as a column.
struct BucklingResponse {
  std::string body = {};
  /// Of an imported body: the names of the places at its ends.
  std::optional<std::array<std::string, 2>> chord = {};
  auto operator<=>(const BucklingResponse&) const = default;
};

/// Out of the plane in which a beam bends.
struct LateralBucklingResponse {
  std::string body = {};
  auto operator<=>(const LateralBucklingResponse&) const = default;
};

/// What a deflection is measured against.
enum class DeflectionReference {
  frame,           ///< the body frame
  chord,           ///< the straight line through both ends of the beam
  rigid_mechanism  ///< the same place in the same mechanism without elasticity, same drives and
                   ///< loads
};

struct DeflectionResponse {
  ResponsePoint point = {};
  DeflectionReference against = DeflectionReference::frame;
  /// Of an imported body against its chord: the names of the places at its ends.
  std::optional<std::array<std::string, 2>> chord = {};
  /// 0 … 2 = local x, y, z, magnitude_direction = √(y² + z²); against the rigid mechanism global
  /// axes.
  int direction = 1;
  auto operator<=>(const DeflectionResponse&) const = default;
};

/// Position, velocity, acceleration or jerk of a point.
struct PointMotionResponse {
  ResponsePoint point = {};
  MotionComponent component = {};
  TimeDerivative derivative = TimeDerivative::none;
  auto operator<=>(const PointMotionResponse&) const = default;
};

/// Angle of a body frame, angular velocity, acceleration or jerk.
struct TurningResponse {
  std::string body = {};
  MotionComponent component = {};
  TimeDerivative derivative = TimeDerivative::none;
  auto operator<=>(const TurningResponse&) const = default;
};

/// Relative angle or displacement of both bodies of a joint, its rate, or the rate of that.
struct JointMotionResponse {
  std::string joint = {};
  DrivenCoordinate coordinate = DrivenCoordinate::angle;
  TimeDerivative derivative = TimeDerivative::none;
  auto operator<=>(const JointMotionResponse&) const = default;
};

/// Between two members, or a member and the normal of a guide.
struct TransmissionAngleResponse {
  std::vector<std::string> bodies = {};
  std::optional<std::array<double, 3>> guide = {};  ///< its axis, a unit vector
  auto operator<=>(const TransmissionAngleResponse&) const = default;
};

/// A torque is that of a drive of an angle, a force that of one of a displacement.
enum class DriveNumber { torque, force, power };

struct DriveResponse {
  std::string joint = {};
  DriveNumber kind = DriveNumber::torque;
  auto operator<=>(const DriveResponse&) const = default;
};

enum class ReactionKind { force, moment };

/// What a joint transmits.
struct ReactionResponse {
  std::string joint = {};
  ReactionKind kind = ReactionKind::force;
  int direction = 1;  ///< 0 … 2: global x, y, z, or magnitude_direction
  auto operator<=>(const ReactionResponse&) const = default;
};

/// A positive force pulls; motors are in joints; dampers, of springs or in joints, take the power of
/// their resistance to a rate, too.
enum class LoadNumber { spring_length, spring_force, motor_power, damper_power };

struct LoadResponse {
  std::string load = {};
  LoadNumber kind = LoadNumber::spring_length;
  auto operator<=>(const LoadResponse&) const = default;
};

/// A number of a mode of small vibrations.
struct ModeResponse {
  std::string body = {};  ///< empty: of the whole mechanism
  ModeChoice mode = {};
  auto operator<=>(const ModeResponse&) const = default;
};

enum class EnergyKind { kinetic, elastic };

struct EnergyResponse {
  std::string body = {};  ///< empty: of all
  EnergyKind kind = EnergyKind::kinetic;
  auto operator<=>(const EnergyResponse&) const = default;
};

/// What is missing in the balance of energy and work.
struct EnergyBalanceResponse {
  auto operator<=>(const EnergyBalanceResponse&) const = default;
};

/// Whether constraints themselves or their rates are looked at.
enum class DriftLevel { position, velocity };

struct DriftResponse {
  DriftLevel level = DriftLevel::position;
  auto operator<=>(const DriftResponse&) const = default;
};

/// A formula of other responses and of variables.
struct ExpressionResponse {
  std::shared_ptr<const Expression> expression = {};  ///< null until it is read
  auto operator<=>(const ExpressionResponse&) const = default;
};

using AnyResponse = std::variant<MassResponse, StressResponse, ShearStressResponse, FatigueResponse,
                                 SectionForceResponse, BucklingResponse, LateralBucklingResponse,
                                 DeflectionResponse, PointMotionResponse, TurningResponse,
                                 JointMotionResponse, TransmissionAngleResponse, DriveResponse,
                                 ReactionResponse, LoadResponse, ModeResponse, EnergyResponse,
                                 EnergyBalanceResponse, DriftResponse, ExpressionResponse>;

struct ResponseSettings {
  std::string name = {};
  AnyResponse what = {};
  OverTime over_time = OverTime::max;
  std::optional<double> from = {}, to = {};  ///< window of time [s]
  /// As the user wants to see it: said, or that of a limit; may be empty.
  std::string unit = {};
  double unit_scale = 1.0;  ///< SI value of that unit

  auto operator<=>(const ResponseSettings&) const = default;

  /// Null if the response is of another kind.
  template <class Kind>
  const Kind* as() const {
    return std::get_if<Kind>(&what);
  }
  /// Whether it is of one of these kinds.
  template <class... Kinds>
  bool is() const {
    return (std::holds_alternative<Kinds>(what) || ...);
  }
  /// Whether it is of the kind that has such numbers, and this one: DriveNumber::power.
  template <class Number>
  bool is(Number number) const {
    const auto has_it = [&](const auto& one) {
      if constexpr (requires { one.kind == number; }) return one.kind == number;
      return false;
    };
    return std::visit(has_it, what);
  }
};

/// Names of the bodies that a response looks at; none of the whole mechanism, and of joints and loads.
std::vector<std::string> bodies_of(const ResponseSettings& response);

/// Name of the joint that a response looks at; empty without one.
std::string joint_of(const ResponseSettings& response);

/// Null if a response is none of stress, shear stress or fatigue.
const StressPlaces* stress_places(const ResponseSettings& response);

/// Null if a response looks at no single point.
const ResponsePoint* response_point(const ResponseSettings& response);

/// The place along a beam, 0 … 1, that a response looks at; none if it looks at a whole one.
std::optional<double> place_along(const ResponseSettings& response);

bool is_against_rigid_mechanism(const ResponseSettings& response);

/// Of the motion of points, bodies and joints: which derivative of a coordinate it is.
std::optional<TimeDerivative> time_derivative_of(const ResponseSettings& response);

/// Null if it is no expression, or is not read yet.
const Expression* formula_of(const ResponseSettings& response);

}  // namespace pleuel
