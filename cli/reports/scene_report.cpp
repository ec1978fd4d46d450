#include "cli/reports/scene_report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include <fmt/format.h>

#include "cli/reports/document_table.hpp"
#include "cli/reports/starts_report.hpp"
#include "cli/text/wrapped_text.hpp"
#include "core/base/number_text.hpp"
#include "core/base/quoted.hpp"
#include "core/mechanism/mechanism.hpp"
#include "core/model/body_frames.hpp"
#include "core/scene/joint_kind.hpp"
#include "core/scene/time_breaks.hpp"

namespace pleuel {

namespace {

/// A body of the file: of a divided beam all its frames.
struct BodyRow {
  std::string name;
  double mass = 0.0;
  std::size_t frames = 0, elements = 0;
  int rigid = 0, elastic = 0;
  bool is_beam = false, is_elastic = false;
};

std::vector<BodyRow> body_rows(const Model& model) {
  std::vector<BodyRow> rows;
  for (const BodyModel& body : model.bodies) {
    if (rows.empty() || rows.back().name != body.name) rows.push_back({body.name});
    BodyRow& row = rows.back();
    row.mass += body.mass;
    ++row.frames;
    row.elements += body.beam.elements.size();
    row.rigid += body.frame.size();
    row.elastic += body.elastic_size();
    row.is_beam = body.is_beam();
    row.is_elastic = body.is_elastic;
  }
  return rows;
}

/// The range says little where one bound is far away.
bool is_at(double bound, const DesignVariable& variable, double value) {
  const double range = variable.upper - variable.lower;
  const double size = std::abs(bound) + std::abs(variable.start);
  return std::abs(value - bound) <= 1e-6 * (size > 0.0 ? std::min(range, size) : range);
}

/// Of the size of a coordinate; assembly itself ends at 1e-10.
constexpr double visible_shift = 1e-5;

int drives(const Model& model) {
  return static_cast<int>(std::ranges::count_if(
      model.joints, [](const JointModel& joint) { return joint.drive_row >= 0; }));
}

std::string both(const std::array<std::string, 2>& bodies) {
  return bodies[0] + " – " + bodies[1];
}

std::string joined(std::vector<std::string> parts) {
  std::erase(parts, "");
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string constant_text(const char* name, double value, const char* unit) {
  return value == 0.0 ? "" : fmt::format("{} {} {}", name, significant(value, 4), unit);
}

std::string resistance_text(const std::optional<TimeFunction>& resistance) {
  if (!resistance) return "";
  if (std::holds_alternative<FrictionLaw>(*resistance)) return "friction";
  if (std::holds_alternative<ClearanceLaw>(*resistance)) return "clearance";
  return "resistance";
}

/// A row of the table of what acts.
struct ActionRow {
  double end_time;
  const Design<double>& design;

  std::vector<std::string> operator()(const PointLoad& load) const {
    return {load.is_force() ? "force" : "torque", load.body, value_text(load, load.unit())};
  }
  std::vector<std::string> operator()(const SpringDamper& load) const {
    return {"spring", both(load.bodies), spring_text(load, design)};
  }
  std::vector<std::string> operator()(const JointForce& load) const {
    const bool turns = load.coordinate == DrivenCoordinate::angle;
    std::string motor;
    if (load.control) motor = "motor that follows a motion";
    if (load.motor && depends_on_state(*load.motor)) {
      motor = fmt::format("motor over {}", turns ? "angle or speed" : "displacement or speed");
    } else if (load.motor) {
      motor = "motor " + range_text(points(*load.motor), turns ? "N m" : "N");
    }
    return {"in the joint", load.joint, joined({spring_text(load, design), motor})};
  }

 private:
  std::string value_text(const PointLoad& load, const char* unit) const {
    if (!load.over) return range_text(points(load.value), unit);
    const bool turns = load.over->coordinate == DrivenCoordinate::angle;
    return fmt::format("over the {} of {}", turns ? "angle" : "displacement", load.over->joint);
  }
  LawPoints points(const TimeFunction& function) const {
    return law_points(function, end_time, design, LawOf::load);
  }
};

}  // namespace

std::string reached_bound(const DesignVariable& variable, double value) {
  if (variable.lower == variable.upper) return "both";
  if (is_at(variable.lower, variable, value)) return "lower";
  return is_at(variable.upper, variable, value) ? "upper" : "";
}

Json bodies_document(const Model& model) {
  return list_of(body_rows(model), [](const BodyRow& body) {
    return Json{{"name", body.name},
                {"mass", body.mass},
                {"frames", body.frames},
                {"elements", body.elements},
                {"coordinates", body.rigid + body.elastic}};
  });
}

std::string bodies_text(const Model& model) {
  Table table(
      {left_aligned("body"), "mass [kg]", "frames", "elements", "rigid coordinates", "elastic"});
  for (const BodyRow& body : body_rows(model)) {
    table.add_row({body.name, significant(body.mass), std::to_string(body.frames),
                   body.is_beam ? std::to_string(body.elements) : "–", std::to_string(body.rigid),
                   body.is_elastic || body.is_beam ? std::to_string(body.elastic) : "–"});
  }
  return table.text();
}

Json freedoms_document(const DegreesOfFreedom& freedoms, const Model& model) {
  return {{"coordinates", freedoms.coordinates},
          {"constraints", freedoms.constraints},
          {"drives", drives(model)},
          {"free", freedoms.free()},
          {"blocked_drives", freedoms.blocked}};
}

bool has_drives(const Model& model) {
  return drives(model) > 0;
}

std::string freedoms_text(const DegreesOfFreedom& freedoms, const Model& model,
                          const State* state) {
  const int driven = drives(model);
  std::string text = fmt::format(
      "Rigid motion: {} coordinates, {} independent constraints ({} of drives): ",
      freedoms.coordinates, freedoms.constraints, driven == 0 ? "none" : std::to_string(driven));
  if (freedoms.free() > 0) {
    constexpr double visible = 1e-6;
    const std::string who =
        state == nullptr
            ? ""
            : fmt::format(" (of {})", quoted(moved_bodies(
                                          model, free_motions(model.mechanism, *state), visible)));
    return wrapped(text + fmt::format("{} freedom{} left to the forces{}\n", freedoms.free(),
                                      freedoms.free() == 1 ? " is" : "s are", who),
                   "  ");
  }
  if (freedoms.blocked > 0) {
    text += "no rigid motion follows the drives\n";
  } else {
    text += driven > 0 ? "the drives prescribe it\n" : "nothing can move\n";
  }
  return wrapped(text, "  ");
}

/// Of elastic coordinates "m".
std::string_view unit_of_coordinate(const Model& model, Eigen::Index coordinate) {
  for (const BodyModel& body : model.bodies) {
    const Eigen::Index in_frame = coordinate - body.frame.offset;
    if (in_frame >= body.frame.translations() && in_frame < body.frame.size()) return "rad";
  }
  return "m";
}

std::string assembly_text(const Analysis& analysis) {
  if (analysis.trajectory.periodic) return "";  // starts in the midst of its motion
  const Mechanism& mechanism = analysis.model.mechanism;
  const State initial = analysis.trajectory.state_at(0);
  Eigen::VectorXd shift = difference(mechanism.rotations, initial.q, mechanism.guess.q).cwiseAbs();
  for (const int i : mechanism.elastic) shift(i) = 0.0;
  // Where members start deformed, frames of one beam stand along its curve.
  for (const BodyModel& body : analysis.model.bodies) {
    const bool is_divided = analysis.model.parts(body.name).size() > 1;
    if (!is_divided || !mechanism.starts_in_equilibrium) continue;
    shift.segment(body.frame.offset, body.frame.size()).setZero();
  }
  Eigen::Index largest = 0;
  if (shift.size() == 0 ||
      shift.cwiseQuotient(mechanism.scale).maxCoeff(&largest) <= visible_shift) {
    return "";
  }
  const std::string& name = mechanism.equation_names.at(largest);
  return wrapped(
      fmt::format(
          "{} move the mechanism from where the file places it before the start, most {}, "
          "by {} {}.\n",
          mechanism.starts_in_equilibrium ? "Loads, joints and drives" : "Joints and drives", name,
          significant(shift(largest), 3), unit_of_coordinate(analysis.model, largest)),
      "  ");
}

Json variables_document(const ProblemFile& problem) {
  const NamedUnits units = units_of_variables(problem);
  return named_entries(problem.variables, [&](const DesignVariable& variable) {
    return Json{{"start", variable.start},
                {"lower", variable.lower},
                {"upper", variable.upper},
                {"unit", units.at(variable.name).si}};
  });
}

Json variables_document(const ProblemFile& problem, const Eigen::VectorXd& x) {
  Json document = variables_document(problem);
  for (std::size_t i = 0; i < problem.variables.size(); ++i) {
    const DesignVariable& variable = problem.variables[i];
    Json& entry = document[variable.name];
    entry["value"] = x(i);
    if (const auto choice = size_text(variable, x(i))) entry["choice"] = *choice;
    const std::string reached = reached_bound(variable, x(i));
    if (!reached.empty()) entry["at_bound"] = reached;
  }
  return document;
}

std::string variables_text(const ProblemFile& problem) {
  const NamedUnits units = units_of_variables(problem);
  return table_of(variables_document(problem),
                  {name_column("variable"), shown_column("start", "/start", units),
                   shown_column("lower", "/lower", units), shown_column("upper", "/upper", units),
                   unit_column(units)})
      .text();
}

LawPoints law_points(const TimeFunction& function, double end_time, const Design<double>& design,
                     LawOf purpose) {
  constexpr int points = 240;
  const TimeLaw<double> law = resolve_time_law(function, design, purpose);
  std::set<double> instants;
  for (int i = 0; i <= points; ++i) instants.insert(end_time * i / points);
  for (const double knot : sharp_times(function, end_time)) {
    const double before = std::nextafter(knot, 0.0);
    if (before >= 0.0 && knot <= end_time)
      instants.insert({before, knot, std::nextafter(knot, 1e9)});
  }
  LawPoints curve;
  for (const double instant : instants) {
    curve.times.push_back(instant);
    curve.values.push_back(law.at(instant).value);
  }
  return curve;
}

std::string range_text(const LawPoints& points, const std::string& si) {
  ShownUnit unit = engineering_unit(si);
  if (si == "rad") unit = {si, "°", std::numbers::pi / 180.0};
  const auto [least, most] = std::ranges::minmax(points.values);
  const double low = unit.shown(least), high = unit.shown(most);
  const double size = std::max(std::abs(low), std::abs(high));
  if (high - low <= 1e-9 * size) return fmt::format("{} {}", significant(high, 4), unit.name);
  const auto text = [&](double value) {
    return std::abs(value) <= 1e-9 * size ? std::string("0") : significant(value, 4);
  };
  return fmt::format("{} … {} {}", text(low), text(high), unit.name);
}

std::string joints_text(const ProblemFile& problem) {
  Table table({left_aligned("joint"), left_aligned("kind"), left_aligned("of"), "free in space",
               left_aligned("the second body")});
  for (const Joint& joint : problem.scene.joints) {
    const JointKind& kind = kind_of(joint.type);
    std::string freedom(kind.freedom);
    if (joint.drive) freedom += "; a drive moves it";
    table.add_row({joint.name, std::string(kind.word), both(joint.bodies),
                   fmt::format("{} of 6", kind.freedoms()), freedom});
  }
  return table.is_empty() ? "" : table.text();
}

std::string actions_text(const ProblemFile& problem, const Eigen::VectorXd& x) {
  const Design<double> design(x.begin(), x.end());
  Table table({left_aligned("acts"), left_aligned("kind"), left_aligned("on"),
               left_aligned("smallest … largest")});
  for (const Joint& joint : problem.scene.joints) {
    if (!joint.drive) continue;
    const bool turns = joint.drive->coordinate == DrivenCoordinate::angle;
    const LawPoints points =
        law_points(joint.drive->motion, problem.simulation.end_time, design, LawOf::motion);
    table.add_row({joint.name, turns ? "drive of the angle" : "drive of the displacement",
                   both(joint.bodies), range_text(points, turns ? "rad" : "m")});
  }
  for (const Load& load : problem.scene.loads) {
    std::vector<std::string> cells =
        std::visit(ActionRow{problem.simulation.end_time, design}, load.element);
    cells.insert(cells.begin(), load.name);
    table.add_row(std::move(cells));
  }
  return table.is_empty() ? "" : table.text();
}

std::string spring_text(const SpringDamper& spring, const Design<double>& design) {
  return joined({constant_text("stiffness", resolve(spring.stiffness, design), "N/m"),
                 constant_text("damping", resolve(spring.damping, design), "N s/m"),
                 resistance_text(spring.resistance)});
}

std::string spring_text(const JointForce& force, const Design<double>& design) {
  const bool turns = force.coordinate == DrivenCoordinate::angle;
  return joined(
      {constant_text("stiffness", resolve(force.stiffness, design), turns ? "N m/rad" : "N/m"),
       constant_text("damping", resolve(force.damping, design), turns ? "N m s/rad" : "N s/m"),
       resistance_text(force.resistance)});
}

}  // namespace pleuel
