#pragma once

#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "tests/support/problem_runs.hpp"

/// Mechanisms whose motion repeats itself.
namespace pleuel::test::steady {

/// Runs steadily at 50 rad/s, 500 steps a turn, with much damping in the members.
inline ProblemFile slider_crank(std::vector<std::string> overrides = {}) {
  for (const char* body : {"crank", "rod"}) {
    overrides.push_back(std::string("/scene/bodies/") + body + "/damping/stiffness=2e-4 s");
  }
  overrides.insert(
      overrides.begin(),
      {R"(/scene/joints/bearing/drive={"type": "constant-speed", "speed": "50 rad/s"})",
       "/simulation/end_time=0.12566370614359174", "/simulation/step=2.5132741228718346e-4 s",
       "/simulation/initial_state=periodic", "/scene/bodies/crank/elements=2",
       "/scene/bodies/rod/elements=4"});
  return sample_problem("slider_crank", overrides);
}

inline ProblemFile four_bar(std::vector<std::string> overrides = {}) {
  for (const char* body : {"crank", "coupler", "rocker"}) {
    overrides.push_back(std::string("/scene/bodies/") + body + "/damping/stiffness=2e-4 s");
  }
  overrides.insert(
      overrides.begin(),
      {R"(/scene/joints/crank_bearing/drive={"type": "constant-speed", "speed": "50 rad/s"})",
       "/simulation/end_time=0.12566370614359174", "/simulation/step=2.5132741228718346e-4 s",
       "/simulation/initial_state=periodic"});
  return sample_problem("four_bar", overrides);
}

/// Turned by a motor that is controlled towards 50 rad/s: the crank is free to turn, too.
inline ProblemFile motor() {
  return four_bar(
      {R"(/scene/joints/crank_bearing={"type": "revolute", "bodies": ["ground", "crank"], "at": [0, 0, 0]})",
       R"(/scene/loads/motor={"type": "joint", "joint": "crank_bearing", "motor": {
          "type": "control", "target": {"type": "constant-speed", "speed": "50 rad/s"},
          "proportional": "100 N m/rad", "derivative": "2 N m s/rad"}})",
       R"(/responses/torque_peak={"type": "motor-power", "load": "motor", "over_time": "max"})"});
}

/// In space, at 60 rad/s.
inline ProblemFile spatial(std::vector<std::string> overrides = {}) {
  for (const char* body : {"crank", "rod"}) {
    overrides.push_back(std::string("/scene/bodies/") + body +
                        "/damping={\"stiffness\": \"2e-4 s\"}");
  }
  overrides.insert(
      overrides.begin(),
      {R"(/scene/joints/bearing/drive={"type": "constant-speed", "speed": "60 rad/s"})",
       "/simulation/end_time=0.10471975511965977", "/simulation/step=3.4906585039886593e-4 s",
       "/simulation/initial_state=periodic"});
  return sample_problem("spatial_slider_crank", overrides);
}

inline ProblemFile six_bar(const std::vector<std::string>& overrides = {}) {
  return sample_problem("running_press", overrides);
}

/// A mass on a spring and a damper under a harmonic force, m = 2 kg, k = 800 N/m, F = 5 N at
/// ω = 30 rad/s.
/// @param damper  of the joint, in its words; @param frequency  of the force, likewise
struct Oscillator {
  static constexpr double frequency = 30.0, m = 2.0, k = 800.0, force = 5.0;
  static constexpr int steps = 40;
  static constexpr double period = 2.0 * std::numbers::pi / frequency;

  static ProblemFile with(const std::string& damper, const std::string& frequency_text = "30") {
    constexpr const char* variable =
        R"("variables": {"speed": {"start": 30, "lower": 20, "upper": 40}},)";
    const bool is_variable = frequency_text != "30";
    return problem_from(fmt::format(R"({{"name": "oscillator", "scene": {{"gravity": [0, 0, 0],
        "bodies": {{"mass": {{"type": "point-mass", "at": [0, 0, 0], "mass": {}}}}},
        "joints": {{"guide": {{"type": "point-on-line", "bodies": ["ground", "mass"],
                               "at": [0, 0, 0], "axis": [1, 0, 0]}}}},
        "loads": {{"spring": {{"type": "joint", "joint": "guide", "stiffness": {}, {}}},
          "push": {{"type": "force", "body": "mass", "at": [0, 0, 0], "direction": [1, 0, 0],
            "value": {{"type": "harmonic", "amplitude": {}, "frequency": {}}}}}}}}},
        "simulation": {{"end_time": {:.17g}, "step": {:.17g}, "initial_state": "periodic",
                        "newton_tolerance": 1e-14}},
        {}
        "responses": {{"x": {{"type": "position", "body": "mass", "direction": "x", "over_time": "max"}}}}}})",
                                    m, k, damper, force, frequency_text, period, period / steps,
                                    is_variable ? variable : ""));
  }
};

}  // namespace pleuel::test::steady
