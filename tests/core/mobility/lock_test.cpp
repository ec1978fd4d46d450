#include "core/mobility/lock.hpp"

#include "core/base/eager_matrices.hpp"
#include "core/base/rotation_vector.hpp"
#include "core/response/analysis.hpp"
#include "core/scene/problem_reader.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/test.hpp"

/// Where rigid mechanisms cannot follow their drives, by closed forms of their closure.
namespace pleuel::test::lock_test {
namespace {

constexpr double pi = std::numbers::pi;

struct Bar {
  std::string name;
  Eigen::Vector3d from, to;
};

std::string point_text(const Eigen::Vector3d& p) {
  return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", p.x(), p.y(), p.z());
}

std::string bars_text(const std::vector<Bar>& bars) {
  std::string text;
  for (const Bar& bar : bars) {
    text += fmt::format(
        R"({}"{}": {{"type": "beam", "from": {}, "to": {}, "material": "steel", "elements": 1,
        "section": {{"type": "circle", "diameter": "10 mm"}}}})",
        text.empty() ? "" : ", ", bar.name, point_text(bar.from), point_text(bar.to));
  }
  return text;
}

ProblemFile problem_of(const std::string& bodies, const std::string& joints,
                       const std::string& simulation = R"("end_time": 1, "step": 0.005)") {
  const std::string text = fmt::format(
      R"({{"scene": {{"bodies": {{{}}}, "joints": {{{}}}}}, "simulation": {{{}}},
      "responses": {{"mass": {{"type": "mass"}}}}}})",
      bodies, joints, simulation);
  return read_problem_text(text, "a mechanism", {}).complete();
}

RigidPath path_of(const ProblemFile& problem) {
  const Eigen::VectorXd x = start_design(problem);
  const Design<double> design(x.begin(), x.end());
  const Model model = build_model(problem.scene, problem.effects, design, design);
  return follow_drives(model, problem.simulation.end_time, problem.simulation.step);
}

/// Crank of 60 mm, by default with one revolution in 1 s, rod along x at the start, slider on the x
/// axis.
ProblemFile slider_crank(
    double rod, const std::string& more_bodies = "", const std::string& more_joints = "",
    const std::string& drive = R"({"type": "constant-speed", "speed": "1 rev/s"})") {
  const Eigen::Vector3d pin(0.06, 0, 0), slider(0.06 + rod, 0, 0);
  const std::string bodies =
      more_bodies + bars_text({{"crank", Eigen::Vector3d::Zero(), pin}, {"rod", pin, slider}}) +
      fmt::format(R"(, "slider": {{"type": "point-mass", "at": {}, "mass": 1}})",
                  point_text(slider));
  const std::string joints = fmt::format(
      R"("shaft": {{"type": "revolute", "bodies": ["ground", "crank"], "at": [0, 0, 0], "drive": {}}},
        "pin": {{"type": "revolute", "bodies": ["crank", "rod"], "at": {}}},
        "slider_pin": {{"type": "revolute", "bodies": ["rod", "slider"], "at": {}}},
        "guide": {{"type": "point-on-line", "bodies": ["ground", "slider"], "at": {}, "axis": [1, 0, 0]}})",
      drive, point_text(pin), point_text(slider), point_text(slider));
  return problem_of(bodies, joints + more_joints);
}

/// The rod cannot pass where the crank pin is farther from the guide than it is long.
TEST(Lock, IsWhereARodIsTooShort) {
  for (const double rod : {0.05998, 0.0599, 0.055, 0.04}) {
    const RigidPath path = path_of(slider_crank(rod));
    ASSERT_EQ(path.end, RigidPath::End::locks) << rod;
    EXPECT_NEAR(path.time, std::asin(rod / 0.06) / (2 * pi), 1e-4) << rod;
    EXPECT_NEAR(path.gap, 0.06 - rod, 0.02 * (0.06 - rod)) << rod;
  }
}

/// Equal lengths branch at a quarter turn, a little more just passes.
TEST(Lock, IsNoneWhereARodPasses) {
  for (const double rod : {0.06, 0.06002, 0.0601, 0.2}) {
    const RigidPath path = path_of(slider_crank(rod));
    EXPECT_EQ(path.end, RigidPath::End::followed) << rod << " at " << path.time;
    EXPECT_EQ(path.time, 1.0);
  }
}

TEST(Lock, NamesTheDeadCentre) {
  const ProblemFile problem = slider_crank(0.055);
  const std::string said =
      thrown<LockedMechanism>([&] { analyze(problem, start_design(problem)); });
  EXPECT_THAT(said, HasSubstr("\"shaft\" at 66.44°"));
  EXPECT_THAT(said, HasSubstr("a dead centre of \"rod\", \"slider\""));
  EXPECT_THAT(said, HasSubstr("about 5 mm apart"));
}

