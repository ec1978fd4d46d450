#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/base/load_kind.hpp"
#include "core/scene/body_constants.hpp"
#include "core/scene/kind_table.hpp"
#include "core/scene/number.hpp"
#include "core/scene/time_function.hpp"

/// What the user asked for: plain structs, no mathematics. Order is the order of the file.
namespace pleuel {

class BodySource;

struct Material {
  std::string name;
  Number young;                                  ///< E [Pa]
  Number poisson;                                ///< ν [–]
  Number density;                                ///< ρ [kg/m³]
  std::optional<Number> strength = {};           ///< that stress is compared with: of yield [Pa]
  std::optional<Number> ultimate_strength = {};  ///< of fracture [Pa]
  /// Amplitude that a point bears for ever, of stress without mean [Pa].
  std::optional<Number> endurance_limit = {};
  /// σ_f' and k of Basquin's line σ_a = σ_f' (2N)^(−1/k) of stress without mean [Pa], [–].
  std::optional<Number> fatigue_strength = {};
  std::optional<double> fatigue_exponent = {};
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

struct EllipseSection {
  Number width, height;  ///< full axes [m]
};

/// A rectangular tube.
struct BoxSection {
  Number width, height;  ///< outer [m]
  Number thickness;      ///< of the walls [m]
};

/// Web along local y, flanges along local z.
struct ISection {
  Number width, height;     ///< outer [m]
  Number flange_thickness;  ///< [m]
  Number web_thickness;     ///< [m]
};

/// A place of a general section where stress is evaluated.
struct GeneralStressPoint {
  Number y, z;   ///< [m]
  Number shear;  ///< torsional shear stress per torque [1/m³]
};

/// Any section, by its properties about the principal axes y and z through the centroid.
struct GeneralSection {
  Number area;                             ///< [m²]
  Number inertia_y, inertia_z;             ///< ∫z² dA, ∫y² dA [m⁴]
  Number torsion;                          ///< torsion constant J [m⁴]
  std::vector<GeneralStressPoint> points;  ///< at least one
  /// κA of shear forces along y and z [m²]; both or none. A beam whose shear counts needs them.
  std::optional<Number> shear_area_y = {}, shear_area_z = {};
};

using Section = std::variant<RectangleSection, CircleSection, TubeSection, EllipseSection,
                             BoxSection, ISection, GeneralSection>;

/// A stretch of a beam with one section. Segments share the length in proportion to their elements
/// unless `fraction` says otherwise.
struct Segment {
  Section section;
  int elements = 1;
  std::optional<double> fraction;  ///< share of the beam's length, in (0, 1]
};

/// How the body frame is tied to the deformed beam.
enum class ReferenceCondition {
  tangent,      ///< the first node is clamped in the frame: cranks, cantilevers
  tangent_end,  ///< the last node is
  chord,        ///< frame through both end nodes: rods between joints
  mean_axis     ///< no momentum relative to the frame (Tisserand)
};
inline constexpr Choice<ReferenceCondition> reference_conditions[] = {
    {"tangent", ReferenceCondition::tangent},
    {"tangent-end", ReferenceCondition::tangent_end},
    {"chord", ReferenceCondition::chord},
    {"mean-axis", ReferenceCondition::mean_axis}};

/// Rayleigh damping of a body, D = mass · S_ff + stiffness · K, or modal damping of its elastic
/// modes.
struct Damping {
  Number mass;        ///< [1/s]
  Number stiffness;   ///< [s]
  Number modal = {};  ///< damping ratio ζ of every mode [–]; reduced bodies only
};

/// Craig–Bampton reduction of bending and torsion: static modes of the nodes at joints and loads,
/// and so many fixed-interface modes.
struct CraigBampton {
  std::optional<int> modes;         ///< number of fixed-interface modes
  std::optional<double> frequency;  ///< or all below this one [rad/s]
  int more_modes = 0;               ///< not of a file: so many besides, in each family
};

/// Not of a file: the stretch of a divided beam that one of its frames carries. Ends of the beam
/// and list of segments are those of the whole beam; segments have the elements and the share of
/// the whole length that lie in the stretch, none where they lie outside.
struct BeamPart {
  std::string body;               ///< name of the whole beam
  double begin = 0.0, end = 1.0;  ///< shares of its length
  int first_element = 0;          ///< elements of the whole beam that come before
};

/// What holds a beam and is no part of the mechanism, as cladding or a guide. It is known to checks of
/// stability only: places of the beam do not move along a direction there, nor turn about its axis.
struct OutsideHold {
  std::array<double, 3> direction;  ///< unit vector, global axes
  std::vector<double> at = {};      ///< shares of the length; empty: all along
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
  bool is_rigid = false;  ///< no elastic coordinates; inertia from the same integrals
  /// Bends by shear, too: Timoshenko's beam in place of Euler and Bernoulli's.
  bool has_shear = false;
  std::optional<CraigBampton> reduction;
  std::optional<OutsideHold> held = {};
  int frames = 1;  ///< floating frames that share the beam, welded to each other
  /// Not of a file: into how many each element of the mesh is divided, whatever made it.
  int pieces = 1;
  std::optional<BeamPart> part = {};
};

struct RigidBody {
  Point at;                       ///< centre of mass at t = 0 [m]
  Number mass;                    ///< [kg]
  std::array<Number, 6> inertia;  ///< tensor xx, yy, zz, xy, xz, yz about `at` [kg m²]
};

struct PointMass {
  Point at;     ///< at t = 0 [m]
  Number mass;  ///< [kg]
};

/// A design variable of the problem that the constants of an imported body depend on.
struct ImportedVariable {
  Number number;              ///< bound to the variable
  Quantity quantity;          ///< what it measures
  std::size_t in_design = 0;  ///< index in InvariantsFile::design
};

/// An elastic body that is known by its invariants only, from a file that another code may have
/// written.
struct ImportedBody {
  Point from;  ///< origin of the body frame at t = 0, global axes [m]
  Point to;    ///< a point on its local x axis
  /// As of a beam.
  std::optional<std::array<double, 3>> reference;
  std::string source;  ///< the file or the program, for messages
  /// What was read, or what was made for the start.
  std::shared_ptr<const InvariantsFile> file;
  /// Makes the body for other designs; null: `file` is all that is known.
  std::shared_ptr<const BodySource> maker;
  std::vector<ImportedVariable> variables;
  /// Whether the constants may be continued linearly to other designs than that of the file.
  bool is_linear = false;
};

/// A place of an elastic body that starts displaced along a direction, against the body frame.
struct InitialDeflection {
  Point at;                         ///< at t = 0, undeformed, global axes [m]
  std::array<double, 3> direction;  ///< unit vector, global axes at t = 0
  Number displacement = 0.0;        ///< [m]
  Number rate = 0.0;                ///< [m/s]
};

struct Body {
  std::string name;
  std::variant<BeamBody, RigidBody, PointMass, ImportedBody> shape;
  /// Of the body frame at t = 0, made consistent with joints and drives; global axes.
  std::array<Number, 3> velocity = {0.0, 0.0, 0.0};          ///< [m/s]
  std::array<Number, 3> angular_velocity = {0.0, 0.0, 0.0};  ///< [rad/s]
  std::vector<InitialDeflection> initial_deflections = {};   ///< elastic bodies start straight else
};

/// Whether a body bends, if effects let it.
inline bool is_elastic(const Body& body) {
  const auto* beam = std::get_if<BeamBody>(&body.shape);
  return std::holds_alternative<ImportedBody>(body.shape) || (beam != nullptr && !beam->is_rigid);
}

/// What a drive prescribes: a coordinate of the second body of a joint against the first.
enum class DrivenCoordinate {
  angle,        ///< about the axis [rad]: revolute, cylindrical, universal (first axis), planar
  displacement  ///< along the axis [m]: prismatic, cylindrical, point-on-line; change of a distance
};

struct Drive {
  TimeFunction motion;
  DrivenCoordinate coordinate = DrivenCoordinate::angle;

