#pragma once

#include <cmath>
#include <string>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/response/analysis.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/test.hpp"

/// Starts from elastic equilibrium, and why there is none.
namespace pleuel::test::quasi_static_beam {

inline constexpr double young = 2.1e11, width = 0.02, height = 0.002;
inline const double stiffness = young * width * std::pow(height, 3) / 12;  // length 1

inline std::string joint(const std::string& name, const std::string& type, double x,
                         const std::string& axis = "") {
  return fmt::format(R"("{}": {{"type": "{}", "bodies": ["ground", "b"], "at": [{}, 0, 0]{}}})",
                     name, type, x, axis.empty() ? "" : ", \"axis\": " + axis);
}

/// One beam along x, thin in the plane; loads in the plane at its end.
inline std::string beam(const std::string& joints, double axial, double transverse,
                        int elements = 8, const std::string& effects = "{}",
                        const std::string& frame = "tangent") {
  return fmt::format(R"({{"scene": {{
      "materials": {{"m": {{"young": 2.1e11, "poisson": 0.3, "density": 7850}}}},
      "bodies": {{"b": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "m",
                       "section": {{"type": "rectangle", "width": 0.02, "height": 0.002}},
                       "elements": {}, "frame": "{}"}}}},
      "joints": {{{}}},
      "loads": {{"n": {{"type": "force", "body": "b", "at": [1, 0, 0], "direction": [1, 0, 0], "value": {}}},
               "p": {{"type": "force", "body": "b", "at": [1, 0, 0], "direction": [0, 1, 0], "value": {}}}}}}},
      "effects": {},
      "simulation": {{"end_time": 0.001, "step": 0.001, "initial_state": "quasi-static"}},
      "responses": {{
        "x": {{"type": "position", "body": "b", "at": 1, "direction": "x", "over_time": "final"}},
        "y": {{"type": "position", "body": "b", "at": 1, "direction": "y", "over_time": "final"}}}}}})",
                     elements, frame, joints, axial, transverse, effects);
}

/// Tip x and y where the motion begins.
inline Eigen::Vector2d tip(const std::string& text) {
  const ProblemFile problem = problem_from(text);
  const auto analysis = analyze(problem, start_design(problem));
  return {analysis->histories[0](0, 0), analysis->histories[1](0, 0)};
}

inline std::string error_of(const std::string& text) {
  return thrown<SimulationError>([&] { tip(text); });
}

inline const std::string clamp = joint("c", "fixed", 0);

}  // namespace pleuel::test::quasi_static_beam
