#include "core/trust/check_list.hpp"
#include "tests/core/trust/trust_scenes.hpp"
#include "tests/support/test.hpp"

/// A square column of 1 m × 10 mm, pressed slowly: EI = 175 N m².
namespace pleuel::test::stability_test {
namespace {

constexpr double stiffness = 2.1e11 * 1e-8 / 12;

std::vector<Finding> findings_of_column(const std::string& bodies, const std::string& joints,
                                        const std::string& loaded, double at, double force,
                                        const std::string& springs = "",
                                        const std::string& spatial_motion = "on",
                                        FindChecks find = check_stability, double end_time = 0.1) {
  const std::string press = fmt::format(
      R"("press": {{"type": "force", "body": "{}", "at": [{}, 0, 0], "direction": [-1, 0, 0],
                             "value": {{"type": "ramp", "to": {}, "end": 0.05}}}})",
      loaded, at, force);
  const OneBeam bar{
      .name = "bar",
      .material = "light",
      .section = rectangle(0.01, 0.01),
      .elements = 6,
      .more = R"("damping": {"stiffness": 1e-4})",
      .materials = light,
      .bodies = bodies,
      .joints = joints,
      .loads = springs + press,
      .simulation = time_loop(end_time, 0.0025),
      .rest = fmt::format(R"("effects": {{"spatial_motion": "{}", "geometric_stiffening": "on"}})",
                          spatial_motion)};
  return findings_of(bar.problem(), find);
}

std::string rigid(const std::string& name, double at) {
  return fmt::format(R"(, "{}": {{"type": "rigid", "at": [{}, 0, 0], "mass": 1e-4,
                                 "inertia": [1e-8, 1e-8, 1e-8, 0, 0, 0]}})",
                     name, at);
}

/// Root of u tan u = right below π/2.
double root(double right) {
  double low = 0.0, high = std::numbers::pi / 2;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (middle * std::tan(middle) < right ? low : high) = middle;
  }
  return low;
}

/// One finding, serious, at 1.02 of a critical load; none at 0.98 of it.
template <class FindingsAt>
void expect_critical(double load, const FindingsAt& findings_at) {
  EXPECT_TRUE(findings_at(0.98 * load).empty());
  const Finding finding = only(findings_at(1.02 * load));
  EXPECT_TRUE(finding.is_serious);
  EXPECT_NE(finding.text.find("\"bar\""), std::string::npos) << finding.text;
  EXPECT_NE(finding.text.find("buckles"), std::string::npos) << finding.text;
}

const std::string clamp =
    R"("wall": {"type": "fixed", "bodies": ["ground", "bar"], "at": [0, 0, 0]})";

TEST(Stability, AreToldFromTheEulerLoadOfACantileverOn) {
  const double euler = std::numbers::pi * std::numbers::pi * stiffness / 4;
  expect_critical(euler,
                  [](double force) { return findings_of_column("", clamp, "bar", 1, force); });
}

const std::string hinge =
    R"("foot": {"type": "revolute", "bodies": ["ground", "bar"], "at": [0, 0, 0]})";

/// On a hinge with a spring of stiffness k at the foot: P = u² EI/L² with u tan u = k L/EI; beyond the
/// load k/L, too, at which a rigid bar would fall.
TEST(Stability, BuckleWithTheSpringThatTheyStandOn) {
  for (const char* spatial_motion : {"off", "on"}) {
    for (const double ratio : {0.3, 3.0, 30.0}) {
      SCOPED_TRACE(fmt::format("space {}, k L/EI = {}", spatial_motion, ratio));
      const double u = root(ratio);
      const auto findings_at = [&](double force) {
        return findings_of_column("", hinge, "bar", 1, force,
                                  fmt::format(R"("foot_spring": {{"type": "joint", "joint": "foot",
                                               "stiffness": {}}}, )",
                                              ratio * stiffness),
                                  spatial_motion);
      };
      expect_critical(u * u * stiffness, findings_at);
      EXPECT_EQ(findings_at(1.3 * std::max(u * u, ratio) * stiffness).size(), 1);
    }
  }
}

