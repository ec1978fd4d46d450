#pragma once

#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/response/analysis.hpp"
#include "tests/support/problem_runs.hpp"

namespace pleuel::test {

/// A value of a problem file, as it is written there.
struct Written : std::string {
  Written(const char* text) : std::string(text) {}
  Written(const std::string& text) : std::string(text) {}
  Written(double number) : std::string(fmt::format("{}", number)) {}
};

inline std::string rectangle(const Written& width, const Written& height) {
  return fmt::format(R"({{"type": "rectangle", "width": {}, "height": {}}})", width, height);
}
inline std::string circle(const Written& diameter) {
  return fmt::format(R"({{"type": "circle", "diameter": {}}})", diameter);
}

/// Materials without a strength; the light one weighs next to nothing.
inline const std::string plain_steel =
    R"("steel": {"young": 2.1e11, "poisson": 0.3, "density": 7850})";
inline const std::string plain_aluminium =
    R"("aluminium": {"young": 7e10, "poisson": 0.3, "density": 2700})";
inline const std::string light = R"("light": {"young": 2.1e11, "poisson": 0.3, "density": 1})";

/// A time loop, and one that begins in equilibrium with the loads.
inline std::string time_loop(const Written& end_time, const Written& step,
                             const std::string& more = "") {
  return fmt::format(R"("end_time": {}, "step": {}{}{})", end_time, step, more.empty() ? "" : ", ",
                     more);
}
inline std::string at_rest(const Written& end_time, const Written& step) {
  return time_loop(end_time, step, R"("initial_state": "quasi-static")");
}

/// A load at the end of a beam; they are called push0, push1, … unless they have names.
struct EndLoad {
  Written value, direction = "[0, 1, 0]";
  std::string more = "", name = "", type = "force";
};

/// A problem file with one beam: of steel, one metre along x, clamped where it begins, in equilibrium
/// with its loads, unless it says otherwise. Its numbers and parts are written as in a file, with or without a comma in
/// front.
struct OneBeam {
  std::string name = "beam", material = "steel", from = "[0, 0, 0]", to = "[1, 0, 0]";
  std::string section = rectangle(0.02, 0.02);
  int elements = 4;
  std::string more = "";       ///< further keys of the beam
  std::string materials = "";  ///< by name
  std::string bodies = "";     ///< beside the beam
  std::string joints = "";     ///< in place of the clamp
  std::vector<EndLoad> end_loads = {};
  std::string loads = "";  ///< further ones
  std::string gravity = "[0, 0, 0]";
  std::string simulation = R"("end_time": 2e-4, "step": 1e-4, "initial_state": "quasi-static")";
  std::string responses = R"("mass": {"type": "mass"})";
  std::string rest = "";  ///< further parts of the file

  std::string text() const {
    const auto added = [](const std::string& parts) {
      return parts.empty() || parts.front() == ',' ? parts : ", " + parts;
    };
    std::string all = loads;
    for (std::size_t i = 0; i < end_loads.size(); ++i) {
      const EndLoad& one = end_loads[i];
      all += fmt::format(
          R"({}"{}": {{"type": "{}", "body": "{}", "at": {}, "direction": {}, "value": {}{}}})",
          all.empty() ? "" : ", ", one.name.empty() ? fmt::format("push{}", i) : one.name, one.type,
          name, to, one.direction, one.value, added(one.more));
    }
    const std::string clamp = fmt::format(
        R"("clamp": {{"type": "fixed", "bodies": ["ground", "{}"], "at": {}}})", name, from);
    return fmt::format(
        R"({{"scene": {{"gravity": {}, "materials": {{{}}}, "bodies": {{
          "{}": {{"type": "beam", "from": {}, "to": {}, "material": "{}", "elements": {}, "section": {}{}}}{}}},
        "joints": {{{}}}, "loads": {{{}}}}},
      "simulation": {{{}}}, "responses": {{{}}}{}}})",
        gravity, materials, name, from, to, material, elements, section, added(more), added(bodies),
        joints.empty() ? clamp : joints, all, simulation, responses, added(rest));
  }
  ProblemFile problem(const std::vector<std::string>& overrides = {}) const {
    return problem_from(text(), overrides);
  }
};