TEST(Lock, IsSimulatedWhereBodiesAreMeantToBend) {
  ProblemFile problem = slider_crank(0.05998);
  problem.simulation.moves_by_bending = true;
  EXPECT_NO_THROW(analyze(problem, start_design(problem)));
}

/// A pendulum that hangs on the pin changes nothing.
TEST(Lock, IsFoundBesideFreeMotions) {
  const ProblemFile problem = slider_crank(
      0.055, bars_text({{"pendulum", {0.06, 0, 0}, {0.06, -0.1, 0}}}) + ", ",
      R"(, "hook": {"type": "revolute", "bodies": ["crank", "pendulum"], "at": [0.06, 0, 0]})");
  const RigidPath path = path_of(problem);
  ASSERT_EQ(path.end, RigidPath::End::locks);
  EXPECT_NEAR(path.time, std::asin(0.055 / 0.06) / (2 * pi), 1e-4);
}

/// A four-bar linkage whose longest and shortest bars are longer together than the others (Grashof):
/// the crank stops where coupler and rocker are stretched.
TEST(Lock, IsWhereGrashofsRuleIsBroken) {
  const double crank = 0.08, coupler = 0.1, rocker = 0.09, ground = 0.15;
  const Eigen::Vector3d pin(crank, 0, 0), far(ground, 0, 0);
  const double x =
      (crank + ground) / 2 + (coupler * coupler - rocker * rocker) / (2 * (ground - crank));
  const Eigen::Vector3d knee(x, std::sqrt(coupler * coupler - (x - crank) * (x - crank)), 0);
  const ProblemFile problem = problem_of(
      bars_text(
          {{"crank", Eigen::Vector3d::Zero(), pin}, {"coupler", pin, knee}, {"rocker", far, knee}}),
      fmt::format(R"("shaft": {{"type": "revolute", "bodies": ["ground", "crank"], "at": [0, 0, 0],
            "drive": {{"type": "constant-speed", "speed": "1 rev/s"}}}},
          "a": {{"type": "revolute", "bodies": ["crank", "coupler"], "at": {}}},
          "b": {{"type": "revolute", "bodies": ["coupler", "rocker"], "at": {}}},
          "c": {{"type": "revolute", "bodies": ["ground", "rocker"], "at": {}}})",
                  point_text(pin), point_text(knee), point_text(far)));
  const RigidPath path = path_of(problem);
  ASSERT_EQ(path.end, RigidPath::End::locks);
  const double reach = coupler + rocker;
  const double angle =
      std::acos((crank * crank + ground * ground - reach * reach) / (2 * crank * ground));
  EXPECT_NEAR(path.time, angle / (2 * pi), 1e-4);
  // Worst where the crank points away.
  EXPECT_NEAR(path.gap, crank + ground - reach, 0.02 * (crank + ground - reach));
}

/// An oblique wiper: crank, link with ball joints, and lever in space. The distance of the crank's
/// tip from the circle of the lever's has its extremes A ± √(B² + C²) under the root.
TEST(Lock, IsFoundInSpace) {
  const Eigen::Vector3d crank(0.045, 0, 0), centre(0.38, 0, 0.04), lever(0, 0.07, 0);
  const Eigen::Vector3d motor(0, 0.2, 1), shaft(0.3, 0, 1);
  const double length = (centre + lever - crank).norm();
  const auto miss = [&](double angle) {
    const Eigen::Vector3d tip = rotation_of(angle * motor.normalized()) * crank - centre;
    const Eigen::Vector3d n = shaft.normalized(), along = n.dot(lever) * n, across = lever - along,
                          third = n.cross(lever);
    const double mean = (tip - along).squaredNorm() + across.squaredNorm();
    const double swing = 2.0 * std::hypot(tip.dot(across), tip.dot(third));
    return std::max(length - std::sqrt(mean + swing), std::sqrt(mean - swing) - length);
  };
  double locked = 0.0, largest = 0.0;
  for (double angle = 0.0; angle < 2 * pi; angle += 1e-4) {
    if (miss(angle) > 0.0 && locked == 0.0) locked = angle;
    largest = std::max(largest, miss(angle));
  }
  const ProblemFile problem = problem_of(
      bars_text({{"crank", Eigen::Vector3d::Zero(), crank},
                 {"link", crank, centre + lever},
                 {"lever", centre, centre + lever}}),
      fmt::format(R"("motor": {{"type": "revolute", "bodies": ["ground", "crank"], "at": [0, 0, 0],
            "axis": {}, "drive": {{"type": "constant-speed", "speed": "1 rev/s"}}}},
          "ball 1": {{"type": "spherical", "bodies": ["crank", "link"], "at": {}}},
          "ball 2": {{"type": "spherical", "bodies": ["lever", "link"], "at": {}}},
          "shaft": {{"type": "revolute", "bodies": ["ground", "lever"], "at": {}, "axis": {}}})",
                  point_text(motor), point_text(crank), point_text(centre + lever),
                  point_text(centre), point_text(shaft)));
  const RigidPath path = path_of(problem);
  ASSERT_EQ(path.end, RigidPath::End::locks);
  EXPECT_NEAR(path.time, locked / (2 * pi), 2e-4);
  EXPECT_NEAR(path.gap, largest, 0.02 * largest);
}

