#pragma once

#include <algorithm>
#include <cassert>
#include <set>
#include <utility>
#include <vector>

#include "core/base/find_named.hpp"
#include "core/base/time_law.hpp"
#include "core/beam/beam.hpp"
#include "core/frame/body_frame.hpp"
#include "core/scene/beam_mesh.hpp"
#include "core/scene/body_chart.hpp"
#include "core/scene/point.hpp"
#include "core/scene/scene.hpp"
#include "core/section/box_section.hpp"
#include "core/section/i_section.hpp"
#include "core/section/rectangle_section.hpp"
#include "core/section/round_section.hpp"

/// From the plain structs of a scene to vectors, sections and beams, for any scalar type.
namespace pleuel {

inline Eigen::Vector3d to_vector(const std::array<double, 3>& array) {
  return {array[0], array[1], array[2]};
}

/// Without conjugation, so that it serves the complex step.
template <class Scalar>
Scalar length_of(const Vector3<Scalar>& vector) {
  using std::sqrt;
  return sqrt(vector.cwiseProduct(vector).sum());
}

template <class Scalar>
SectionProperties<Scalar> resolve_section(const Section& section, const Design<Scalar>& design) {
  struct Visitor {
    const Design<Scalar>& design;
    SectionProperties<Scalar> operator()(const RectangleSection& s) const {
      return rectangle_section(resolve(s.width, design), resolve(s.height, design));
    }
    SectionProperties<Scalar> operator()(const CircleSection& s) const {
      return round_section(resolve(s.diameter, design), Scalar(0));
    }
    SectionProperties<Scalar> operator()(const TubeSection& s) const {
      const Scalar outer = resolve(s.outer_diameter, design);
      return round_section(outer, Scalar(outer - 2.0 * resolve(s.thickness, design)));
    }
    SectionProperties<Scalar> operator()(const EllipseSection& s) const {
      return ellipse_section(resolve(s.width, design), resolve(s.height, design));
    }
    SectionProperties<Scalar> operator()(const BoxSection& s) const {
      return box_section(resolve(s.width, design), resolve(s.height, design),
                         resolve(s.thickness, design));
    }
    SectionProperties<Scalar> operator()(const ISection& s) const {
      return i_section(resolve(s.width, design), resolve(s.height, design),
                       resolve(s.flange_thickness, design), resolve(s.web_thickness, design));
    }
    SectionProperties<Scalar> operator()(const GeneralSection& s) const {
      SectionProperties<Scalar> section;
      section.area = resolve(s.area, design);
      section.inertia_y = resolve(s.inertia_y, design);
      section.inertia_z = resolve(s.inertia_z, design);
      section.torsion = resolve(s.torsion, design);
      for (const GeneralStressPoint& point : s.points) {
        section.points.push_back(
            {resolve(point.y, design), resolve(point.z, design), resolve(point.shear, design)});
      }
      return section;
    }
  };
  return std::visit(Visitor{design}, section);
}

/// Motions need accelerations, loads do not.
enum class LawOf { load, motion };

/// Ends of a table: what is repeated has none.
inline TableEnds table_ends(Repetition repetition, TableEnds otherwise) {
  return repetition == Repetition::periodic ? TableEnds::periodic : otherwise;
}

template <class Scalar>
TimeLaw<Scalar> resolve_table(const TableFunction& table, std::vector<Scalar> values,
                              LawOf purpose) {
  using Kind = typename TimeLaw<Scalar>::Kind;
  const bool is_motion = purpose == LawOf::motion;
  const TableEnds limited = table_ends(table.repetition, TableEnds::resting);
  switch (table.interpolation) {
    case Interpolation::step:
      return {Kind::step, std::move(values), table.times};
    case Interpolation::linear:
      return {Kind::linear, std::move(values), table.times};
    case Interpolation::monotone:
      return is_motion ? monotone_quintic(table.times, std::move(values), limited)
                       : monotone_cubic(table.times, std::move(values), limited);
    case Interpolation::resting:
      return resting_quintic(table.times, std::move(values));
    default:
      return cubic_spline(
          table.times, std::move(values),
          table_ends(table.repetition, is_motion ? TableEnds::resting : TableEnds::free));
  }
}

/// The rate rises to V = (to − from)/(duration − rounding) by V (3s² − 2s³); quintics between the
/// knots are that exactly, as they have its values, rates and accelerations (none) there.
template <class Scalar>
TimeLaw<Scalar> resolve_ramp(const RampFunction& ramp, const Scalar& from, const Scalar& to) {
  using Kind = typename TimeLaw<Scalar>::Kind;
  const double r = ramp.rounding, duration = ramp.end - ramp.begin;
  if (r == 0.0) return {Kind::linear, {from, to}, {ramp.begin, ramp.end}};
  const Scalar rate = (to - from) / (duration - r);
  const Scalar zero(0), up = from + 0.5 * r * rate, down = to - 0.5 * r * rate;
  if (2.0 * r >= duration) {  // nothing straight between
    return {Kind::quintic,
            {from, Scalar(0.5 * (from + to)), to, zero, rate, zero},
            {ramp.begin, 0.5 * (ramp.begin + ramp.end), ramp.end}};
  }
  return {Kind::quintic,
          {from, up, down, to, zero, rate, rate, zero},
          {ramp.begin, ramp.begin + r, ramp.end - r, ramp.end}};
}

template <class Scalar>
TimeLaw<Scalar> resolve_time_law(const TimeFunction& function, const Design<Scalar>& design,
                                 LawOf purpose = LawOf::load) {
  using Law = TimeLaw<Scalar>;
  struct Visitor {
    const Design<Scalar>& design;
    LawOf purpose;
    Scalar of(const Number& number) const { return resolve(number, design); }
    Law operator()(const ConstantFunction& f) const {
      return {Law::Kind::polynomial, {of(f.value)}, {}};
    }
    Law operator()(const ConstantSpeedDrive& f) const {
      return {Law::Kind::polynomial, {Scalar(0), of(f.speed)}, {}};
    }
    Law operator()(const RampToSpeedDrive& f) const {
      return {Law::Kind::ramp, {of(f.speed), of(f.ramp)}, {}};
    }
    Law operator()(const PolynomialFunction& f) const {
      Law law;
      for (const Number& number : f.coefficients) law.parameters.push_back(of(number));
      return law;
    }
    Law operator()(const HarmonicFunction& f) const {
      return {
          Law::Kind::harmonic, {of(f.amplitude), of(f.frequency), of(f.phase), of(f.offset)}, {}};
    }
    Law operator()(const TableFunction& f) const {
      std::vector<Scalar> values;
      for (const Number& number : f.values) values.push_back(of(number));
      Law law = resolve_table(f, std::move(values), purpose);
      law.argument = f.argument;
      if (f.repetition == Repetition::periodic) law.period = f.times.back() - f.times.front();
      return law;
    }
    Law operator()(const RampFunction& f) const { return resolve_ramp(f, of(f.from), of(f.to)); }
    Law operator()(const HalfSineFunction& f) const {
      Law law{Law::Kind::half_sine, {of(f.amplitude), of(f.offset)}, {}};
      law.knots = {f.begin, f.begin + f.duration};
      law.period = f.period;
      return law;
    }
    Law operator()(const ExpressionFunction& f) const {
      Law law;
      law.kind = Law::Kind::formula;
      law.expression = f.expression;
      for (const ExpressionArgument& argument : f.expression->arguments) {
        const bool is_variable = argument.kind == ExpressionArgument::Kind::variable;
        law.parameters.push_back(is_variable ? design[argument.index] : Scalar(0));
      }
      return law;
    }
    Law operator()(const FrictionLaw& f) const {
      Law law{Law::Kind::friction, {of(f.value), of(f.speed)}, {}};
      law.argument = LawArgument::rate;
      return law;
    }
    Law operator()(const ClearanceLaw& f) const {
      Law law{
          Law::Kind::clearance, {of(f.lower), of(f.upper), of(f.stiffness), of(f.rounding)}, {}};
      law.argument = LawArgument::coordinate;
      return law;
    }
  };
  return std::visit(Visitor{design, purpose}, function);
}

inline const Material& find_material(const Scene& scene, const std::string& name) {
  const Material* found = find_named(scene.materials, name);
  assert(found);
  return *found;
}

/// At t = 0, of a beam, or of a body that lies as one (core/scene/body_chart.hpp).
template <class Scalar, class Beam>
Pose<Scalar> beam_pose(const Beam& body, const Design<Scalar>& design) {
  return {resolve_point(body.from, design), beam_axes(body.from, body.to, body.reference, design)};
}

/// From the beginning of a beam to that of its part, at t = 0, global axes [m].
template <class Scalar>
Vector3<Scalar> part_offset(const BeamBody& beam, const Design<Scalar>& design) {
  const double begin = beam.part ? beam.part->begin : 0.0;
  return begin * (resolve_point(beam.to, design) - resolve_point(beam.from, design));
}

template <class Scalar>
Pose<Scalar> body_pose(const Body& body, const Design<Scalar>& design) {
  if (const auto* beam = std::get_if<BeamBody>(&body.shape)) {
    Pose<Scalar> pose = beam_pose(*beam, design);
    if (beam->part) pose.origin += part_offset(*beam, design);
    return pose;
  }
  if (const auto* imported = std::get_if<ImportedBody>(&body.shape)) {
    return beam_pose(*imported, design);
  }
  const auto* rigid = std::get_if<RigidBody>(&body.shape);
  const Point& at = rigid ? rigid->at : std::get<PointMass>(body.shape).at;
  return {resolve_point(at, design), Matrix3<double>::Identity().template cast<Scalar>()};
}

/// The design variables that the numbers of a body are bound to.
std::set<int> variables_of(const Body& body, const Scene& scene);

}  // namespace pleuel
