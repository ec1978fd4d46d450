#pragma once

#include <nlohmann/json.hpp>

#include "optimization/design/design_solve.hpp"
#include "tests/optimization/known_problems.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test {

/// Half a turn of a slender crank with a load at its end, at two speeds and with two loads.
inline nlohmann::ordered_json loaded_crank() {
  return nlohmann::ordered_json::parse(R"json({
    "scene": {"gravity": [0, "-9.81 m/s^2", 0],
      "bodies": {
        "crank": {"type": "beam", "from": [0, 0, 0], "to": ["200 mm", 0, 0], "material": "steel",
                  "section": {"type": "rectangle", "width": {"variable": "width"},
                              "height": {"variable": "height"}},
                  "elements": 2, "frame": "tangent", "damping": {"stiffness": "1e-4 s"}},
        "load": {"type": "point-mass", "at": ["200 mm", 0, 0], "mass": "0.5 kg"}},
      "joints": {
        "hub": {"type": "revolute", "bodies": ["ground", "crank"], "at": [0, 0, 0],
                "drive": {"type": "ramp-to-speed", "speed": "60 rad/s", "ramp": "40 ms"}},
        "clamp": {"type": "fixed", "bodies": ["crank", "load"], "at": ["200 mm", 0, 0]}
      }
    },
    "simulation": {"end_time": "60 ms", "step": "0.5 ms", "resolution_check": false},
    "variables": {"width": {"start": "8 mm", "lower": "4 mm", "upper": "40 mm"},
      "height": {"start": "12 mm", "lower": "4 mm", "upper": "40 mm"}},
    "responses": {"mass": {"type": "mass", "bodies": ["crank"]},
      "stress": {"type": "stress", "body": "crank", "over_time": "max"},
      "tip": {"type": "deflection", "body": "crank", "at": 1, "over_time": "max-abs"},
      "torque": {"type": "drive-torque", "joint": "hub", "over_time": "max-abs"}
    },
    "objective": {"minimize": "mass"},
    "constraints": {"strength": {"response": "stress", "upper": "60 MPa"},
      "stiffness": {"response": "tip", "upper": "0.2 mm"},
      "shape": {"linear": {"height": 1, "width": -2}, "upper": 0}
    },
    "sensitivity": {"method": "direct"},
    "cases": {"fast": {}, "heavy": {"/scene/bodies/load/mass": "2 kg", "/scene/joints/hub/drive/speed": "30 rad/s"}}
  })json");
}

/// What a search from the start of a problem file ends with: an optimum, or a failure of the test.
inline Result verified_optimum(const ProblemFile& file, const SolveOptions& options = {}) {
  DesignProblem design(file);
  return verified(solve_design(design, options));
}

}  // namespace pleuel::test
