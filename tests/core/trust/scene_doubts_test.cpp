/// Doubts about scenes: numbers that come out without complaint, but of another mechanism than
/// meant.

#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "core/response/analysis.hpp"
#include "core/scene/problem_reader.hpp"
#include "core/trust/energy_balance.hpp"
#include "core/trust/extrapolation.hpp"
#include "core/trust/idle_freedoms.hpp"
#include "core/trust/initial_motion.hpp"
#include "core/trust/joint_turns.hpp"
#include "core/trust/left_out_effects.hpp"
#include "core/trust/misaligned_joints.hpp"
#include "core/trust/proportions.hpp"
#include "core/trust/sliding_contact.hpp"
#include "tests/support/problem_runs.hpp"

namespace pleuel::test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

using FindDoubts = std::vector<Doubt> (*)(const TrustedRun&);

std::vector<Doubt> doubts_of(const ProblemFile& problem, FindDoubts find) {
  const Eigen::VectorXd x = start_design(problem);
  const auto analysis = analyze(problem, x);
  const Monitors monitors = monitor(analysis->model, analysis->trajectory);
  return find(TrustedRun{problem, x, *analysis, monitors});
}

ProblemFile read_scene(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return read_problem_text(text, "test.json", overrides);
}

// Misaligned joints.

/// A door of 10 kg, 1 m wide, on two hinges 2 m apart, whose axes are tilted against each other.
std::string door(double tilt, const std::string& up = "z", double unit = 1.0) {
  const auto point = [&](double across, double height) {
    return up == "z" ? fmt::format("[{:.17g}, 0, {:.17g}]", across * unit, height * unit)
                     : fmt::format("[{:.17g}, {:.17g}, 0]", height * unit, across * unit);
  };
  const std::string straight = up == "z" ? "[0, 0, 1]" : "[1, 0, 0]";
  const std::string tilted =
      up == "z" ? fmt::format("[{:.17g}, 0, 1]", tilt) : fmt::format("[1, {:.17g}, 0]", tilt);
  const std::string gravity = up == "z" ? "[0, -9.81, 0]" : "[0, 0, -9.81]";
  return fmt::format(
      R"({{"scene": {{"gravity": {}, "bodies": {{"door": {{"type": "rigid", "at": {}, "mass": 10,
          "inertia": [{:.17g}, {:.17g}, {:.17g}, 0, 0, 0]}}}},
          "joints": {{"low": {{"type": "revolute", "bodies": ["ground", "door"], "at": {}, "axis": {}}},
                      "high": {{"type": "revolute", "bodies": ["ground", "door"], "at": {}, "axis": {}}}}}}},
          "simulation": {{"end_time": 0.1, "step": 0.002}}, "effects": {{"spatial_motion": "on"}},
          "responses": {{"force": {{"type": "reaction-force", "joint": "low", "direction": "magnitude",
                                    "over_time": "max"}}}}}})",
      gravity, point(0.5, 0.0), unit * unit, unit * unit, unit * unit, point(0.0, -1.0), straight,
      point(0.0, 1.0), tilted);
}

class TiltedHinges : public testing::TestWithParam<std::tuple<double, std::string, double>> {
 protected:
  std::string text_ =
      door(std::get<0>(GetParam()), std::get<1>(GetParam()), std::get<2>(GetParam()));
};
class NearlyAlignedHinges : public TiltedHinges {};
class SlightlyTiltedHinges : public TiltedHinges {};

/// The door falls like a pendulum, from rest at the horizontal: the force of both hinges together
/// is below 1.5 m g + m g (vertical), each carries at most all of it.
TEST_P(NearlyAlignedHinges, Swing) {
  const ProblemFile problem = read_scene(text_);
  const auto analysis = analyze(problem, start_design(problem));
  EXPECT_THAT(analysis->model.mechanism.system->left_out(), SizeIs(5));
  EXPECT_LE(analysis->reductions[0].value, 3.0 * 10 * 9.81);
  EXPECT_THAT(doubts_of(problem, doubt_misaligned_joints), IsEmpty());
  Monitors monitors = monitor(analysis->model, analysis->trajectory);
  EXPECT_LE(monitors.position_drift, 1e-9);  // of what is kept
}

TEST_P(SlightlyTiltedHinges, AreNamed) {
  const std::vector<Doubt> doubts = doubts_of(read_scene(text_), doubt_misaligned_joints);
  ASSERT_THAT(doubts, SizeIs(1));
  EXPECT_TRUE(doubts[0].is_serious);
  EXPECT_THAT(doubts[0].text, HasSubstr("\"low\", \"high\""));
  EXPECT_THAT(doubts[0].text, HasSubstr("\"door\""));
}

const auto directions = testing::Values("x", "z");
const auto units = testing::Values(1.0, 1e-3);
INSTANTIATE_TEST_SUITE_P(Tilts, NearlyAlignedHinges,
                         testing::Combine(testing::Values(0.0, 1e-12, 1e-9, 1e-8, 1e-7), directions,
                                          units));
