#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <type_traits>
#include <variant>

#include "core/base/members.hpp"
#include "core/scene/along_coordinate.hpp"
#include "core/scene/scene.hpp"
#include "core/scene/units.hpp"

/// The keys of a problem file whose values are numbers of a struct: a table a struct. Reading, the
/// visit of all numbers (visit_numbers.hpp) and the test of the schema go by them.
namespace pleuel {

enum class Presence { required, optional };

/// One key. What it may be left out for is what the struct has by default.
template <class Struct>
struct NumberKey {
  std::string_view word;
  std::variant<Number Struct::*, std::optional<Number> Struct::*> member;
  Quantity quantity;
  Range range = Range::any;
  Presence presence = Presence::required;

  /// Null if the struct has none.
  const Number* of(const Struct& object) const {
    if (const auto* number = std::get_if<0>(&member)) return &(object.**number);
    const std::optional<Number>& number = object.*std::get<1>(member);
    return number ? &*number : nullptr;
  }
};

/// Names the struct whose table is asked for.
template <class Struct>
struct KeysOf {};

namespace keys {

template <class Member>
inline constexpr bool is_number =
    std::is_same_v<Member, Number> || std::is_same_v<Member, std::optional<Number>>;

struct CountNumbers {
  template <class... Members>
  constexpr auto operator()(const Members&...) const {
    return std::integral_constant<std::size_t, (std::size_t{0} + ... + is_number<Members>)>();
  }
};

/// A table that has all numbers of the struct: one that is left out would have no derivatives.
template <class Struct, std::size_t count>
constexpr std::array<NumberKey<Struct>, count> all(const NumberKey<Struct> (&keys)[count]) {
  using Numbers = decltype(with_members(std::declval<Struct&>(), CountNumbers()));
  static_assert(Numbers::value == count, "every number of the struct needs a key");
  return std::to_array(keys);
}

}  // namespace keys

constexpr auto number_keys(KeysOf<RectangleSection>) {
  using S = RectangleSection;
  return keys::all<S>({{"width", &S::width, quantities::length, Range::positive},
                       {"height", &S::height, quantities::length, Range::positive}});
}

constexpr auto number_keys(KeysOf<CircleSection>) {
  using S = CircleSection;
  return keys::all<S>({{"diameter", &S::diameter, quantities::length, Range::positive}});
}

constexpr auto number_keys(KeysOf<TubeSection>) {
  using S = TubeSection;
  return keys::all<S>({{"outer_diameter", &S::outer_diameter, quantities::length, Range::positive},
                       {"thickness", &S::thickness, quantities::length, Range::positive}});
}

constexpr auto number_keys(KeysOf<EllipseSection>) {
  using S = EllipseSection;
  return keys::all<S>({{"width", &S::width, quantities::length, Range::positive},
                       {"height", &S::height, quantities::length, Range::positive}});
}

constexpr auto number_keys(KeysOf<BoxSection>) {
  using S = BoxSection;
  return keys::all<S>({{"width", &S::width, quantities::length, Range::positive},
                       {"height", &S::height, quantities::length, Range::positive},
                       {"thickness", &S::thickness, quantities::length, Range::positive}});
}

constexpr auto number_keys(KeysOf<ISection>) {
  using S = ISection;
  return keys::all<S>(
      {{"width", &S::width, quantities::length, Range::positive},
       {"height", &S::height, quantities::length, Range::positive},
       {"flange_thickness", &S::flange_thickness, quantities::length, Range::positive},
       {"web_thickness", &S::web_thickness, quantities::length, Range::positive}});
}

constexpr auto number_keys(KeysOf<GeneralSection>) {
  using S = GeneralSection;
  constexpr Quantity inertia = quantities::second_moment_of_area;
  return keys::all<S>(
      {{"area", &S::area, quantities::area, Range::positive},
       {"inertia_y", &S::inertia_y, inertia, Range::positive},
       {"inertia_z", &S::inertia_z, inertia, Range::positive},
       {"torsion", &S::torsion, inertia, Range::positive},
       {"shear_area_y", &S::shear_area_y, quantities::area, Range::positive, Presence::optional},
       {"shear_area_z", &S::shear_area_z, quantities::area, Range::positive, Presence::optional}});
}

constexpr auto number_keys(KeysOf<GeneralStressPoint>) {
  using S = GeneralStressPoint;
  return keys::all<S>({{"y", &S::y, quantities::length},
                       {"z", &S::z, quantities::length},
                       {"shear", &S::shear, quantities::torsional_shear, Range::not_negative}});
}

constexpr auto number_keys(KeysOf<Material>) {
  using S = Material;
  constexpr Presence optional = Presence::optional;
  constexpr Quantity stress = quantities::stress;
  return keys::all<S>(
      {{"young", &S::young, stress, Range::positive},
       {"poisson", &S::poisson, quantities::pure_number, Range::poisson},
       {"density", &S::density, quantities::density, Range::positive},
       {"strength", &S::strength, stress, Range::positive, optional},
       {"ultimate_strength", &S::ultimate_strength, stress, Range::positive, optional},
       {"endurance_limit", &S::endurance_limit, stress, Range::positive, optional},
       {"fatigue_strength", &S::fatigue_strength, stress, Range::positive, optional}});
}

constexpr auto number_keys(KeysOf<Damping>) {
  using S = Damping;
  constexpr Presence optional = Presence::optional;
  return keys::all<S>(
      {{"mass", &S::mass, quantities::rate, Range::not_negative, optional},
       {"stiffness", &S::stiffness, quantities::time, Range::not_negative, optional},
       {"modal", &S::modal, quantities::pure_number, Range::below_one, optional}});
}

constexpr auto number_keys(KeysOf<RigidBody>) {
  return keys::all<RigidBody>({{"mass", &RigidBody::mass, quantities::mass, Range::positive}});
}

constexpr auto number_keys(KeysOf<PointMass>) {
  return keys::all<PointMass>({{"mass", &PointMass::mass, quantities::mass, Range::positive}});
}

constexpr auto number_keys(KeysOf<InitialDeflection>) {
  using S = InitialDeflection;
  constexpr Presence optional = Presence::optional;
  return keys::all<S>({{"displacement", &S::displacement, quantities::length, Range::any, optional},
                       {"rate", &S::rate, quantities::speed, Range::any, optional}});
}

// Force elements.

constexpr auto number_keys(KeysOf<SpringDamper>) {
  using S = SpringDamper;
  constexpr Presence optional = Presence::optional;
  return keys::all<S>(
      {{"stiffness", &S::stiffness, quantities::spring_stiffness, Range::not_negative, optional},
       {"damping", &S::damping, quantities::damping_constant, Range::not_negative, optional},
       {"free_length", &S::free_length, quantities::length, Range::not_negative, optional}});
}

inline auto number_keys(KeysOf<JointForce>, const AlongCoordinate& measures) {
  using S = JointForce;
  constexpr Presence optional = Presence::optional;
  return keys::all<S>(
      {{"stiffness", &S::stiffness, measures.stiffness, Range::not_negative, optional},
       {"damping", &S::damping, measures.damping, Range::not_negative, optional},
       {"rest", &S::rest, measures.coordinate, Range::any, optional}});
}

inline auto number_keys(KeysOf<MotorControl>, const AlongCoordinate& measures) {
  using S = MotorControl;
  return keys::all<S>(
      {{"proportional", &S::proportional, measures.stiffness, Range::not_negative},
       {"derivative", &S::derivative, measures.damping, Range::not_negative, Presence::optional}});
}

// Functions of time and of the motion. `value` is what the function itself measures.

inline auto number_keys(KeysOf<ConstantFunction>, const Quantity& value) {
  return keys::all<ConstantFunction>({{"value", &ConstantFunction::value, value}});
}

inline auto number_keys(KeysOf<ConstantSpeedDrive>, const Quantity& value) {
  return keys::all<ConstantSpeedDrive>({{"speed", &ConstantSpeedDrive::speed, per_time(value)}});
}

inline auto number_keys(KeysOf<RampToSpeedDrive>, const Quantity& value) {
  using S = RampToSpeedDrive;
  return keys::all<S>({{"speed", &S::speed, per_time(value)},
                       {"ramp", &S::ramp, quantities::time, Range::positive}});
}

inline auto number_keys(KeysOf<HarmonicFunction>, const Quantity& value) {
  using S = HarmonicFunction;
  constexpr Presence optional = Presence::optional;
  return keys::all<S>({{"amplitude", &S::amplitude, value},
                       {"frequency", &S::frequency, quantities::angular_frequency, Range::positive},
                       {"phase", &S::phase, quantities::angle, Range::any, optional},
                       {"offset", &S::offset, value, Range::any, optional}});
}

inline auto number_keys(KeysOf<RampFunction>, const Quantity& value) {
  using S = RampFunction;
  return keys::all<S>(
      {{"from", &S::from, value, Range::any, Presence::optional}, {"to", &S::to, value}});
}

inline auto number_keys(KeysOf<HalfSineFunction>, const Quantity& value) {
  using S = HalfSineFunction;
  return keys::all<S>({{"amplitude", &S::amplitude, value},
                       {"offset", &S::offset, value, Range::any, Presence::optional}});
}

inline auto number_keys(KeysOf<FrictionLaw>, const Quantity& value) {
  using S = FrictionLaw;
  return keys::all<S>({{"value", &S::value, value, Range::not_negative},
                       {"speed", &S::speed, along(value).rate, Range::positive}});
}

inline auto number_keys(KeysOf<ClearanceLaw>, const Quantity& value) {
  using S = ClearanceLaw;
  const AlongCoordinate measures = along(value);
  constexpr Presence optional = Presence::optional;
  return keys::all<S>({{"lower", &S::lower, measures.coordinate, Range::any, optional},
                       {"upper", &S::upper, measures.coordinate, Range::any, optional},
                       {"stiffness", &S::stiffness, measures.stiffness, Range::positive},
                       {"rounding", &S::rounding, measures.coordinate, Range::positive}});
}

}  // namespace pleuel