/// The slider moves the crank, beginning in the dead centre, and turns back before the other one.
TEST(Lock, IsNoneWhereADriveLeavesADeadCentre) {
  const std::string joints =
      R"("bearing": {"type": "revolute", "bodies": ["ground", "crank"], "at": [0, 0, 0]},
        "pin": {"type": "revolute", "bodies": ["crank", "rod"], "at": [0.06, 0, 0]},
        "slider_pin": {"type": "revolute", "bodies": ["rod", "slider"], "at": [0.2, 0, 0]},
        "cylinder": {"type": "prismatic", "bodies": ["ground", "slider"], "at": [0.2, 0, 0],
          "axis": [-1, 0, 0], "drive": {"type": "harmonic", "amplitude": "AMPLITUDE", "frequency": "0.5 Hz"}})";
  const auto with = [&](const std::string& amplitude) {
    std::string text = joints;
    text.replace(text.find("AMPLITUDE"), 9, amplitude);
    return problem_of(bars_text({{"crank", Eigen::Vector3d::Zero(), {0.06, 0, 0}},
                                 {"rod", {0.06, 0, 0}, {0.2, 0, 0}},
                                 {"slider", {0.2, 0, 0}, {0.25, 0, 0}}}),
                      text);
  };
  EXPECT_EQ(path_of(with("100 mm")).end, RigidPath::End::followed);
  const RigidPath beyond = path_of(with("130 mm"));
  ASSERT_EQ(beyond.end, RigidPath::End::locks);
  // Steps are halved until drives ask for 1e-4 of the size: 0.02 mm at 0.16 m/s.
  EXPECT_NEAR(beyond.time, std::asin(0.12 / 0.13) / pi, 2e-4);
}

/// Three cranks hold a coupler: redundant, with branches where they lie in line.
TEST(Lock, IsNoneInParallelograms) {
  std::vector<Bar> bars;
  std::string joints;
  const std::vector<double> places = {0.0, 0.2, 0.35};
  bars.push_back({"coupler", {0.1, 0, 0}, {0.45, 0, 0}});
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Eigen::Vector3d foot(places[i], 0, 0), head(places[i] + 0.1, 0, 0);
    const std::string name = fmt::format("crank {}", i);
    bars.push_back({name, foot, head});
    joints += fmt::format(
        R"({3}"foot {2}": {{"type": "revolute", "bodies": ["ground", "{0}"], "at": {1}{5}}},
          "head {2}": {{"type": "revolute", "bodies": ["{0}", "coupler"], "at": {4}}})",
        name, point_text(foot), i, i > 0 ? ", " : "", point_text(head),
        i == 0 ? R"(, "drive": {"type": "constant-speed", "speed": "1 rev/s"})" : "");
  }
  EXPECT_EQ(path_of(problem_of(bars_text(bars), joints)).end, RigidPath::End::followed);
}

/// Two drives twist a shaft of two parts by different angles: it bends from the start.
TEST(Lock, IsNoneWhereDrivesHoldABodyTwice) {
  const auto shaft = [](const std::string& second) {
    return problem_of(
        bars_text({{"a", Eigen::Vector3d::Zero(), {0.2, 0, 0}}, {"b", {0.2, 0, 0}, {0.5, 0, 0}}}),
        fmt::format(R"("weld": {{"type": "fixed", "bodies": ["a", "b"], "at": [0.2, 0, 0]}},
            "left": {{"type": "revolute", "bodies": ["ground", "a"],
              "at": [0, 0, 0], "axis": [1, 0, 0], "drive": {{"type": "constant-speed", "speed": 1}}}},
            "right": {{"type": "cylindrical", "bodies": ["ground", "b"], "at": [0.5, 0, 0],
              "axis": [1, 0, 0], "drive": {{"type": "constant-speed", "coordinate": "angle", "speed": {}}}}})",
                    second));
  };
  EXPECT_EQ(path_of(shaft("1.02")).end, RigidPath::End::bends);
  EXPECT_EQ(path_of(shaft("1")).end, RigidPath::End::followed);
}

