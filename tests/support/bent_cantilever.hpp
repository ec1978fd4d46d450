#pragma once

#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/response/analysis.hpp"
#include "tests/support/problem_runs.hpp"

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

  std::string loads() const {
    std::string list;
    const auto add = [&](const char* type, const char* direction, double value) {
      if (value == 0.0) return;
      list += fmt::format(
          R"({}"{} {}": {{"type": "{}", "body": "beam", "at": [1, 0, 0], "direction": {}, "value": {}}})",
          list.empty() ? "" : ", ", type, direction, type, direction, value);
    };
    add("force", "[0, 1, 0]", force_y);
    add("force", "[0, 0, 1]", force_z);
    add("force", "[1, 0, 0]", force_x);
    add("torque", "[0, 0, 1]", moment_z);
    return list;
  }

  std::string text() const {
    return fmt::format(
        R"({{"name": "bent", "scene": {{"gravity": [0, 0, 0],
          "materials": {{"soft": {{"young": 1.2e11, "poisson": 0.3, "density": 1000}}}},
          "bodies": {{"beam": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0],
            "material": "soft", "section": {}, "elements": {}, "frames": {}, "frame": "{}"{}}}}},
          "joints": {{"clamp": {{"type": "fixed", "bodies": ["ground", "beam"], "at": [0, 0, 0]}}}},
          "loads": {{{}}}}},
        "effects": {{"spatial_motion": "{}", "geometric_stiffening": "{}"}},
        "simulation": {{"end_time": 2e-4, "step": 1e-4, "initial_state": "quasi-static"}},
        "responses": {{{}}}}})",
        section, elements, frames, frame, more, loads(), motion, stiffening, responses());
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

  pleuel::ProblemFile problem() const { return problem_from(text()); }
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