INSTANTIATE_TEST_SUITE_P(Tilts, SlightlyTiltedHinges,
                         testing::Combine(testing::Values(1e-5, 1e-4, 1e-3, 1e-2), directions,
                                          units));

/// The same door on a carriage that drives off with it: what it does against the carriage counts,
/// not that it moves at all.
TEST(MisalignedJoints, LockABodyAlsoWhereItIsCarriedAway) {
  const auto doubts_with = [](double tilt) {
    return doubts_of(
        read_scene(door(tilt),
                   {R"(/scene/bodies/carriage={"type": "rigid", "at": [0, 0, 0], "mass": 5,
                  "inertia": [1, 1, 1, 0, 0, 0]})",
                    R"(/scene/joints/rail={"type": "prismatic", "bodies": ["ground", "carriage"],
                  "at": [0, 0, 0], "axis": [0, 1, 0],
                  "drive": {"type": "polynomial", "coefficients": [0, 0, 20]}})",
                    R"(/scene/joints/low/bodies=["carriage", "door"])",
                    R"(/scene/joints/high/bodies=["carriage", "door"])"}),
        doubt_misaligned_joints);
  };
  EXPECT_THAT(doubts_with(0.0), IsEmpty());
  for (const double tilt : {1e-5, 5e-4, 5e-3, 2e-2}) {
    const std::vector<Doubt> doubts = doubts_with(tilt);
    ASSERT_THAT(doubts, SizeIs(1)) << tilt;
    EXPECT_THAT(doubts[0].text, HasSubstr("\"low\", \"high\"")) << tilt;
  }
}

/// Two ball joints make a hinge however near they are; so do points of a body that are a hundredth
/// of the mechanism apart.
TEST(MisalignedJoints, AreNotTwoBallJointsThatMakeAHinge) {
  const ProblemFile problem = read_scene(
      R"({"scene": {"gravity": [0, -9.81, 0],
          "bodies": {"door": {"type": "rigid", "at": [0.5, 0, 0], "mass": 10, "inertia": [1, 1, 1, 0, 0, 0]}},
          "joints": {"low": {"type": "spherical", "bodies": ["ground", "door"], "at": [0, 0, -0.01]},
                     "high": {"type": "point-on-line", "bodies": ["ground", "door"], "at": [0, 0, 0.01],
                              "axis": [0, 0, 1]}}},
          "simulation": {"end_time": 0.05, "step": 0.001}, "effects": {"spatial_motion": "on"}})");
  EXPECT_THAT(doubts_of(problem, doubt_misaligned_joints), IsEmpty());
}

/// The problem says 1e-7 rad: three constraints of a planar loop in space follow from the others.
TEST(MisalignedJoints, OfALoopInSpaceThatIsDrivenAreRedundant) {
  const auto loop = [](double tilt) {
    return fmt::format(
        R"({{"scene": {{"materials": {{"m": {{"young": 2e11, "poisson": 0.3, "density": 7850}}}},
          "bodies": {{"crank": {{"type": "beam", "from": [0, 0, 0], "to": [0.1, 0, 0], "material": "m", "rigid": true, "elements": 1,
                                 "section": {{"type": "circle", "diameter": 0.01}}}},
                      "coupler": {{"type": "beam", "from": [0.1, 0, 0], "to": [0.4, 0.2, 0], "material": "m", "rigid": true, "elements": 1,
                                   "section": {{"type": "circle", "diameter": 0.01}}}},
                      "rocker": {{"type": "beam", "from": [0.4, 0.2, 0], "to": [0.4, 0, 0], "material": "m", "rigid": true, "elements": 1,
                                  "section": {{"type": "circle", "diameter": 0.01}}}}}},
          "joints": {{"A": {{"type": "revolute", "bodies": ["ground", "crank"], "at": [0, 0, 0],
                             "drive": {{"type": "constant-speed", "speed": 10}}}},
                      "B": {{"type": "revolute", "bodies": ["crank", "coupler"], "at": [0.1, 0, 0]}},
                      "C": {{"type": "revolute", "bodies": ["coupler", "rocker"], "at": [0.4, 0.2, 0], "axis": [{0}, 0, 1]}},
                      "D": {{"type": "revolute", "bodies": ["ground", "rocker"], "at": [0.4, 0, 0], "axis": [0, {0}, 1]}}}}}},
          "simulation": {{"end_time": 0.3, "step": 0.001}}, "effects": {{"spatial_motion": "on"}},
          "responses": {{"T": {{"type": "drive-torque", "joint": "A", "over_time": "max-abs"}}}}}})",
        tilt);
  };
  const auto torque = [&](double tilt) {
    const ProblemFile problem = read_scene(loop(tilt));
    return analyze(problem, start_design(problem))->reductions[0].value;
  };
  const double expected = torque(0.0);
  for (const double tilt : {1e-9, 1e-8, 1e-7, 5e-7}) {
    EXPECT_NEAR(torque(tilt), expected, 1e-4 * expected) << tilt;
  }
  for (const double tilt : {1e-5, 1e-3, 1e-2}) {
    try {
      torque(tilt);
      ADD_FAILURE() << "a loop that is locked was driven";
    } catch (const SimulationError& error) {
      EXPECT_THAT(error.what(), HasSubstr("would hold a motion")) << tilt;
    }
  }
}

