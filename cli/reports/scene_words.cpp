#include "cli/reports/scene_words.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <fmt/format.h>

#include "cli/text/table.hpp"
#include "core/base/number_text.hpp"
#include "core/scene/joint_kind.hpp"
#include "core/scene/shown_unit.hpp"
#include "core/scene/time_breaks.hpp"

namespace pleuel {

namespace {

std::string both(const std::array<std::string, 2>& bodies) {
  return bodies[0] + " – " + bodies[1];
}

std::string joined(std::vector<std::string> parts) {
  std::string text;
  for (const std::string& part : parts) {
    if (!part.empty()) text += (text.empty() ? "" : ", ") + part;
  }
  return text;
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
class ActionRow {
 public:
  ActionRow(const ProblemFile& problem, const Design<double>& design)
      : end_time_(problem.simulation.end_time), design_(design) {}

  std::vector<std::string> operator()(const PointForce& load) const {
    return {"force", load.body, value_text(load, "N")};
  }
  std::vector<std::string> operator()(const PointTorque& load) const {
    return {"torque", load.body, value_text(load, "N m")};
  }
  std::vector<std::string> operator()(const SpringDamper& load) const {
    return {"spring", both(load.bodies), spring_text(load, design_)};
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
    return {"in the joint", load.joint, joined({spring_text(load, design_), motor})};
  }

 private:
  template <class PointLoad>
  std::string value_text(const PointLoad& load, const char* unit) const {
    if (!load.over) return range_text(points(load.value), unit);
    const bool turns = load.over->coordinate == DrivenCoordinate::angle;
    return fmt::format("over the {} of {}", turns ? "angle" : "displacement", load.over->joint);
  }
  LawPoints points(const TimeFunction& function) const {
    return law_points(function, end_time_, design_, LawOf::load);
  }

  double end_time_;
  const Design<double>& design_;
};

}  // namespace

double LawPoints::lowest() const {
  return *std::min_element(values.begin(), values.end());
}

double LawPoints::highest() const {
  return *std::max_element(values.begin(), values.end());
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
  const double low = unit.shown(points.lowest()), high = unit.shown(points.highest());
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
    std::vector<std::string> cells = std::visit(ActionRow(problem, design), load.element);
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
