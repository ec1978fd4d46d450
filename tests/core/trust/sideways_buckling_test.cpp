#include <utility>

#include "core/base/error.hpp"
#include "core/response/analysis.hpp"
#include "core/scene/problem_reader.hpp"
#include "core/trust/check_list.hpp"
#include "tests/core/trust/trust_scenes.hpp"
#include "tests/support/test.hpp"

/// A hydraulic cylinder: a barrel and a rod of 0.5 m each, which slides in the barrel's end, held by a
/// drive; pins at both ends, pressed by 1 kN.

namespace pleuel::test::sideways_buckling_test {
namespace {

using test::buckling_findings_of;
using test::findings_of;
using test::read_scene;

constexpr double young = 2.1e11, shear = 8.0e10;
const double pi = std::numbers::pi;

/// A beam clamped at one end with a force across at the other, in its own plane x–y.
OneBeam cantilever(double force, const std::string& section, const std::string& effects,
                   const std::string& body = "") {
  return {.name = "arm",
          .material = "m",
          .to = "[1.2, 0, 0]",
          .section = section,
          .elements = 8,
          .more = body,
          .materials = R"("m": {"young": 2.1e11, "poisson": 0.3125, "density": 7850})",
          .end_loads = {{force, "[0, -1, 0]"}},
          .simulation = at_rest(0.002, 0.001),
          .responses = R"("s": {"type": "stress", "body": "arm", "over_time": "max"})",
          .rest = R"("effects": )" + effects};
}

const std::string thin = rectangle(0.002, 0.04);

/// The thin one, pressed along its axis. A little weight tells in which plane it moves; so little that
/// there is a finding about it.
OneBeam column(double force, const std::string& body = "") {
  OneBeam arm = cantilever(force, thin, "{}", body);
  arm.end_loads[0].direction = "[-1, 0, 0]";
  arm.gravity = "[0, -1e-3, 0]";
  return arm;
}

/// √(EI GJ) with J = hb³/3 (1 − 0.63 b/h) for b ≪ h.
double critical_force() {
  const double cube = 0.04 * std::pow(0.002, 3);
  const double lateral = young * cube / 12, twist = shear * cube / 3 * (1 - 0.63 * 0.05);
  return 4.0126 * std::sqrt(lateral * twist) / (1.2 * 1.2);
}

TEST(SidewaysBuckling, IsToldNearTheCriticalLoadInThePlaneAndInSpace) {
  for (const char* effects : {"{}", R"({"spatial_motion": "on"})"}) {
    for (const char* body : {"", R"("reduction": {"modes": 2})"}) {
      const auto findings = [&](double share) {
        return findings_of(cantilever(share * critical_force(), thin, effects, body).problem());
      };
      EXPECT_TRUE(findings(0.5).empty());
      // From three quarters on.
      EXPECT_TRUE(findings(0.73).empty());
      EXPECT_EQ(findings(0.77).size(), 1u);
      const auto near = findings(0.9);
      ASSERT_EQ(near.size(), 1u) << effects << body;
      EXPECT_FALSE(near[0].is_serious);
      const auto beyond = findings(1.1);
      ASSERT_EQ(beyond.size(), 1u) << effects << body;
      EXPECT_TRUE(beyond[0].is_serious);
      EXPECT_NE(beyond[0].text.find("\"arm\" buckles out of the plane"), std::string::npos);
      EXPECT_NE(beyond[0].text.find("lateral-torsional"), std::string::npos);
    }
  }
}

/// Bent about its weak axis, or round, a beam stays in its plane.
TEST(SidewaysBuckling, DoesNotThreatenABeamThatIsStifferSideways) {
  for (const std::string& section : {rectangle(0.04, 0.006), circle(0.01)}) {
    EXPECT_TRUE(findings_of(cantilever(3.0, section, "{}").problem()).empty()) << section;
  }
}

/// A column whose motion in the plane is stable while it would fall out of it: P = π²EI/4L².
TEST(SidewaysBuckling, OfAColumnOutOfThePlaneOfMotionIsSerious) {
  const double critical = pi * pi * young * 0.04 * std::pow(0.002, 3) / 12 / (4 * 1.2 * 1.2);
  const auto pressed = [&](double share) {
    return buckling_findings_of(column(share * critical).text());
  };
  EXPECT_TRUE(pressed(0.7).empty());
  const std::vector<Finding> findings = pressed(1.05);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_TRUE(findings[0].is_serious);
  EXPECT_NE(findings[0].text.find("buckles"), std::string::npos) << findings[0].text;
}

/// The same column with its end in a slide along it, which neither turns nor goes sideways:
/// P = 4π²EI/L².
TEST(SidewaysBuckling, OfAColumnInASlideIsThatOfTwoClampedEnds) {
  const double critical = 4 * pi * pi * young * 0.04 * std::pow(0.002, 3) / 12 / (1.2 * 1.2);
  const auto pressed = [&](double share) {
    OneBeam arm = column(share * critical);
    arm.joints = on_ground("clamp", "fixed", "arm", "[0, 0, 0]") + ", " +
                 on_ground("slide", "prismatic", "arm", "[1.2, 0, 0]", R"("axis": [1, 0, 0])");
    return buckling_findings_of(arm.text()).size();
  };
  EXPECT_EQ(pressed(0.5), 0u);
  EXPECT_EQ(pressed(0.98), 0u);
  EXPECT_EQ(pressed(1.02), 1u);
}

/// First a force at the tip far below the critical one, then a smaller moment, along all of the arm:
/// over half of π √(EI GJ)/L it is critical.
TEST(SidewaysBuckling, IsLookedForAtEveryInstant) {
  const double cube = 0.04 * std::pow(0.002, 3);
  const double moment =
      0.5 * pi / 1.2 * std::sqrt(young * cube / 12 * shear * cube / 3 * (1 - 0.63 * 0.05));
  const double force = 0.72 * critical_force();
  ASSERT_LT(0.9 * moment, 1.2 * force);
  OneBeam arm = cantilever(0.0, thin, R"({"geometric_stiffening": "off"})");
  const auto table = [](double first, double last) {
    return fmt::format(R"({{"type": "table", "times": [0, 1, 2], "values": [{}, 0, {}]}})", first,
                       last);
  };
  arm.end_loads = {{table(force, 0.0), "[0, -1, 0]"},
                   {table(0.0, 0.9 * moment), "[0, 0, -1]", "", "m", "torque"}};
  // So slow that the arm follows: its first frequency across is 1.1 Hz.
  arm.simulation = at_rest(2.0, 0.01);
  const std::vector<Finding> findings = buckling_findings_of(arm.text());
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_NE(findings[0].text.find("at t = 2 s"), std::string::npos) << findings[0].text;
}

/// A square bar between hinges is a column on two pins in the plane of motion, where it stays
/// straight, and a clamped one out of it.
TEST(SidewaysBuckling, OfAStraightStrutInThePlaneOfItsHingesIsTold) {
  const double critical = pi * pi * young * std::pow(0.01, 4) / 12 / (1.2 * 1.2);
  for (const char* effects : {"{}", R"({"spatial_motion": "on"})"}) {
    const auto pressed = [&](double share) {
      OneBeam arm = cantilever(0.0, rectangle(0.01, 0.01), effects);
      arm.end_loads = {{share * critical, "[-1, 0, 0]"}};
      arm.simulation = time_loop(0.2, 0.001, R"("initial_state": "consistent")");
      arm.joints = on_two_supports("arm", "[1.2, 0, 0]");
      return buckling_findings_of(arm.text());
    };
    EXPECT_TRUE(pressed(0.4).empty()) << effects;
    const std::vector<Finding> findings = pressed(1.2);
    ASSERT_EQ(findings.size(), 1u) << effects;
    EXPECT_TRUE(findings[0].is_serious);
    EXPECT_NE(findings[0].text.find("buckles"), std::string::npos) << findings[0].text;
  }
}

/// A straight cantilever, pressed far beyond its Euler load and free again before anything bends it.
TEST(SidewaysBuckling, OfAStraightMemberIsToldThoughItBendsLater) {
  const double critical = pi * pi * young * 0.03 * std::pow(0.01, 3) / 12 / (4 * 1.2 * 1.2);
  const auto told = [&](double across) {
    OneBeam arm = cantilever(0.0, rectangle(0.03, 0.01), "{}");
    arm.end_loads = {{fmt::format(R"({{"type": "table", "interpolation": "monotone",
             "times": [0, 0.01, 0.02, 0.03, 0.06], "values": [0, {0}, {0}, 0, 0]}})",
                                  2.5 * critical),
                      "[-1, 0, 0]"},
                     {fmt::format(R"({{"type": "table", "interpolation": "monotone",
             "times": [0, 0.04, 0.05, 0.06], "values": [0, 0, {0}, {0}]}})",
                                  across)}};
    arm.simulation = time_loop(0.06, 0.001, R"("initial_state": "consistent")");
    return buckling_findings_of(arm.text());
  };
  const std::vector<Finding> alone = told(0.0), later = told(1.0);
  ASSERT_EQ(alone.size(), 1u);
  ASSERT_EQ(later.size(), 1u);
  EXPECT_FALSE(later[0].is_serious) << "the pulse is short";
  EXPECT_EQ(later[0].text, alone[0].text);
}