// Freedoms that nothing moves.

/// A crank-rocker of steel rods, with gravity and without.
std::string crank_rocker(const std::string& drive, const std::string& more_joints,
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
const std::string driven = R"(, "drive": {"type": "constant-speed", "speed": "300 rpm"})";
const std::string closed =
    R"(, "D": {"type": "revolute", "bodies": ["ground", "rocker"], "at": [0.4, 0, 0]})";

TEST(IdleFreedoms, AreNotInADrivenMechanism) {
  EXPECT_THAT(doubts_of(read_scene(crank_rocker(driven, closed)), doubt_idle_freedoms), IsEmpty());
}

TEST(IdleFreedoms, OfAForgottenDriveAreNamedByBody) {
  const std::vector<Doubt> doubts =
      doubts_of(read_scene(crank_rocker("", closed)), doubt_idle_freedoms);
  ASSERT_THAT(doubts, SizeIs(1));
  EXPECT_TRUE(doubts[0].is_serious);
  EXPECT_THAT(doubts[0].text,
              HasSubstr("\"crank\", \"coupler\", \"rocker\" can move freely (one free motion)"));
  EXPECT_THAT(doubts[0].text, HasSubstr("nothing moves there"));
  EXPECT_THAT(doubts[0].responses, testing::ElementsAre("v"));
}

TEST(IdleFreedoms, OfAForgottenJointAreNamedByBody) {
  const std::vector<Doubt> doubts =
      doubts_of(read_scene(crank_rocker(driven, "")), doubt_idle_freedoms);
  ASSERT_THAT(doubts, SizeIs(1));
  EXPECT_TRUE(doubts[0].is_serious);
  EXPECT_THAT(doubts[0].text,
              HasSubstr("\"coupler\", \"rocker\" can move freely (2 free motions)"));
  EXPECT_THAT(doubts[0].text, HasSubstr("only the inertia"));
}

/// Weight, a spring, a damper or a motor, a push, a start that moves: all of these are meant.
TEST(IdleFreedoms, AreNotWhereSomethingActs) {
  const auto load = [](const std::string& text) { return "/scene/loads={\"load\": " + text + "}"; };
  const std::string crank_joint = R"("type": "joint", "joint": "A")";
  for (
      const std::string& override_text :
      {std::string("/scene/gravity=[0, -9.81, 0]"),
       std::string("/scene/bodies/crank/angular_velocity=[0, 0, 3]"),
       load(
           R"({"type": "force", "body": "rocker", "at": [0.4, 0.2, 0], "direction": [1, 0, 0], "value": 1})"),
       load(R"({"type": "force", "body": "rocker", "at": [0.4, 0.2, 0], "direction": [1, 0, 0],
                 "value": {"type": "table", "times": [0, 0.01, 0.02], "values": [0, 1, 0]}})"),
       load(R"({"type": "spring", "bodies": ["ground", "rocker"],
                 "at": [[0.5, 0.2, 0], [0.4, 0.2, 0]], "stiffness": 100})")}) {
    EXPECT_THAT(
        doubts_of(read_scene(crank_rocker("", closed), {override_text}), doubt_idle_freedoms),
        IsEmpty())
        << override_text;
  }
}

TEST(IdleFreedoms, AreNotInTheProblemsOfTheHouse) {
  for (const char* name :
       {"spatial_slider_crank", "robot_arm", "four_bar", "hard/dead_centres", "hard/free_vibration",
        "hard/bricard", "hard/flyball_governor", "hard/squeezer", "hard/change_point"}) {
    ProblemFile problem = sample_problem(name);
    problem.simulation.end_time = 2.0 * problem.simulation.step;
    problem.responses.clear();
    for (const FindDoubts find : {doubt_idle_freedoms, doubt_unconnected_bodies, doubt_proportions,
                                  doubt_misaligned_joints}) {
      EXPECT_THAT(doubts_of(problem, find), IsEmpty()) << name;
    }
  }
}

/// The spin of a rod between ball joints does nothing.
TEST(IdleFreedoms, AreNotTheSpinOfARodBetweenBallJoints) {
  ProblemFile problem = sample_problem("spatial_slider_crank", {"/simulation/end_time=2 ms"});
  for (Joint& joint : problem.scene.joints) {
    if (joint.name == "slider_pin") joint.type = JointType::spherical;
  }
  EXPECT_THAT(doubts_of(problem, doubt_idle_freedoms), IsEmpty());
}