/// A joint of a body and the ground, by its keys.
inline std::string on_ground(const std::string& name, const std::string& type,
                             const std::string& body, const std::string& at,
                             const std::string& more = "") {
  return fmt::format(R"("{}": {{"type": "{}", "bodies": ["ground", "{}"], "at": {}{}}})", name,
                     type, body, at, more.empty() ? "" : ", " + more);
}

/// A pin at the origin, where a beam begins, and a line along x that its other end keeps to.
inline std::string on_two_supports(const std::string& body, const std::string& to = "[1, 0, 0]") {
  return on_ground("pin", "revolute", body, "[0, 0, 0]") + ", " +
         on_ground("line", "point-on-line", body, to, R"("axis": [1, 0, 0])");
}

/// A cantilever of 1 m along x that starts and stays in equilibrium under loads at its tip. It has
/// a square section with E I = 100 N m².
struct BentCantilever {
  double force_y = 0.0, force_z = 0.0;  ///< at the tip, of fixed direction [N]
  double force_x = 0.0;                 ///< along the beam [N]
  double moment_z = 0.0;                ///< at the tip [N m]
  int frames = 1, elements = 16;
  std::string motion = "auto", frame = "tangent", stiffening = "on";
  std::string section = R"({"type": "rectangle", "width": 0.01, "height": 0.01})";
  std::string more = "";  ///< further keys of the beam, with a comma in front

  static constexpr double bending_stiffness = 100.0;  ///< [N m²]

  OneBeam beam() const {
    OneBeam beam{.material = "soft",
                 .section = section,
                 .elements = elements,
                 .more = fmt::format(R"("frames": {}, "frame": "{}"{})", frames, frame, more),
                 .materials = R"("soft": {"young": 1.2e11, "poisson": 0.3, "density": 1000})",
                 .responses = responses(),
                 .rest = fmt::format(
                     R"("effects": {{"spatial_motion": "{}", "geometric_stiffening": "{}"}})",
                     motion, stiffening)};
    const auto add = [&](double value, const char* direction, const char* type) {
      if (value != 0.0) beam.end_loads.push_back({value, direction, "", "", type});
    };
    add(force_y, "[0, 1, 0]", "force");
    add(force_z, "[0, 0, 1]", "force");
    add(force_x, "[1, 0, 0]", "force");
    add(moment_z, "[0, 0, 1]", "torque");
    return beam;
  }

  static std::string responses() {
    return R"(
      "x": {"type": "position", "body": "beam", "at": 1, "direction": "x", "over_time": "final"},
      "y": {"type": "position", "body": "beam", "at": 1, "direction": "y", "over_time": "final"},
      "z": {"type": "position", "body": "beam", "at": 1, "direction": "z", "over_time": "final"},
      "tip": {"type": "deflection", "body": "beam", "at": 1, "over_time": "final"},
      "root": {"type": "stress", "body": "beam", "at": 0, "over_time": "max"},
      "cut": {"type": "stress", "body": "beam", "at": 0.5, "part": "bending", "over_time": "max"},
      "stress": {"type": "stress", "body": "beam", "over_time": "max"})";
  }

  ProblemFile problem() const { return beam().problem(); }
};

/// Elastica: tip of a cantilever under a force of fixed direction, α = P L²/(E I); a shooting
/// method, ten digits.
struct ElasticaTip {
  double load, rotation, shortening, deflection;
};
inline constexpr ElasticaTip elastica_tips[] = {{0.25, 0.1242924421, 0.0041178184, 0.0827459154},
                                                {0.5, 0.2445336471, 0.0159189625, 0.1621435757},
                                                {1.0, 0.4613519497, 0.0564332363, 0.3017207738},
                                                {2.0, 0.7817498316, 0.1606417208, 0.4934574804}};

}  // namespace pleuel::test