/// A column under a rigid body ten times as high as itself: P = (u/L)² EI with u tan u = 1/10.
TEST(SidewaysBuckling, OfAColumnUnderAHighBodyIsTold) {
  const double u = 0.311053;
  ASSERT_NEAR(u * std::tan(u), 0.1, 1e-6);
  const double critical = u * u * young * 0.04 * std::pow(0.002, 3) / 12 / (1.2 * 1.2);
  const auto pressed = [&](double share) {
    OneBeam arm = cantilever(0.0, thin, R"({"spatial_motion": "on"})");
    arm.bodies =
        R"("top": {"type": "rigid", "at": [1.3, 0, 0], "mass": 1e-3, "inertia": [1e-6, 1e-6, 1e-6, 0, 0, 0]})";
    arm.joints = on_ground("clamp", "fixed", "arm", "[0, 0, 0]") +
                 R"(, "t": {"type": "fixed", "bodies": ["arm", "top"], "at": [1.2, 0, 0]})";
    arm.end_loads = {};
    arm.loads = fmt::format(
        R"("g": {{"type": "force", "body": "top", "at": [13.2, 0, 0], "direction": [-1, 0, 0],
                                "value": {}}})",
        share * critical);
    return buckling_findings_of(arm.text());
  };
  EXPECT_TRUE(pressed(0.98).empty());
  EXPECT_THROW(pressed(1.02), SimulationError);
}