TEST(UnconnectedBodies, AreNamed) {
  const auto stray_with = [](const std::string& more) {
    return R"(/scene/bodies/stray={"type": "point-mass", "at": [0.2, 0.3, 0], "mass": 1)" + more +
           "}";
  };
  const std::string stray = stray_with("");
  const std::string other =
      R"(/scene/bodies/other={"type": "point-mass", "at": [0.3, 0.3, 0], "mass": 1})";
  const std::string tie =
      R"(/scene/joints/tie={"type": "distance", "bodies": ["stray", "other"], "at": [0.2, 0.3, 0], "to": [0.3, 0.3, 0]})";
  const std::vector<Doubt> still = doubts_of(
      read_scene(crank_rocker(driven, closed), {stray, other, tie}), doubt_unconnected_bodies);
  ASSERT_THAT(still, SizeIs(1));
  EXPECT_THAT(still[0].text, HasSubstr("connects \"stray\", \"other\" with the ground"));
  EXPECT_FALSE(still[0].is_serious) << "no response looks at it";
  const std::vector<Doubt> falling =
      doubts_of(read_scene(crank_rocker(driven, closed, "[0, -9.81, 0]"),
                           {stray, other, tie, R"(/responses/y={"type": "position", "body": "stray",
                                 "direction": "y", "over_time": "final"})"}),
                doubt_unconnected_bodies);
  ASSERT_THAT(falling, SizeIs(1));
  EXPECT_TRUE(falling[0].is_serious);
  EXPECT_THAT(doubts_of(read_scene(crank_rocker(driven, closed),
                                   {stray_with(R"(, "velocity": [1, 2, 0])"), other, tie}),
                        doubt_unconnected_bodies),
              IsEmpty());
}

// Sizes.

struct Slip {
  const char* override_text;
  const char* pointer;
};
class SizesOutOfProportion : public testing::TestWithParam<Slip> {};

/// Each of them is a unit forgotten, or a zero too many.
TEST_P(SizesOutOfProportion, AreNamedByTheirPlaceInTheFile) {
  const ProblemFile problem =
      sample_problem("slider_crank", {"/simulation/end_time=0.1 ms", GetParam().override_text});
  const std::vector<Doubt> doubts = doubts_of(problem, doubt_proportions);
  ASSERT_THAT(doubts, SizeIs(1));
  EXPECT_FALSE(doubts[0].is_serious);
  EXPECT_THAT(doubts[0].text, HasSubstr(GetParam().pointer));
}
INSTANTIATE_TEST_SUITE_P(
    Slips, SizesOutOfProportion,
    testing::Values(Slip{"/scene/materials/steel/density=7.85", "/scene/materials/steel/density"},
                    Slip{"/scene/materials/steel/density=7.85e6", "/scene/materials/steel/density"},
                    Slip{"/scene/materials/steel/young=2.1e5", "/scene/materials/steel/young"},
                    Slip{"/scene/materials/steel/young=2.1e20", "/scene/materials/steel/young"},
                    Slip{"/scene/gravity=[0, -9810, 0]", "/scene/gravity"}));

/// Just within and just beyond what is said of each: from foams to osmium, from rubber to what is
/// meant as rigid, from half a metre to 250 m/s².
TEST(SizesOutOfProportion, BeginWhereTheyAreSaidTo) {
  struct Edge {
    const char *pointer, *within, *beyond;
  };
  for (const Edge& edge : {Edge{"/scene/materials/steel/density", "10.1", "9.9"},
                           Edge{"/scene/materials/steel/density", "24900", "25100"},
                           Edge{"/scene/materials/steel/young", "1.01e6", "0.99e6"},
                           Edge{"/scene/materials/steel/young", "0.99e18", "1.01e18"},
                           Edge{"/scene/gravity", "[0, 0.51, 0]", "[0, 0.49, 0]"},
                           Edge{"/scene/gravity", "[0, 249, 0]", "[0, 251, 0]"}}) {
    // Rubber rods are for no motion: the doubt looks at numbers only.
    ProblemFile problem = sample_problem("slider_crank", {"/simulation/end_time=0.1 ms"});
    const Eigen::VectorXd x = start_design(problem);
    const auto analysis = analyze(problem, x);
    const Monitors monitors = monitor(analysis->model, analysis->trajectory);
    const auto count = [&](const char* value) {
      problem.scene =
          sample_problem("slider_crank", {std::string(edge.pointer) + "=" + value}).scene;
      return doubt_proportions(TrustedRun{problem, x, *analysis, monitors}).size();
    };
    EXPECT_EQ(count(edge.within), 0u) << edge.pointer << " " << edge.within;
    EXPECT_EQ(count(edge.beyond), 1u) << edge.pointer << " " << edge.beyond;
  }
}