  Drive() = default;
  template <class Function>
  Drive(Function function,  // NOLINT: a function of time drives an angle
        DrivenCoordinate driven = DrivenCoordinate::angle)
      : motion(std::move(function)), coordinate(driven) {}
};

enum class JointType {
  revolute,       ///< points coincide, one common axis
  prismatic,      ///< the second body slides along the axis of the first, without turning
  fixed,          ///< no relative motion
  point_on_line,  ///< the point of the second body stays on a line fixed in the first
  cylindrical,    ///< slides along and turns about the axis
  universal,      ///< points coincide; an axis of the first stays normal to one of the second
  spherical,      ///< points coincide
  planar,         ///< slides in the plane normal to the axis and turns about it
  distance,       ///< two points keep their distance: a massless rod
  point_on_plane  ///< the point of the second body stays in a plane fixed in the first
};

struct Joint {
  std::string name;
  JointType type = JointType::revolute;
  std::array<std::string, 2> bodies;       ///< names of bodies, or "ground"
  Point at;                                ///< where the joint is at t = 0, global axes [m]
  std::array<double, 3> axis = {0, 0, 1};  ///< of rotation, of sliding, or the normal of a plane
  /// Of a universal joint, fixed in the second body, normal to `axis`.
  std::array<double, 3> second_axis = {1, 0, 0};
  Point to;  ///< of a distance: the point of the second body at t = 0
  std::optional<Drive> drive;
};

// Loads and force elements.

/// The coordinate of a joint that a load is a function of, with its rate.
struct JointCoordinate {
  std::string joint;
  DrivenCoordinate coordinate = DrivenCoordinate::angle;
};

/// A force on a point of a body, or spread evenly along a stretch of it, or a torque on a body:
/// value(t) · direction.
struct PointLoad {
  LoadKind kind = LoadKind::force;
  std::string body = {};
  /// At t = 0, global axes [m]; of a torque on a beam the place whose rotation does the work.
  Point at = {};
  std::array<double, 3> direction = {};      ///< unit vector, global axes at t = 0
  TimeFunction value = {};                   ///< [N] or [N m]
  bool follows_body = false;                 ///< whether the direction turns with the body
  std::optional<JointCoordinate> over = {};  ///< what the value is a function of, besides time
  std::optional<Point> to = {};              ///< of a force: end of the stretch that begins at `at`
  /// Of the part of a stretch that lies on one frame of a beam: the whole of it, which has the value.
  std::optional<std::array<Point, 2>> whole = {};

