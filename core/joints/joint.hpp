#pragma once

#include <array>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/time_law.hpp"
#include "core/frame/marker.hpp"

/// What a joint is: two markers and a list of scalar equations between vectors attached to them.
namespace pleuel {

enum class EquationKind {
  coincident,     ///< e · (P₂ − P₁) = 0, e fixed in space
  on_plane,       ///< d · (P₂ − P₁) = 0, d attached to the first marker
  perpendicular,  ///< d · d' = 0, d attached to the first, d' to the second marker
  drive,          ///< d'·(cos f(t) d_b − sin f(t) d_a) = 0: d' has turned by f from d_a to d_b
  slide,          ///< d · (P₂ − P₁) = f(t), d attached to the first marker
  distance,  ///< ½ (|P₂ − P₁|²/ℓ − ℓ) = 0, ℓ = length + f(t): to first order |P₂ − P₁| − ℓ
  planar_angle,  ///< ±(φ₂ − φ₁ − offset) = f(t) (0 without a drive), about ± the plane's normal
};

/// What is to be known of a kind of equation besides its formula.
struct EquationTraits {
  EquationKind kind;
  std::string_view word;
  bool is_moment;  ///< whether its multiplier is a moment [N m], and no force [N]
};

inline constexpr EquationTraits equation_kinds[] = {
    {EquationKind::coincident, "coincident", false},
    {EquationKind::on_plane, "on_plane", false},
    {EquationKind::perpendicular, "perpendicular", true},
    {EquationKind::drive, "drive", true},
    {EquationKind::slide, "slide", false},
    {EquationKind::distance, "distance", false},
    {EquationKind::planar_angle, "planar_angle", true},
};

/// @throws std::logic_error for a kind without a row, as soon as a model has such an equation
constexpr const EquationTraits& traits_of(EquationKind kind) {
  for (const EquationTraits& traits : equation_kinds) {
    if (traits.kind == kind) return traits;
  }
  throw std::logic_error("a kind of joint equation has no row in equation_kinds");
}

struct JointEquation {
  EquationKind kind;
  Eigen::Vector3d fixed = Eigen::Vector3d::Zero();  ///< e
  int first = -1, second = -1, third = -1;          ///< directions d (or d_a), d', d_b
  double sense = 1.0;      ///< of planar_angle: −1 if the joint's axis is opposite to the normal
  bool is_driven = false;  ///< of planar_angle: whether f is the drive's, or zero
};

/// The numbers of a joint, which may depend on the design.
template <class Scalar>
struct JointData {
  std::array<Vector3<Scalar>, 2> points;    ///< undeformed, local axes of each body [m]
  std::vector<Vector3<Scalar>> directions;  ///< unit vectors, local axes of the body they belong to
  Scalar offset = Scalar(0);                ///< of planar_angle [rad]
  Scalar length = Scalar(0);                ///< of distance [m]
  TimeLaw<Scalar> drive;

  template <class Function, class... Data>
  static void visit(Function&& function, Data&... data) {
    for (std::size_t m = 0; m < 2; ++m) function(data.points[m]...);
    function(data.directions...);
    function(data.offset...);
    function(data.length...);
    function(data.drive...);
  }
};

struct JointTopology {
  std::string name;
  std::array<Marker, 2> markers;
  std::vector<JointEquation> equations;
  bool is_driven = false;
  int multiplier = 0;  ///< row of the first equation (counted from the number of coordinates)
};

}  // namespace pleuel