/// Bodies that a massless rod holds: where they are, and what they weigh, are their own business.
TEST(SizesOutOfProportion, ArePointsFarAwayAndInertiaOfOtherUnits) {
  const auto with = [](const std::string& body, const std::string& at) {
    return doubts_of(
        read_scene(
            crank_rocker(driven, closed),
            {"/scene/bodies/more=" + body,
             R"(/scene/joints/tie={"type": "distance", "bodies": ["ground", "more"], "at": [0.1, 0.1, 0], "to": )" +
                 at + "}"}),
        doubt_proportions);
  };
  const auto point = [&](const std::string& at) {
    return with(R"({"type": "point-mass", "mass": 1, "at": )" + at + "}", at);
  };
  EXPECT_THAT(point("[3, 0, 0]"), IsEmpty());
  ASSERT_THAT(point("[100, 0, 0]"), SizeIs(1));
  EXPECT_THAT(point("[100, 0, 0]")[0].text, HasSubstr("/scene/bodies/more/at is"));
  const std::string near = "[0.2, 0.1, 0]";
  const auto heavy = [&](const char* inertia) {
    return with(
        fmt::format(
            R"({{"type": "rigid", "at": {0}, "mass": 1, "inertia": [{1}, {1}, {1}, 0, 0, 0]}})",
            near, inertia),
        near);
  };
  EXPECT_THAT(heavy("1e-2"), IsEmpty());
  ASSERT_THAT(heavy("1e2"), SizeIs(1));
  EXPECT_THAT(heavy("1e2")[0].text, HasSubstr("/scene/bodies/more/inertia"));
}

/// A radius of gyration of ten times the mechanism's size; a hundred times its size away.
TEST(SizesOutOfProportion, BeginAtTenTimesTheInertiaAndAHundredTimesTheDistance) {
  // Bar of 1 m, and a wheel at its end: nothing else has a place.
  const auto doubts = [](double inertia, double at) {
    ProblemFile problem = read_scene(crank_rocker(driven, closed));
    const Eigen::VectorXd x = start_design(problem);
    const auto analysis = analyze(problem, x);
    const Monitors monitors = monitor(analysis->model, analysis->trajectory);
    problem.scene = {};
    problem.scene.bodies = {
        {"one", PointMass{{0.0, 0.0, 0.0}, 1.0}},
        {"two", PointMass{{1.0, 0.0, 0.0}, 1.0}},
        {"three", PointMass{{0.5, 0.0, 0.0}, 1.0}},
        {"four", PointMass{{0.3, 0.0, 0.0}, 1.0}},
        {"wheel", RigidBody{{at, 0.0, 0.0}, 2.0, {inertia, 0.1, 0.1, 0.0, 0.0, 0.0}}}};
    return doubt_proportions(TrustedRun{problem, x, *analysis, monitors}).size();
  };
  EXPECT_EQ(doubts(2.0 * 9.9 * 9.9, 1.0), 0u);
  EXPECT_EQ(doubts(2.0 * 10.1 * 10.1, 1.0), 1u);
  EXPECT_EQ(doubts(1.0, 1.0 + 99.0), 0u);
  EXPECT_EQ(doubts(1.0, 1.0 + 101.0), 1u);
}

/// Of the largest energy, one percent may be missing.
TEST(EnergyBalance, IsDoubtedAboveOnePercent) {
  const ProblemFile problem = read_scene(crank_rocker(driven, closed));
  const Eigen::VectorXd x = start_design(problem);
  const auto analysis = analyze(problem, x);
  Monitors monitors = monitor(analysis->model, analysis->trajectory);
  monitors.energy_error = 0.0098;
  EXPECT_THAT(doubt_energy_balance(TrustedRun{problem, x, *analysis, monitors}), IsEmpty());
  monitors.energy_error = 0.0102;
  const auto doubts = doubt_energy_balance(TrustedRun{problem, x, *analysis, monitors});
  ASSERT_THAT(doubts, SizeIs(1));
  EXPECT_THAT(doubts[0].text, HasSubstr("balanced to 1 % of"));
}

TEST(SizesOutOfProportion, AreSectionsThatAreLargerThanTheBeamIsLong) {
  const auto with_diameter = [](double diameter) {
    return doubts_of(read_scene(crank_rocker(driven, closed),
                                {fmt::format("/scene/bodies/crank/section/diameter={}", diameter)}),
                     doubt_proportions);
  };
  EXPECT_THAT(with_diameter(0.02), IsEmpty());
  ASSERT_THAT(with_diameter(0.2), SizeIs(1));
  EXPECT_THAT(with_diameter(0.2)[0].text, HasSubstr("/scene/bodies/crank/section"));
  ASSERT_THAT(with_diameter(2e-5), SizeIs(1));
  EXPECT_THAT(with_diameter(2e-5)[0].text, HasSubstr("/scene/bodies/crank is 0.1 m long"));
}

/// A leaf of 20 mm by 10 µm, however it lies: what is too thin to be meant is so in both
/// directions.
TEST(SizesOutOfProportion, AreNotThinLeaves) {
  const auto with_section = [](const char* section) {
    return doubts_of(read_scene(crank_rocker(driven, closed),
                                {std::string("/scene/bodies/crank/section=") + section}),
                     doubt_proportions);
  };
  EXPECT_THAT(with_section(R"({"type": "rectangle", "width": 0.02, "height": 1e-5})"), IsEmpty());
  EXPECT_THAT(with_section(R"({"type": "rectangle", "width": 1e-5, "height": 0.02})"), IsEmpty());
  EXPECT_THAT(with_section(R"({"type": "rectangle", "width": 1e-5, "height": 1e-5})"), SizeIs(1));
}