/// The same column beside a wheel that turns and that nothing connects with it.
TEST(Stability, BuckleBesideWhatTurns) {
  const std::string wheel = R"(, "wheel": {"type": "rigid", "at": [3, 0, 0], "mass": 1,
      "inertia": [0.01, 0.01, 0.01, 0, 0, 0], "angular_velocity": [0, 0, 10]})";
  const std::string shaft = R"(, "shaft": {"type": "revolute", "bodies": ["ground", "wheel"],
      "at": [3, 0, 0], "drive": {"type": "constant-speed", "speed": 10}})";
  for (const char* spatial_motion : {"off", "on"}) {
    SCOPED_TRACE(spatial_motion);
    const double u = root(3.0);
    const auto findings_at = [&](double force) {
      return findings_of_column(wheel, hinge + shaft, "bar", 1, force,
                                fmt::format(R"("foot_spring": {{"type": "joint", "joint": "foot",
                                             "stiffness": {}}}, )",
                                            3.0 * stiffness),
                                spatial_motion);
    };
    expect_critical(u * u * stiffness, findings_at);
    EXPECT_EQ(findings_at(4.0 * stiffness).size(), 1);
  }
}

/// Clamped at the foot and held by stiff springs at the tip: P = 20.19 EI/L², u tan u = u²  with
/// tan u = u (Timoshenko & Gere, §2.1), eight times that of a free tip, by which none is judged.
TEST(Stability, BuckleBetweenSpringsThatHoldTheTip) {
  const std::string springs = R"(
      "y": {"type": "spring", "bodies": ["ground", "bar"], "at": [[1, 10, 0], [1, 0, 0]], "stiffness": 1e7},
      "z": {"type": "spring", "bodies": ["ground", "bar"], "at": [[1, 0, 10], [1, 0, 0]], "stiffness": 1e7}, )";
  const double critical = 20.1907 * stiffness;
  expect_critical(critical, [&](double force) {
    return findings_of_column("", clamp, "bar", 1, force, springs);
  });
  const auto by_itself = [&](const std::string& held, const std::string& spatial_motion) {
    return findings_of_column("", clamp, "bar", 1, 0.5 * critical, held, spatial_motion,
                              check_sideways_buckling);
  };
  EXPECT_TRUE(by_itself(springs, "on").empty());
  // In a plane only out of it, where nothing holds the tip.
  const std::string in_plane = springs.substr(0, springs.find("\"z\""));
  for (const Finding& finding : by_itself(in_plane, "auto")) {
    EXPECT_EQ(finding.text.find("in the plane of motion"), std::string::npos) << finding.text;
  }
}

/// A rigid mast of d on the tip, pressed at its top: P = EI u²/L² with u tan u = L/d (the moment at the
/// tip is P times the way of the top).
TEST(Stability, IncludeTheWayOfALoadAboveTheTip) {
  for (const double height : {1.0, 10.0}) {
    const double u = root(1.0 / height);
    expect_critical(stiffness * u * u, [height](double force) {
      return findings_of_column(rigid("mast", 1 + height),
                                clamp + R"(, "weld": {"type": "fixed", "bodies": ["bar", "mast"],
                                                "at": [1, 0, 0]})",
                                "mast", 1 + height, force, "", "on", check_stability, 0.4);
    });
  }
}

/// Rigid eyes of d at both ends on pins: P = EI (2u/L)² with u tan u = L/(2d).
TEST(Stability, IncludeTheTurningOfEndFittings) {
  const double u = root(0.5 / 0.12);
  expect_critical(4 * stiffness * u * u, [](double force) {
    return findings_of_column(rigid("left", -0.12) + rigid("right", 1.12),
                              R"("a": {"type": "fixed", "bodies": ["bar", "left"], "at": [0, 0, 0]},
           "b": {"type": "fixed", "bodies": ["bar", "right"], "at": [1, 0, 0]},
           "pin": {"type": "universal", "bodies": ["ground", "left"], "at": [-0.12, 0, 0],
                   "axis": [0, 1, 0], "second_axis": [0, 0, 1]},
           "line": {"type": "point-on-line", "bodies": ["ground", "right"], "at": [1.12, 0, 0],
                    "axis": [1, 0, 0]})",
                              "right", 1.12, force);
  });
}

/// A shaft of 1 m × 10 mm × h between a ball joint and a line, in the units of
/// elastic_stability_test.cpp: its lowest critical speed and its Euler load.
struct Shaft {
  double height, speed;
  double press = 0.0, gravity = 0.0, damping = 0.0;
  double disk = 0.0;  ///< on its middle [kg]
};