  bool is_force() const { return kind == LoadKind::force; }
  const char* unit() const { return is_force() ? "N" : "N m"; }
};

/// Between two points: force k (l − l₀) + c l̇ + r(l − l₀, l̇, t) along their connection.
struct SpringDamper {
  std::array<std::string, 2> bodies;
  std::array<Point, 2> at;                      ///< at t = 0, global axes [m]
  Number stiffness;                             ///< [N/m]
  Number damping;                               ///< [N s/m]
  std::optional<Number> free_length;            ///< [m]; by default the distance at t = 0
  std::optional<TimeFunction> resistance = {};  ///< r [N]
};

/// A motor that follows a motion: proportional · (target − s) + derivative · (target's rate − ṡ).
struct MotorControl {
  TimeFunction target;  ///< [rad] or [m], as of a drive
  Number proportional;  ///< [N m/rad] or [N/m]
  Number derivative;    ///< [N m s/rad] or [N s/m]
};

/// Spring, damper (viscous friction) and motor in a joint, acting on its free coordinate (the angle
/// of a revolute, the displacement of a prismatic joint; `coordinate` chooses for a cylindrical):
///     −k (s − s₀) − c ṡ − r(s − s₀, ṡ, t) + motor(t, s, ṡ)
/// on the second body, the opposite on the first.
struct JointForce {
  std::string joint;
  DrivenCoordinate coordinate = DrivenCoordinate::angle;
  Number stiffness;                          ///< [N m/rad] or [N/m]
  Number damping;                            ///< [N m s/rad] or [N s/m]
  Number rest;                               ///< s₀ [rad] or [m], against the position at t = 0
  std::optional<TimeFunction> motor;         ///< [N m] or [N]
  std::optional<MotorControl> control = {};  ///< another motor
  std::optional<TimeFunction> resistance = {};  ///< r [N m] or [N]
};

struct Load {
  std::string name;
  std::variant<PointLoad, SpringDamper, JointForce> element;
};

inline constexpr const char* ground_name = "ground";

struct Scene {
  std::array<Number, 3> gravity = {0.0, 0.0, 0.0};  ///< [m/s²]
  std::vector<Material> materials;
  std::vector<Body> bodies;
  std::vector<Joint> joints;
  std::vector<Load> loads;
  std::vector<RangedFormula> formulas;  ///< among its numbers; see scene_rules.hpp
};

}  // namespace pleuel