// Stiffening that goes with axial elasticity.

/// A pull of 200 N on a rod of 5 mm, 0.3 m long: of its Euler load π² E I/L² = 706 N, 28 %.
TEST(LostStiffening, IsADoubtWhereAxialForcesAreLarge) {
  const auto problem_with = [](double force) {
    return read_scene(fmt::format(
        R"({{"scene": {{"materials": {{"m": {{"young": 2.1e11, "poisson": 0.3, "density": 7850}}}},
          "bodies": {{"rod": {{"type": "beam", "from": [0, 0, 0], "to": [0.3, 0, 0], "material": "m",
              "section": {{"type": "circle", "diameter": 0.005}}, "elements": 2, "frame": "chord"}}}},
          "joints": {{"a": {{"type": "revolute", "bodies": ["ground", "rod"], "at": [0, 0, 0]}},
                      "b": {{"type": "point-on-line", "bodies": ["ground", "rod"], "at": [0.3, 0, 0], "axis": [1, 0, 0]}}}},
          "loads": {{"pull": {{"type": "force", "body": "rod", "at": [0.3, 0, 0], "direction": [1, 0, 0], "value": {}}}}}}},
          "effects": {{"axial_elasticity": "off"}},
          "simulation": {{"end_time": 0.01, "step": 0.001}}}})",
        force));
  };
  EXPECT_THAT(doubts_of(problem_with(1.0), doubt_lost_stiffening), IsEmpty());
  // From one percent on.
  const double pi = 3.14159265358979, radius = 0.0025;
  const double euler = pi * pi * 2.1e11 * pi / 4 * std::pow(radius, 4) / (0.3 * 0.3);
  EXPECT_THAT(doubts_of(problem_with(0.0098 * euler), doubt_lost_stiffening), IsEmpty());
  EXPECT_THAT(doubts_of(problem_with(0.0102 * euler), doubt_lost_stiffening), SizeIs(1));
  const std::vector<Doubt> doubts = doubts_of(problem_with(200.0), doubt_lost_stiffening);
  ASSERT_THAT(doubts, SizeIs(1));
  EXPECT_TRUE(doubts[0].is_serious);
  EXPECT_THAT(doubts[0].text, HasSubstr("0.28 of its Euler load"));
}

// Bodies from files.

/// A rigid-looking body whose file knows its mass at h = 30 mm and how it changes; only the doubt's
/// own decision is looked at.
TEST(Extrapolation, IsADoubtWhereTheDesignHasLeftThatOfTheFile) {
  ProblemFile problem = read_scene(crank_rocker(driven, closed));
  const Eigen::VectorXd x0 = start_design(problem);
  const auto analysis = analyze(problem, x0);
  const Monitors monitors = monitor(analysis->model, analysis->trajectory);
  auto file = std::make_shared<InvariantsFile>();
  file->design.push_back({"h", 0.03, "m", file->constants});
  file->design.back().derivative->mass = 2.0;
  ImportedBody imported;
  imported.source = "rod.json";
  imported.file = file;
  imported.variables = {{Number::bound(0), quantities::length, 0}};
  problem.variables = {{"h", 0.03, 0.004, 0.06, "m"}};
  problem.scene.bodies.push_back({"imported", imported});
  const auto doubts_at = [&](double height) {
    Eigen::VectorXd x(1);
    x << height;
    return doubt_extrapolation(TrustedRun{problem, x, *analysis, monitors});
  };
  EXPECT_THAT(doubts_at(0.02), IsEmpty()) << "not continued";
  std::get<ImportedBody>(problem.scene.bodies.back().shape).is_linear = true;
  EXPECT_THAT(doubts_at(0.03), IsEmpty());
  EXPECT_THAT(doubts_at(0.03 * (1 + 0.9e-4)), IsEmpty());
  EXPECT_THAT(doubts_at(0.03 * (1 - 0.9e-4)), IsEmpty());
  EXPECT_THAT(doubts_at(0.03 * (1 + 1.1e-4)), SizeIs(1));
  EXPECT_THAT(doubts_at(0.03 * (1 - 1.1e-4)), SizeIs(1));
  EXPECT_THAT(doubts_at(0.03 * (1 + 1e-9)), IsEmpty());
  ASSERT_THAT(doubts_at(0.0303), SizeIs(1));
  EXPECT_TRUE(doubts_at(0.0303)[0].is_serious);
  EXPECT_THAT(doubts_at(0.0303)[0].text, HasSubstr("h = 0.0303 instead of 0.03 m"));
  EXPECT_THAT(doubts_at(0.0303)[0].text, HasSubstr("rod.json"));
}