/// However many frames it has, and whether their stretches share its elements or divide them.
TEST(SidewaysBuckling, OfADividedBeamIsThatOfTheWhole) {
  for (const char* frames : {R"(, "frames": 2)", R"(, "frames": 12)"}) {
    const auto findings = [&](double share) {
      return buckling_findings_of(cantilever(share * critical_force(), thin, "{}", frames).text());
    };
    EXPECT_TRUE(findings(0.7).empty()) << frames;
    EXPECT_EQ(findings(0.9).size(), 1u) << frames;
    const std::vector<Finding> beyond = findings(2.0);
    ASSERT_GE(beyond.size(), 1u) << frames;  // in space frames that turn have some of it, too
    EXPECT_NE(beyond[0].text.find("\"arm\" buckles out of the plane"), std::string::npos);
    EXPECT_NE(beyond[0].text.find("the critical load is 0.5"), std::string::npos) << beyond[0].text;
  }
}

/// Held sideways all along, a beam cannot leave its plane; at its middle, it can in two halves.
TEST(SidewaysBuckling, IsNoDangerWhereTheFileSaysThatTheBeamIsHeld) {
  const auto findings = [](const std::string& held) {
    return buckling_findings_of(cantilever(1.3 * critical_force(), thin, "{}", held).text());
  };
  ASSERT_EQ(findings("").size(), 1u);
  EXPECT_TRUE(findings("")[0].is_serious);
  for (const char* places : {"", R"(, "at": 1)", R"(, "at": [0.5, "100 %"])"}) {
    const std::vector<Finding> held =
        findings(fmt::format(R"(, "held": {{"direction": [0, 0, 1]{}}})", places));
    ASSERT_EQ(held.size(), 1u) << places;
    EXPECT_FALSE(held[0].is_serious) << held[0].text;
    EXPECT_NE(held[0].text.find("Without what holds it"), std::string::npos) << held[0].text;
  }
  const std::vector<Finding> in_plane = findings(R"(, "held": {"direction": [0, 1, 0]})");
  ASSERT_EQ(in_plane.size(), 1u);
  EXPECT_FALSE(in_plane[0].is_serious) << "what cannot twist does not buckle sideways";
  const std::vector<Finding> at_foot = findings(R"(, "held": {"direction": [0, 1, 0], "at": 0})");
  ASSERT_EQ(at_foot.size(), 2u);
  EXPECT_TRUE(at_foot[0].is_serious);
}

