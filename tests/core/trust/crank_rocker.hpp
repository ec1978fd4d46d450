#pragma once

#include <string>

#include <fmt/format.h>

namespace pleuel::test {

/// A crank-rocker of steel rods, with gravity and without.
inline std::string crank_rocker(const std::string& drive, const std::string& more_joints,
                                const std::string& gravity = "[0, 0, 0]") {
  const auto rod = [](const char* name, const char* from, const char* to) {
    return fmt::format(
        R"("{}": {{"type": "beam", "from": {}, "to": {}, "material": "steel", "rigid": true, "elements": 1,
            "section": {{"type": "circle", "diameter": "20 mm"}}}})",
        name, from, to);
  };
  return fmt::format(
      R"({{"scene": {{"gravity": {}, "bodies": {{{}, {}, {}}},
          "joints": {{"A": {{"type": "revolute", "bodies": ["ground", "crank"], "at": [0, 0, 0]{}}},
                      "B": {{"type": "revolute", "bodies": ["crank", "coupler"], "at": [0.1, 0, 0]}},
                      "C": {{"type": "revolute", "bodies": ["coupler", "rocker"], "at": [0.4, 0.2, 0]}}{}}}}},
          "simulation": {{"end_time": 0.05, "step": 0.001}},
          "responses": {{"m": {{"type": "mass"}},
                         "v": {{"type": "velocity", "body": "rocker", "at": 1, "direction": "magnitude",
                                "over_time": "max"}}}}}})",
      gravity, rod("crank", "[0, 0, 0]", "[0.1, 0, 0]"),
      rod("coupler", "[0.1, 0, 0]", "[0.4, 0.2, 0]"), rod("rocker", "[0.4, 0.2, 0]", "[0.4, 0, 0]"),
      drive, more_joints);
}
inline const std::string driven = R"(, "drive": {"type": "constant-speed", "speed": "300 rpm"})";
inline const std::string closed =
    R"(, "D": {"type": "revolute", "bodies": ["ground", "rocker"], "at": [0.4, 0, 0]})";

}  // namespace pleuel::test
