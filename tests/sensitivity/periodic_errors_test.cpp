/// Motions that are no repeated ones, and what is said of them.

#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/response/analysis.hpp"
#include "core/scene/problem_reader.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/sensitivity/steady_machines.hpp"

namespace pleuel::test::periodic_errors_test {
namespace {

using namespace steady;

std::string failure_of(const ProblemFile& file) {
  try {
    analyze(file, start_design(file));
  } catch (const SimulationError& error) {
    return error.what();
  }
  return "none";
}

TEST(SteadyMachineErrors, NameADriveThatDoesNotRepeatItself) {
  const std::string failure =
      failure_of(four_bar({"/scene/joints/crank_bearing/drive/speed=49 rad/s"}));
  EXPECT_THAT(failure, testing::HasSubstr("crank_bearing"));
  EXPECT_THAT(failure, testing::HasSubstr("whole turns"));
}

/// A period that somebody rounded: the crank goes on by 1e-6 of a turn.
TEST(SteadyMachineErrors, TellARoundedPeriod) {
  const std::string failure =
      failure_of(four_bar({"/scene/joints/crank_bearing/drive/speed=50.00005 rad/s"}));
  EXPECT_THAT(failure, testing::HasSubstr("goes through 360.00036 deg: if that is to be 360, write "
                                          "the period as a formula"));
}

TEST(SteadyMachineErrors, NameALoadThatDoesNotRepeatItself) {
  const std::string failure = failure_of(
      four_bar({R"(/scene/loads/push={"type": "force", "body": "rocker", "at": ["400 mm", 0, 0],
          "direction": [1, 0, 0], "value": {"type": "harmonic", "amplitude": 1, "frequency": 60}})"}));
  EXPECT_THAT(failure, testing::HasSubstr("push"));
}

/// Pushed along by 0.1 N s/m of its speed it grows by 0.5 % in a period.
TEST(SteadyMachineErrors, TellAMotionThatGrows) {
  const std::string failure = failure_of(
      Oscillator::with(R"("motor": {"type": "expression", "value": "= 0.1 N s/m*speed"})"));
  EXPECT_THAT(failure, testing::HasSubstr("is unstable: disturbances grow by 0.5"));
}

/// The motion of this design repeats itself; those of others do not with its period.
TEST(SteadyMachineErrors, NameAVariableThatSetsThePeriod) {
  const ProblemFile file = Oscillator::with(R"("damping": 8)", R"({"variable": "speed"})");
  const Eigen::VectorXd x = start_design(file);
  const auto analysis = analyze(file, x);
  for (const GradientMethod method : {GradientMethod::direct, GradientMethod::adjoint}) {
    try {
      gradients(file, x, *analysis, method);
      ADD_FAILURE() << "no complaint";
    } catch (const SimulationError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("push no longer repeats itself"));
    }
  }
}

TEST(SteadyMachineErrors, NameAMotionThatNothingBringsBack) {
  const std::string failure = failure_of(read_problem_text(
                                             R"({"name": "free", "scene": {"gravity": [0, 0, 0],
        "bodies": {"cart": {"type": "point-mass", "at": [0, 0, 0], "mass": 1}},
        "joints": {"guide": {"type": "point-on-line", "bodies": ["ground", "cart"],
                             "at": [0, 0, 0], "axis": [1, 0, 0]}},
        "loads": {"push": {"type": "force", "body": "cart", "at": [0, 0, 0],
          "direction": [1, 0, 0],
          "value": {"type": "harmonic", "amplitude": 1, "frequency": 62.83185307179586}}}},
        "simulation": {"end_time": 0.1, "step": 1e-3, "initial_state": "periodic"},
        "responses": {"x": {"type": "position", "body": "cart", "direction": "x",
                            "over_time": "max"}}})",
                                             "free.json")
                                             .complete());
  EXPECT_THAT(failure, testing::HasSubstr("\"cart\""));
  EXPECT_THAT(failure, testing::HasSubstr("nothing has brought back"));
}