/// A column that is held at its middle out of its plane buckles as a clamped and pinned half there.
TEST(SidewaysBuckling, OfAColumnThatIsHeldIsThatOfItsParts) {
  const double euler = pi * pi * young * 0.04 * std::pow(0.002, 3) / 12 / (4 * 1.2 * 1.2);
  const auto pressed = [&](double share, const std::string& held) {
    return buckling_findings_of(column(share * euler, held).text());
  };
  EXPECT_EQ(pressed(1.05, "").size(), 1u);
  const std::string tip = R"(, "held": {"direction": [0, 0, 1], "at": 1})";
  // Clamped and pinned: 20.19 EI/L² in place of 2.467.
  EXPECT_TRUE(pressed(0.97 * 20.19 / 2.467, tip).empty());
  const std::vector<Finding> beyond = pressed(1.03 * 20.19 / 2.467, tip);
  ASSERT_EQ(beyond.size(), 1u);
  EXPECT_TRUE(beyond[0].is_serious) << beyond[0].text;
}

constexpr double length = 0.5, press = 1000.0, rod = 0.01;

ProblemFile cylinder(double barrel, const std::string& spatial_motion, double allowed,
                     const std::string& loads = "") {
  return read_scene(fmt::format(
      R"j({{"scene": {{"gravity": [0, 0, 0],
        "materials": {{"light": {{"young": {0}, "poisson": 0.3, "density": 1}}}},
        "bodies": {{
          "barrel": {{"type": "beam", "from": [0, 0, 0], "to": [{1}, 0, 0], "elements": 6,
                     "material": "light", "frame": "chord", "damping": {{"stiffness": 1e-4}},
                     "section": {{"type": "rectangle", "width": {2}, "height": {2}}}}},
          "rod": {{"type": "beam", "from": [{1}, 0, 0], "to": [{3}, 0, 0], "elements": 6,
                  "material": "light", "frame": "chord", "damping": {{"stiffness": 1e-4}},
                  "section": {{"type": "rectangle", "width": {4}, "height": {4}}}}}}},
        "joints": {{
          "foot": {{"type": "revolute", "bodies": ["ground", "barrel"], "at": [0, 0, 0]}},
          "slide": {{"type": "prismatic", "bodies": ["barrel", "rod"], "at": [{1}, 0, 0],
                    "axis": [1, 0, 0], "drive": {{"type": "constant", "value": 0}}}},
          "eye": {{"type": "point-on-line", "bodies": ["ground", "rod"], "at": [{3}, 0, 0], "axis": [1, 0, 0]}}}},
        "loads": {{{7}"press": {{"type": "force", "body": "rod", "at": [{3}, 0, 0],
                             "direction": [-1, 0, 0], "value": {5}}}}}}},
      "effects": {{"spatial_motion": "{6}", "geometric_stiffening": "on"}},
      "simulation": {{"end_time": 0.01, "step": 0.005, "initial_state": "quasi-static"}},
      "responses": {{"own": {{"type": "buckling", "body": "rod", "over_time": "max"}}}},
      "constraints": {{"stability": {{"response": "own", "upper": {8}}}}}}})j",
      young, length, barrel, 2 * length, rod, press, spatial_motion, loads, allowed));
}

