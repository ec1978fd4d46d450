#pragma once

#include <string>
#include <vector>

#include "tests/support/problem_runs.hpp"

namespace pleuel::test {

/// Of the elastic arm.
inline constexpr const char* arm_responses = R"(
      "bending": {"type": "stress", "body": "arm", "over_time": "max"},
      "root": {"type": "stress", "body": "arm", "at": 0, "over_time": "max"},
      "tip_x": {"type": "position", "body": "arm", "at": 1, "direction": "x", "over_time": "max"},
      "tip_y": {"type": "position", "body": "arm", "at": 1, "direction": "y", "over_time": "max"})";

/// A cantilevered arm that a drive turns in the x–y plane at constant speed; where the file says
/// so, it is rigid or divided into frames.
inline ProblemFile turning_arm(const std::string& more,
                               const std::vector<std::string>& overrides = {}) {
  const bool is_rigid = more.find("rigid") != std::string::npos;
  const std::string text = R"({
    "scene": {
      "materials": {"steel": {"young": 2.1e11, "poisson": 0.3, "density": 7850}},
      "bodies": {
        "arm": {"type": "beam", "from": [0, 0, 0], "to": [0.4, 0, 0], "material": "steel",
                "section": {"type": "rectangle", "width": 0.01, "height": 0.02}, "elements": 4, )" +
                           more + R"(},
        "ball": {"type": "point-mass", "at": [0.4, 0, 0], "mass": 0.3}
      },
      "joints": {
        "hub": {"type": "revolute", "bodies": ["ground", "arm"], "at": [0, 0, 0],
                "drive": {"type": "constant-speed", "speed": 20}},
        "end": {"type": "revolute", "bodies": ["arm", "ball"], "at": [0.4, 0, 0]}
      }
    },
    "simulation": {"end_time": 0.1, "step": 5e-4},
    "responses": {)" + std::string(is_rigid ? "" : arm_responses) +
                           R"(}
  })";
  return problem_from(text, overrides);
}

}  // namespace pleuel::test