/// A disc on a tube, twisted to and fro without damping: neither grows nor dies, wherever in its
/// period it begins. On the way to its motion it turns on the average, and that motion would grow.
TEST(SteadyMachineErrors, AreNoneOfAMotionThatIsFoundFromOneThatGrows) {
  for (const double phase : {0.0, 90.0}) {
    const ProblemFile disc =
        read_problem_text(fmt::format(R"({{"scene": {{"gravity": [0, 0, 0], "bodies": {{
              "tube": {{"type": "beam", "from": [0, 0, 0], "to": [0, 0, 0.6], "material": "steel",
                "section": {{"type": "tube", "outer_diameter": 0.03, "thickness": 0.003}},
                "elements": 4}},
              "disc": {{"type": "rigid", "at": [0, 0, 0.6], "mass": 20,
                "inertia": [0.2, 0.2, 0.4, 0, 0, 0]}}}},
            "joints": {{
              "wall": {{"type": "fixed", "bodies": ["ground", "tube"], "at": [0, 0, 0]}},
              "hub": {{"type": "fixed", "bodies": ["tube", "disc"], "at": [0, 0, 0.6]}}}},
            "loads": {{"twist": {{"type": "torque", "body": "disc", "at": [0, 0, 0.6],
              "direction": [0, 0, 1], "value": {{"type": "harmonic", "amplitude": 1,
                "frequency": "40 Hz", "phase": "{} deg"}}}}}}}},
          "simulation": {{"end_time": 0.025, "step": 1e-4, "initial_state": "periodic"}},
          "responses": {{"hold": {{"type": "reaction-moment", "joint": "wall", "direction": "z",
                                   "over_time": "max"}}}}}})",
                                      phase),
                          "disc.json")
            .complete();
    EXPECT_EQ(failure_of(disc), "none") << phase;
  }
}

/// A screen on two leaf springs, shaken by a mass that turns in it.
ProblemFile screen(int revolutions_per_minute) {
  return read_problem_text(
             fmt::format(R"j({{"constants": {{"n": "{} rpm", "tilt": "25 deg", "len": "350 mm"}},
    "scene": {{"bodies": {{
      "left": {{"type": "beam", "from": [0, 0, 0], "to": ["= -len*sin(tilt)", "= len*cos(tilt)", 0],
        "material": "steel", "elements": 4, "damping": {{"stiffness": "0.5 ms"}},
        "section": {{"type": "rectangle", "width": "120 mm", "height": "5 mm"}}}},
      "right": {{"type": "beam", "from": [0.8, 0, 0], "to": ["= 800 mm - len*sin(tilt)", "= len*cos(tilt)", 0],
        "material": "steel", "elements": 4, "damping": {{"stiffness": "0.5 ms"}},
        "section": {{"type": "rectangle", "width": "120 mm", "height": "5 mm"}}}},
      "trough": {{"type": "rigid", "at": ["= 400 mm - len*sin(tilt)", "= len*cos(tilt) + 50 mm", 0], "mass": 80,
        "inertia": [0, 0, 8, 0, 0, 0]}},
      "unbalance": {{"type": "rigid", "at": ["= 460 mm - len*sin(tilt)", "= len*cos(tilt) + 50 mm", 0], "mass": 5,
        "inertia": [0, 0, 0.002, 0, 0, 0], "angular_velocity": [0, 0, "= n"], "velocity": [0, "= 60 mm*n/(1 rad)", 0]}}}},
    "joints": {{
      "foot_left": {{"type": "fixed", "bodies": ["ground", "left"], "at": [0, 0, 0]}},
      "foot_right": {{"type": "fixed", "bodies": ["ground", "right"], "at": [0.8, 0, 0]}},
      "top_left": {{"type": "fixed", "bodies": ["left", "trough"], "at": ["= -len*sin(tilt)", "= len*cos(tilt)", 0]}},
      "top_right": {{"type": "fixed", "bodies": ["right", "trough"],
        "at": ["= 800 mm - len*sin(tilt)", "= len*cos(tilt)", 0]}},
      "motor": {{"type": "revolute", "bodies": ["trough", "unbalance"],
        "at": ["= 400 mm - len*sin(tilt)", "= len*cos(tilt) + 50 mm", 0],
        "drive": {{"type": "constant-speed", "speed": "= n"}}}}}}}},
  "simulation": {{"end_time": "= 2*pi*1 rad/n", "step": "0.2 ms", "initial_state": "periodic"}},
  "responses": {{"mass": {{"type": "mass"}}}}}})j",
                         revolutions_per_minute),
             "screen.json")
      .complete();
}

/// Stiff coordinates are counted in units far from those of the soft ones: that is no round-off.
TEST(SteadyMachines, AreFoundAtAnySpeed) {
  for (const int speed : {360, 380, 400, 450, 480})
    EXPECT_EQ(failure_of(screen(speed)), "none") << speed;
}

}  // namespace
}  // namespace pleuel::test::periodic_errors_test