double bending_stiffness(double side) {
  return young * std::pow(side, 4) / 12;
}

/// The smallest load of a column of two halves with pins at its ends. A sin k₁x and B sin k₂(L − x) with
/// kᵢ² = P/EIᵢ have one deflection and one slope where they meet:  k₁ cot k₁l + k₂ cot k₂l = 0.
double stepped_column(double one, double other) {
  const auto mismatch = [&](double load) {
    const double k1 = std::sqrt(load / one), k2 = std::sqrt(load / other);
    return k1 / std::tan(k1 * length) + k2 / std::tan(k2 * length);
  };
  // From all of one stiffness to the pole, where the softer half would be a half wave by itself.
  const double wave = std::numbers::pi / length;
  double low = 1e-3, high = wave * wave * std::min(one, other) * (1 - 1e-9);
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (mismatch(middle) > 0.0 ? low : high) = middle;
  }
  return low;
}

TEST(PromisedBuckling, IsComparedWithThatOfACylinder) {
  const double own = std::pow(std::numbers::pi / length, 2) * bending_stiffness(rod);
  EXPECT_NEAR(stepped_column(bending_stiffness(rod), bending_stiffness(rod)), own / 4, 1e-9 * own);
  for (const double barrel : {0.01, 0.014, 0.02}) {
    const double whole = stepped_column(bending_stiffness(rod), bending_stiffness(barrel));
    const Finding finding =
        only(findings_of(cylinder(barrel, "off", 0.2), check_promised_buckling));
    EXPECT_FALSE(finding.is_serious);
    EXPECT_THAT(finding.text, HasSubstr(fmt::format(
                                  "it would buckle at {:.3g} times what presses it", own / press)));
    EXPECT_THAT(finding.text, HasSubstr(fmt::format("something buckles at {:.3g} times the loads",
                                                    whole / press)));
    EXPECT_THAT(finding.text, HasSubstr(fmt::format("For 5 times limit \"own\" to some {:.2g}.",
                                                    0.2 * whole / own)));
  }
}

/// The whole buckles at 2.5 to 2.9 times.
TEST(PromisedBuckling, IsKeptWhereTheLimitAllowsIt) {
  EXPECT_THAT(findings_of(cylinder(0.014, "off", 0.5), check_promised_buckling), IsEmpty());
}

TEST(PromisedBuckling, IsTrueOfAMemberByItself) {
  const OneBeam column{
      .name = "bar",
      .section = rectangle(0.01, 0.01),
      .elements = 6,
      .more = R"("damping": {"stiffness": 1e-4}, "frame": "chord")",
      .joints = on_two_supports("bar"),
      .end_loads = {{1500.0, "[-1, 0, 0]"}},
      .simulation = at_rest(0.01, 0.005),
      .responses = R"("own": {"type": "buckling", "body": "bar", "over_time": "max"})"};
  EXPECT_THAT(findings_of(column.problem(), check_promised_buckling), IsEmpty());
}

/// Without its load this beam would move in another set of constraints: a torque in a plane on a
/// planar joint, which has no equations there.
TEST(PromisedBuckling, IsNotAskedWhereLoadsDecideWhatConstraintsThereAre) {
  const OneBeam sliding{
      .name = "bar",
      .to = "[0.5, 0, 0]",
      .section = rectangle(0.02, 0.03),
      .joints = on_ground("p", "planar", "bar", "[0, 0, 0]", R"("axis": [0, 0, 1])"),
      .end_loads = {{R"({"type": "ramp", "to": 100, "end": 0.005})", "[0, 0, 1]", "", "turn",
                     "torque"}},
      .simulation = time_loop(0.005, 0.0005),
      .responses = R"("own": {"type": "buckling", "body": "bar", "over_time": "max"})"};
  EXPECT_THAT(findings_of(sliding.problem(), check_promised_buckling), IsEmpty());
}

}  // namespace
}  // namespace pleuel::test::sideways_buckling_test