/// The crank rocks by 70 degrees, 0.4 degrees of which are beyond the lock, and returns.
TEST(Lock, IsFoundWhereTheDriveSoonReturns) {
  const double beyond = std::asin(0.055 / 0.06), amplitude = beyond + 0.4 * pi / 180;
  const ProblemFile problem = slider_crank(
      0.055, "", "",
      fmt::format(R"({{"type": "harmonic", "amplitude": {:.17g}, "frequency": "1 Hz"}})",
                  amplitude));
  const RigidPath path = path_of(problem);
  ASSERT_EQ(path.end, RigidPath::End::locks);
  EXPECT_NEAR(path.time, std::asin(beyond / amplitude) / (2 * pi), 5e-4);
  EXPECT_NEAR(path.gap, 0.06 * std::sin(amplitude) - 0.055, 1e-5);
}

/// What is large beside it does not hide it.
TEST(Lock, IsFoundInASmallPartOfALargeMachine) {
  const ProblemFile problem = slider_crank(
      0.0598, bars_text({{"frame", {5.0, 0, 0}, {13.0, 0, 0}}}) + ", ",
      R"(, "foundation": {"type": "fixed", "bodies": ["ground", "frame"], "at": [5, 0, 0]})");
  const RigidPath path = path_of(problem);
  ASSERT_EQ(path.end, RigidPath::End::locks);
  EXPECT_NEAR(path.time, std::asin(0.0598 / 0.06) / (2 * pi), 2e-4);
}

/// Joints that do not fit by less than any machine's: a second guide, tilted by 1e-5.
TEST(Lock, IsNoneWhereDimensionsAreRounded) {
  const ProblemFile problem = slider_crank(0.2, "", R"(, "second guide": {"type": "point-on-line",
        "bodies": ["ground", "slider"], "at": [0.26, 0, 0], "axis": [1, 1e-5, 0]})");
  EXPECT_EQ(path_of(problem).end, RigidPath::End::followed);
}

/// An eccentric pushes a cantilever along its axis, and across it by the sine: from a dead centre.
TEST(Lock, IsNoneWhereABodyBendsFromTheStart) {
  const ProblemFile problem = problem_of(
      bars_text({{"eccentric", Eigen::Vector3d::Zero(), {0.005, 0, 0}},
                 {"spring", {0.005, 0, 0}, {0.2, 0, 0}}}),
      R"("bearing": {"type": "revolute", "bodies": ["ground", "eccentric"], "at": [0, 0, 0],
          "drive": {"type": "constant-speed", "speed": "1 rev/s"}},
        "pin": {"type": "revolute", "bodies": ["eccentric", "spring"], "at": [0.005, 0, 0]},
        "clamp": {"type": "prismatic", "bodies": ["ground", "spring"], "at": [0.2, 0, 0], "axis": [1, 0, 0]})");
  EXPECT_EQ(path_of(problem).end, RigidPath::End::bends);
}

/// A shaft that begins bent turns as one that is straight: bodies do not deform on this way.
TEST(Lock, IsNoneWhereABodyStartsBent) {
  const ProblemFile problem = problem_from(R"({"scene": {"bodies": {
        "shaft": {"type": "beam", "from": [0, 0, 0], "to": [0.8, 0, 0], "material": "steel", "elements": 2,
          "frame": "chord", "section": {"type": "circle", "diameter": 0.02},
          "initial_deflections": [{"at": [0.4, 0, 0], "direction": [0, 1, 0], "displacement": 1e-4}]},
        "disc": {"type": "rigid", "at": [0.4, 0, 0], "mass": 8, "inertia": [0.04, 0.02, 0.02, 0, 0, 0]}},
      "joints": {
        "left": {"type": "revolute", "bodies": ["ground", "shaft"], "at": [0, 0, 0], "axis": [1, 0, 0],
          "drive": {"type": "constant-speed", "speed": "600 rpm"}},
        "right": {"type": "point-on-line", "bodies": ["ground", "shaft"], "at": [0.8, 0, 0], "axis": [1, 0, 0]},
        "hub": {"type": "fixed", "bodies": ["shaft", "disc"], "at": [0.4, 0, 0]}}},
    "simulation": {"end_time": 0.2, "step": 2.5e-4}})",
                                           {});
  EXPECT_EQ(path_of(problem).end, RigidPath::End::followed);
}

TEST(Lock, IsNoneInAnyProblemThatIsShipped) {
  for (const char* name :
       {"slider_crank", "four_bar", "spatial_slider_crank", "robot_arm", "running_press",
        "hard/bricard", "hard/change_point", "hard/many_revolutions", "hard/redundant_slider_crank",
        "hard/squeezer", "hard/four_bars_40", "hard/light_slider"}) {
    const RigidPath path = path_of(sample_problem(name));
    EXPECT_EQ(path.end, RigidPath::End::followed) << name << " at " << path.time;
  }
}

}  // namespace
}  // namespace pleuel::test::lock_test
