#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/scene/number.hpp"

/// What the user asked for: plain structs, no mathematics. Order is the order of the file.
namespace pleuel {

struct Material {
  std::string name;
  Number young;    ///< E [Pa]
  Number poisson;  ///< ν [–]
  Number density;  ///< ρ [kg/m³]
};

// Sections. Local x is the beam axis; `width` lies along local z, `height` along local y.

struct RectangleSection {
  Number width;   ///< along local z [m]
  Number height;  ///< along local y [m]
};

struct CircleSection {
  Number diameter;  ///< [m]
};

struct TubeSection {
  Number outer_diameter;  ///< [m]
  Number thickness;       ///< of the wall [m]
};

using Section = std::variant<RectangleSection, CircleSection, TubeSection>;

/// A stretch of a beam with one section. Segments share the length in proportion to their elements
/// unless `fraction` says otherwise.
struct Segment {
  Section section;
  int elements = 1;
  std::optional<double> fraction;  ///< share of the beam's length, in (0, 1]
};

/// How the body frame is tied to the deformed beam.
enum class ReferenceCondition {
  tangent,  ///< the first node is clamped in the frame: cranks, cantilevers
  chord     ///< frame through both end nodes: rods between joints
};

/// Rayleigh damping of a body: D = mass · S_ff + stiffness · K.
struct Damping {
  Number mass;       ///< [1/s]
  Number stiffness;  ///< [s]
};

struct BeamBody {
  Point from, to;  ///< end points at t = 0, global axes [m]
  std::string material;
  std::vector<Segment> segments;
  ReferenceCondition frame = ReferenceCondition::tangent;
  Damping damping;
  /// A global vector not parallel to the beam; local y = its part normal to the beam axis.
  /// By default local y lies in the global x–y plane (the global y axis for beams along z).
  std::optional<std::array<double, 3>> reference;
};

struct RigidBody {
  Point at;                       ///< centre of mass at t = 0 [m]
  Number mass;                    ///< [kg]
  std::array<Number, 6> inertia;  ///< xx, yy, zz, xy, xz, yz about the centre of mass [kg m²]
};

struct PointMass {
  Point at;     ///< at t = 0 [m]
  Number mass;  ///< [kg]
};

struct Body {
  std::string name;
  std::variant<BeamBody, RigidBody, PointMass> shape;
};

// Drives: the angle of the second body of a joint against the first, as a function of time.

struct ConstantSpeedDrive {
  Number speed;  ///< [rad/s]
};

/// φ̈ = (Ω/T)(1 − cos 2πt/T) for t < T, then φ̇ = Ω.
struct RampToSpeedDrive {
  Number speed;  ///< Ω [rad/s]
  Number ramp;   ///< T [s]
};

using Drive = std::variant<ConstantSpeedDrive, RampToSpeedDrive>;

enum class JointType {
  revolute,      ///< points coincide, one common axis
  prismatic,     ///< the second body slides along the axis of the first, without turning
  fixed,         ///< no relative motion
  point_on_line  ///< the point of the second body stays on a line fixed in the first
};

struct Joint {
  std::string name;
  JointType type = JointType::revolute;
  std::array<std::string, 2> bodies;       ///< names of bodies, or "ground"
  Point at;                                ///< where the joint is at t = 0, global axes [m]
  std::array<double, 3> axis = {0, 0, 1};  ///< revolute: of rotation; others: of sliding
  std::optional<Drive> drive;              ///< revolute only
};

inline constexpr const char* ground_name = "ground";

struct Scene {
  std::array<Number, 3> gravity = {0.0, 0.0, 0.0};  ///< [m/s²]
  std::vector<Material> materials;
  std::vector<Body> bodies;
  std::vector<Joint> joints;
};

}  // namespace pleuel