std::string disk(double mass, double speed) {
  return fmt::format(R"(, "disk": {{"type": "rigid", "at": [0.5, 0, 0], "mass": {0},
                          "inertia": [{1}, {1}, {1}, 0, 0, 0], "angular_velocity": [{2}, 0, 0]}})",
                     mass, 1e-6 * mass, speed);
}

const std::string weld =
    R"(, "weld": {"type": "fixed", "bodies": ["bar", "disk"], "at": [0.5, 0, 0]})";

std::vector<Finding> findings_of_shaft(const Shaft& shaft) {
  const double wave = std::numbers::pi * std::numbers::pi;
  const double speed = shaft.speed * wave * std::sqrt(7e10 / 2700 / 12) * 0.01;
  const OneBeam bar{
      .name = "bar",
      .material = "aluminium",
      .section = rectangle(0.01, shaft.height),
      .elements = 6,
      .more = fmt::format(
          R"("frame": "chord", "angular_velocity": [{}, 0, 0], "damping": {{"stiffness": {}}})",
          speed, shaft.damping),
      .materials = plain_aluminium,
      .bodies = shaft.disk > 0.0 ? disk(shaft.disk, speed) : "",
      .joints = on_ground("a", "spherical", "bar", "[0, 0, 0]") + ", " +
                on_ground("l", "point-on-line", "bar", "[1, 0, 0]", R"("axis": [1, 0, 0])") +
                (shaft.disk > 0.0 ? weld : ""),
      .end_loads = {{shaft.press * wave * 7e10 * shaft.height * 1e-6 / 12, "[-1, 0, 0]", "",
                     "press"}},
      .gravity = fmt::format("[0, {}, 0]", -shaft.gravity),
      .simulation = time_loop(0.1, 2e-4),
      .rest = R"("effects": {"spatial_motion": "on", "geometric_stiffening": "on"})"};
  return findings_of(bar.problem(), check_stability);
}

/// A shaft that is as stiff in both planes is held by gyroscopic forces beyond its critical speeds,
/// however its weight or a sudden press makes it vibrate: (s² + K)² + 4Ω²s² has imaginary roots.
TEST(Stability, AreNoShaftsBeyondTheirCriticalSpeeds) {
  for (const double speed : {0.5, 1.5, 2.5, 3.5}) {
    EXPECT_TRUE(findings_of_shaft({0.01, speed, 0.2, 9.81}).empty()) << speed;
    for (const double mass : {0.1, 1.0}) {
      EXPECT_TRUE(findings_of_shaft({0.01, speed, 0.2, 9.81, 0.0, mass}).empty()) << speed;
      EXPECT_TRUE(findings_of_shaft({0.01, speed, 0.2, 0.0, 0.0, mass}).empty()) << speed;
    }
  }
}

/// A flat shaft of ratio 2 grows between its critical speeds 1 and 2, pressed or not.
TEST(Stability, AreFlatShaftsBetweenTheirCriticalSpeeds) {
  for (const double press : {0.0, 0.02, 0.1}) {
    EXPECT_TRUE(findings_of_shaft({0.02, 0.9, press}).empty()) << press;
    EXPECT_TRUE(findings_of_shaft({0.02, 2.5, press}).empty()) << press;
    for (const double speed : {1.1, 1.5, 1.9}) {
      const std::vector<Finding> findings = findings_of_shaft({0.02, speed, press});
      ASSERT_EQ(findings.size(), 1) << press << " " << speed;
      EXPECT_TRUE(findings[0].is_serious);
      EXPECT_NE(findings[0].text.find("\"bar\""), std::string::npos) << findings[0].text;
      EXPECT_NE(findings[0].text.find("buckles"), std::string::npos) << findings[0].text;
    }
  }
}

/// Damping that turns with a shaft makes it whirl beyond its first critical speed.
TEST(Stability, AreShaftsThatDampThemselves) {
  EXPECT_TRUE(findings_of_shaft({0.01, 0.9, 0.0, 0.0, 1e-4}).empty());
  const Finding finding = only(findings_of_shaft({0.01, 1.5, 0.0, 0.0, 1e-4}));
  EXPECT_NE(finding.text.find("\"bar\" whirls"), std::string::npos) << finding.text;
}

}  // namespace
}  // namespace pleuel::test::stability_test
