#pragma once

#include <string>
#include <vector>

#include "core/response/analysis.hpp"
#include "sensitivity/finite_difference.hpp"
#include "sensitivity/sampled_gradients.hpp"
#include "tests/support/problem_runs.hpp"

namespace pleuel::test {

/// A block of 2 kg on a slide, and a force along it; both horizontal. The slide also carries the
/// force across it.
inline ProblemFile pushed_block(const std::string& value,
                                const std::vector<std::string>& overrides = {}) {
  return problem_from(R"({
  "scene": {"bodies": {"block": {"type": "rigid", "at": [0, 0, 0], "mass": 2, "inertia": [1, 1, 1, 0, 0, 0]}},
    "joints": {"slide": {"type": "prismatic", "bodies": ["ground", "block"], "at": [0, 0, 0], "axis": [1, 0, 0]}},
    "loads": {
      "push": {"type": "force", "body": "block", "at": [0, 0, 0], "direction": [1, 0, 0], "value": )" +
                          value + R"(},
      "press": {"type": "force", "body": "block", "at": [0, 0, 0], "direction": [0, -1, 0], "value": )" +
                          value + R"(}
    }
  },
  "simulation": {"end_time": 0.1, "step": 1e-3},
  "responses": {
    "x": {"type": "position", "body": "block", "direction": "x", "over_time": "final"},
    "v": {"type": "velocity", "body": "block", "direction": "x", "over_time": "final"},
    "reaction": {"type": "reaction-force", "joint": "slide", "direction": "magnitude", "over_time": "max"}
  }
})",
                      overrides);
}

/// A clamped steel beam of 1 m under its weight and a force across its tip; its height and the
/// force are variables.
inline ProblemFile loaded_cantilever(const std::string& value,
                                     const std::vector<std::string>& overrides = {}) {
  return problem_from(R"({
  "scene": {"gravity": [0, -9.81, 0],
    "bodies": {"beam": {"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "steel",
      "section": {"type": "rectangle", "width": 0.02, "height": {"variable": "height"}}, "elements": 4, "damping": {"stiffness": 1e-3}}},
    "joints": {"clamp": {"type": "fixed", "bodies": ["ground", "beam"], "at": [0, 0, 0]}},
    "loads": {"push": {"type": "force", "body": "beam", "at": [1, 0, 0], "direction": [0, -1, 0], "value": )" +
                          value + R"(}}
  },
  "simulation": {"end_time": 0.1, "step": 1e-3, "initial_state": "quasi-static"},
  "variables": {"height": {"start": 0.03, "lower": 0.01, "upper": 0.1},
                "force": {"start": 50, "lower": 0, "upper": 500}},
  "responses": {
    "sag": {"type": "deflection", "body": "beam", "at": 1, "over_time": "min"},
    "end": {"type": "deflection", "body": "beam", "at": 1, "over_time": "final"},
    "stress": {"type": "stress", "body": "beam", "over_time": "max"},
    "reaction": {"type": "reaction-force", "joint": "clamp", "direction": "y", "over_time": "mean"}
  },
  "objective": {"minimize": "stress"}
})",
                      overrides);
}

inline double value_at_start(const ProblemFile& problem, const std::string& response) {
  const auto analysis = analyze(problem, start_design(problem));
  return values_of(*analysis)(response_index(problem, response));
}

/// Gradients of all responses of a problem at its start, by three ways: responses × variables.
struct LawGradients {
  Eigen::MatrixXd direct, adjoint;
  Eigen::MatrixXd differences;  ///< of simulations, central, with one Richardson step
};

inline LawGradients law_gradients(const ProblemFile& problem) {
  const Eigen::VectorXd x = start_design(problem);
  const auto analysis = analyze(problem, x);
  const std::vector<SampledValue> values = response_values(*analysis);
  const Eigen::MatrixXd wide = central_differences(problem, x, 1e-3),
                        narrow = central_differences(problem, x, 5e-4);
  return {sampled_gradients(*analysis, values, ExactMethod::direct),
          sampled_gradients(*analysis, values, ExactMethod::adjoint), (4.0 * narrow - wide) / 3.0};
}

}  // namespace pleuel::test