// Velocities that the file gives.

/// A bar of 1 m on a hinge, whose frame is at its left end.
ProblemFile turning_bar(double hinge, const std::string& velocity) {
  return read_scene(fmt::format(
      R"({{"scene": {{"bodies": {{"bar": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0],
          "material": "steel", "section": {{"type": "circle", "diameter": 0.03}}, "rigid": true,
          "elements": 1, "angular_velocity": [0, 0, 10], "velocity": {}}}}},
          "joints": {{"hinge": {{"type": "revolute", "bodies": ["ground", "bar"], "at": [{}, 0, 0]}}}}}},
          "simulation": {{"end_time": 0.01, "step": 0.001}}}})",
      velocity, hinge));
}

/// About its middle the left end goes down with ω/2; at rest it is not.
TEST(InitialMotion, IsADoubtWhereJointsChangeWhatTheFileGives) {
  EXPECT_THAT(doubts_of(turning_bar(0.0, "[0, 0, 0]"), doubt_initial_motion), IsEmpty());
  EXPECT_THAT(doubts_of(turning_bar(0.5, "[0, -5, 0]"), doubt_initial_motion), IsEmpty());
  const std::vector<Doubt> doubts = doubts_of(turning_bar(0.5, "[0, 0, 0]"), doubt_initial_motion);
  ASSERT_THAT(doubts, SizeIs(1));
  EXPECT_TRUE(doubts[0].is_serious);
  EXPECT_THAT(doubts[0].text, HasSubstr("the initial angular velocity of \"bar\""));
  EXPECT_THAT(doubts[0].text, HasSubstr("instead of the 10 rad/s of the file"));
  EXPECT_THAT(doubts_of(turning_bar(0.0, "[0, 3, 0]"), doubt_initial_motion), SizeIs(1));
}

/// A slide that is turned by five degrees against the velocity leaves cos 5° of it, 0.4 % less, but
/// in another direction; by half a degree all of it, as nearly as it matters.
TEST(InitialMotion, InAnotherDirectionIsADoubt) {
  const auto doubts = [](double angle) {
    return doubts_of(
        read_scene(fmt::format(
            R"({{"scene": {{"bodies": {{"block": {{"type": "rigid", "at": [0, 0, 0], "mass": 1,
                "inertia": [1, 1, 1, 0, 0, 0], "velocity": [{:.12g}, {:.12g}, 0]}}}},
              "joints": {{"slide": {{"type": "prismatic", "bodies": ["ground", "block"],
                                     "at": [0, 0, 0], "axis": [1, 0, 0]}}}}}},
              "simulation": {{"end_time": 0.02, "step": 0.01}}}})",
            2.0 * std::cos(angle), 2.0 * std::sin(angle))),
        doubt_initial_motion);
  };
  const double degree = 3.14159265358979 / 180;
  EXPECT_THAT(doubts(0.5 * degree), IsEmpty());
  const std::vector<Doubt> turned = doubts(5.0 * degree);
  ASSERT_THAT(turned, SizeIs(1));
  EXPECT_THAT(turned[0].text, HasSubstr("in another direction instead of the 2 m/s"));
}

/// An elastic member begins without elastic rates, and takes the velocity of what it carries.
TEST(InitialMotion, OfAMassOnAnElasticMemberIsADoubt) {
  const std::vector<Doubt> doubts = doubts_of(read_scene(
                                                  R"({"scene": {"bodies": {
            "arm": {"type": "beam", "from": [0, 0, 0], "to": [0.5, 0, 0], "material": "steel",
                    "section": {"type": "circle", "diameter": 0.02}, "elements": 2},
            "mass": {"type": "point-mass", "at": [0.5, 0, 0], "mass": 10, "velocity": [0, 0.1, 0]}},
          "joints": {"clamp": {"type": "fixed", "bodies": ["ground", "arm"], "at": [0, 0, 0]},
                     "tip": {"type": "spherical", "bodies": ["arm", "mass"], "at": [0.5, 0, 0]}}},
          "simulation": {"end_time": 0.01, "step": 0.001}})"),
                                              doubt_initial_motion);
  ASSERT_THAT(doubts, SizeIs(1));
  EXPECT_THAT(doubts[0].text, HasSubstr("the initial velocity of \"mass\""));
}

// Springs in joints that turn.

/// ½ J ω² = ½ k φ² at φ = ω √(J/k): with J = 0.1 kg m², k = 10 N m/rad a tenth of ω [s].
ProblemFile spring_rotor(double speed, const std::string& effects) {
  return read_scene(fmt::format(
      R"({{"scene": {{"bodies": {{"rotor": {{"type": "rigid", "at": [0, 0, 0], "mass": 1,
          "inertia": [0.1, 0.1, 0.1, 0, 0, 0], "angular_velocity": [0, 0, {}]}}}},
          "joints": {{"bearing": {{"type": "revolute", "bodies": ["ground", "rotor"], "at": [0, 0, 0]}}}},
          "loads": {{"coil": {{"type": "joint", "joint": "bearing", "stiffness": 10}}}}}},
          "effects": {}, "simulation": {{"end_time": 0.4, "step": 0.002}}}})",
      speed, effects));
}

TEST(JointTurns, AreADoubtBeyondHalfATurnInSpace) {
  const std::string space = R"({"spatial_motion": "on"})";
  EXPECT_THAT(doubts_of(spring_rotor(30, space), doubt_joint_turns), IsEmpty());
  const std::vector<Doubt> doubts = doubts_of(spring_rotor(33, space), doubt_joint_turns);
  ASSERT_THAT(doubts, SizeIs(1));
  EXPECT_TRUE(doubts[0].is_serious);
  EXPECT_THAT(doubts[0].text, HasSubstr("the joint \"bearing\" turns by more than half a turn"));
  EXPECT_THAT(doubts_of(spring_rotor(60, "{}"), doubt_joint_turns), IsEmpty()) << "counted";
}

/// A damper does not ask how often it has turned.
TEST(JointTurns, AreNoneOfADamper) {
  ProblemFile problem = spring_rotor(60, R"({"spatial_motion": "on"})");
  EXPECT_THAT(doubts_of(problem, doubt_joint_turns), SizeIs(1));
  auto& coil = std::get<JointForce>(problem.scene.loads[0].element);
  coil.stiffness = 0.0;
  coil.damping = 1e-3;
  EXPECT_THAT(doubts_of(problem, doubt_joint_turns), IsEmpty());
}

// What slides along beams.

/// A mass that is moved along a horizontal arm of 1 m, or beyond its end.
ProblemFile trolley(double from, double way, const std::string& arm) {
  return read_scene(fmt::format(
      R"({{"scene": {{"gravity": [0, -9.81, 0], "bodies": {{
            "arm": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "steel",
                     "section": {{"type": "circle", "diameter": 0.03}}, "elements": 5{}}},
            "trolley": {{"type": "point-mass", "at": [{}, 0, 0], "mass": 1}}}},
          "joints": {{"clamp": {{"type": "fixed", "bodies": ["ground", "arm"], "at": [0, 0, 0]}},
                      "rail": {{"type": "point-on-line", "bodies": ["arm", "trolley"], "at": [{}, 0, 0],
                                "axis": [1, 0, 0], "drive": {{"type": "table", "times": [0, 0.2],
                                                              "values": [0, {}]}}}}}}}},
          "simulation": {{"end_time": 0.2, "step": 0.01}}}})",
      arm, from, from, way));
}

/// A carriage whose line goes past the tip of the arm: its force stays at the tip.
TEST(SlidingContact, IsNoneWhereTheLineBelongsToTheOtherBody) {
  const ProblemFile problem = read_scene(
      R"({"scene": {"gravity": [0, -9.81, 0], "bodies": {
            "arm": {"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "steel",
                    "section": {"type": "circle", "diameter": 0.03}, "elements": 5},
            "carriage": {"type": "rigid", "at": [1, 0, 0], "mass": 1,
                         "inertia": [0.1, 0.1, 0.1, 0, 0, 0]}},
          "joints": {"clamp": {"type": "fixed", "bodies": ["ground", "arm"], "at": [0, 0, 0]},
                     "rail": {"type": "prismatic", "bodies": ["ground", "carriage"],
                              "at": [1, 0, 0], "axis": [1, 0, 0],
                              "drive": {"type": "table", "times": [0, 0.2], "values": [0, -0.6]}},
                     "slot": {"type": "point-on-line", "bodies": ["carriage", "arm"],
                              "at": [1, 0, 0], "axis": [1, 0, 0]}}},
          "simulation": {"end_time": 0.2, "step": 0.01}})");
  EXPECT_THAT(doubts_of(problem, doubt_sliding_contacts), IsEmpty());
}

TEST(SlidingContact, IsADoubtWhereItTravelsOverAnElasticBeam) {
  const std::vector<Doubt> doubts = doubts_of(trolley(0.2, 0.6, ""), doubt_sliding_contacts);
  ASSERT_THAT(doubts, SizeIs(1));
  EXPECT_TRUE(doubts[0].is_serious);
  EXPECT_THAT(doubts[0].text, HasSubstr("\"trolley\" slides 0.6 m along the elastic beam \"arm\""));
  EXPECT_THAT(doubts_of(trolley(0.2, 0.6, R"(, "frames": 2)"), doubt_sliding_contacts), SizeIs(1));
  EXPECT_THAT(doubts_of(trolley(0.2, 0.01, ""), doubt_sliding_contacts), IsEmpty());
  EXPECT_THAT(doubts_of(trolley(1.0, 0.6, ""), doubt_sliding_contacts), IsEmpty());
  EXPECT_THAT(doubts_of(trolley(0.2, 0.6, R"(, "rigid": true)"), doubt_sliding_contacts),
              IsEmpty());
}

}  // namespace
}  // namespace pleuel::test
