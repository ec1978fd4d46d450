#include "core/trust/sideways_buckling.hpp"

#include <utility>

#include "core/base/error.hpp"
#include "core/response/analysis.hpp"
#include "core/scene/problem_reader.hpp"
#include "tests/core/trust/buckling_findings.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::sideways_buckling_test {
namespace {

using test::buckling_findings_of;
using test::findings_of;
using test::read_scene;

constexpr double young = 2.1e11, shear = 8.0e10;
const double pi = std::numbers::pi;

/// A beam clamped at one end with a force across at the other, in its own plane x–y.
std::string cantilever(double force, const std::string& section, const std::string& effects,
                       const std::string& body = "") {
  return fmt::format(R"({{"scene": {{
      "materials": {{"m": {{"young": 2.1e11, "poisson": 0.3125, "density": 7850}}}},
      "bodies": {{"arm": {{"type": "beam", "from": [0, 0, 0], "to": [1.2, 0, 0], "material": "m",
                         "section": {}, "elements": 8{}}}}},
      "joints": {{"c": {{"type": "fixed", "bodies": ["ground", "arm"], "at": [0, 0, 0]}}}},
      "loads": {{"g": {{"type": "force", "body": "arm", "at": [1.2, 0, 0], "direction": [0, -1, 0],
                      "value": {}}}}}}},
      "effects": {},
      "simulation": {{"end_time": 0.002, "step": 0.001, "initial_state": "quasi-static"}},
      "responses": {{"s": {{"type": "stress", "body": "arm", "over_time": "max"}}}}}})",
                     section, body, force, effects);
}

const std::string thin = R"({"type": "rectangle", "width": 0.002, "height": 0.04})";

/// √(EI GJ) with J = hb³/3 (1 − 0.63 b/h) for b ≪ h.
double critical_force() {
  const double cube = 0.04 * std::pow(0.002, 3);
  const double lateral = young * cube / 12, twist = shear * cube / 3 * (1 - 0.63 * 0.05);
  return 4.0126 * std::sqrt(lateral * twist) / (1.2 * 1.2);
}

TEST(SidewaysBuckling, IsToldNearTheCriticalLoadInThePlaneAndInSpace) {
  for (const char* effects : {"{}", R"({"spatial_motion": "on"})"}) {
    for (const char* body : {"", R"(, "reduction": {"modes": 2})"}) {
      EXPECT_TRUE(
          findings_of(read_scene(cantilever(0.5 * critical_force(), thin, effects, body))).empty());
      // From three quarters on.
      EXPECT_TRUE(findings_of(read_scene(cantilever(0.73 * critical_force(), thin, effects, body)))
                      .empty());
      EXPECT_EQ(
          findings_of(read_scene(cantilever(0.77 * critical_force(), thin, effects, body))).size(),
          1u);
      const auto near =
          findings_of(read_scene(cantilever(0.9 * critical_force(), thin, effects, body)));
      ASSERT_EQ(near.size(), 1u) << effects << body;
      EXPECT_FALSE(near[0].is_serious);
      const auto beyond =
          findings_of(read_scene(cantilever(1.1 * critical_force(), thin, effects, body)));
      ASSERT_EQ(beyond.size(), 1u) << effects << body;
      EXPECT_TRUE(beyond[0].is_serious);
      EXPECT_NE(beyond[0].text.find("\"arm\" buckles out of the plane"), std::string::npos);
      EXPECT_NE(beyond[0].text.find("lateral-torsional"), std::string::npos);
    }
  }
}

/// Bent about its weak axis, or round, a beam stays in its plane.
TEST(SidewaysBuckling, DoesNotThreatenABeamThatIsStifferSideways) {
  EXPECT_TRUE(
      findings_of(read_scene(cantilever(
                      3.0, R"({"type": "rectangle", "width": 0.04, "height": 0.006})", "{}")))
          .empty());
  EXPECT_TRUE(
      findings_of(read_scene(cantilever(3.0, R"({"type": "circle", "diameter": 0.01})", "{}")))
          .empty());
}

/// A column whose motion in the plane is stable while it would fall out of it: P = π²EI/4L².
TEST(SidewaysBuckling, OfAColumnOutOfThePlaneOfMotionIsSerious) {
  const double critical = pi * pi * young * 0.04 * std::pow(0.002, 3) / 12 / (4 * 1.2 * 1.2);
  const auto pressed = [&](double share) {
    std::string text = cantilever(share * critical, thin, "{}");
    text.replace(text.find("[0, -1, 0]"), 10, "[-1, 0, 0]");
    // A little weight tells in which plane it moves; so little that there is a finding about it.
    text.replace(text.find("\"scene\": {"), 10, "\"scene\": {\"gravity\": [0, -1e-3, 0],");
    return buckling_findings_of(text);
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
    std::string text = cantilever(share * critical, thin, "{}");
    text.replace(text.find("[0, -1, 0]"), 10, "[-1, 0, 0]");
    text.replace(text.find("\"scene\": {"), 10, "\"scene\": {\"gravity\": [0, -1e-3, 0],");
    const std::string joints = "\"joints\": {";
    text.insert(text.find(joints) + joints.size(),
                R"("slide": {"type": "prismatic", "bodies": ["ground", "arm"], "at": [1.2, 0, 0],
                             "axis": [1, 0, 0]},)");
    return buckling_findings_of(text).size();
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
  std::string text = cantilever(force, thin, R"({"geometric_stiffening": "off"})");
  const auto put = [&](const std::string& old, const std::string& with) {
    text.replace(text.find(old), old.size(), with);
  };
  put(fmt::format("\"value\": {}", force),
      fmt::format(R"("value": {{"type": "table", "times": [0, 1, 2], "values": [{}, 0, 0]}})",
                  force));
  put("\"loads\": {", fmt::format(R"("loads": {{"m": {{"type": "torque", "body": "arm",
      "at": [1.2, 0, 0], "direction": [0, 0, -1],
      "value": {{"type": "table", "times": [0, 1, 2], "values": [0, 0, {}]}}}},)",
                                  0.9 * moment));
  // So slow that the arm follows: its first frequency across is 1.1 Hz.
  put("\"end_time\": 0.002, \"step\": 0.001", "\"end_time\": 2, \"step\": 0.01");
  const std::vector<Finding> findings = buckling_findings_of(text);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_NE(findings[0].text.find("at t = 2 s"), std::string::npos) << findings[0].text;
}

/// A square bar between hinges is a column on two pins in the plane of motion, where it stays
/// straight, and a clamped one out of it.
TEST(SidewaysBuckling, OfAStraightStrutInThePlaneOfItsHingesIsTold) {
  const double critical = pi * pi * young * std::pow(0.01, 4) / 12 / (1.2 * 1.2);
  for (const char* effects : {"{}", R"({"spatial_motion": "on"})"}) {
    const auto pressed = [&](double share) {
      std::string text = cantilever(
          share * critical, R"({"type": "rectangle", "width": 0.01, "height": 0.01})", effects);
      const auto put = [&](const std::string& old, const std::string& with) {
        text.replace(text.find(old), old.size(), with);
      };
      put("[0, -1, 0]", "[-1, 0, 0]");
      put(R"("initial_state": "quasi-static")", R"("initial_state": "consistent")");
      put(R"("end_time": 0.002)", R"("end_time": 0.2)");
      put(R"("c": {"type": "fixed", "bodies": ["ground", "arm"], "at": [0, 0, 0]})",
          R"("c": {"type": "revolute", "bodies": ["ground", "arm"], "at": [0, 0, 0],
                   "axis": [0, 0, 1]},
             "l": {"type": "point-on-line", "bodies": ["ground", "arm"], "at": [1.2, 0, 0],
                   "axis": [1, 0, 0]})");
      return buckling_findings_of(text);
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
    std::string text =
        cantilever(1.0, R"({"type": "rectangle", "width": 0.03, "height": 0.01})", "{}");
    const auto put = [&](const std::string& old, const std::string& with) {
      text.replace(text.find(old), old.size(), with);
    };
    put(R"("direction": [0, -1, 0],)", R"("direction": [-1, 0, 0],)");
    put(R"("value": 1})", fmt::format(R"("value": {{"type": "table", "interpolation": "monotone",
          "times": [0, 0.01, 0.02, 0.03, 0.06], "values": [0, {0}, {0}, 0, 0]}}}},
        "late": {{"type": "force", "body": "arm", "at": [1.2, 0, 0], "direction": [0, 1, 0],
          "value": {{"type": "table", "interpolation": "monotone",
            "times": [0, 0.04, 0.05, 0.06], "values": [0, 0, {1}, {1}]}}}})",
                                      2.5 * critical, across));
    put(R"("initial_state": "quasi-static")", R"("initial_state": "consistent")");
    put("\"end_time\": 0.002, \"step\": 0.001", "\"end_time\": 0.06, \"step\": 0.001");
    return buckling_findings_of(text);
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
    std::string text = cantilever(share * critical, thin, R"({"spatial_motion": "on"})");
    const auto put = [&](const std::string& old, const std::string& with) {
      text.replace(text.find(old), old.size(), with);
    };
    put(R"("bodies": {)", R"("bodies": {"top": {"type": "rigid", "at": [1.3, 0, 0], "mass": 1e-3,
      "inertia": [1e-6, 1e-6, 1e-6, 0, 0, 0]},)");
    put(R"("joints": {)", R"("joints": {"t": {"type": "fixed", "bodies": ["arm", "top"],
      "at": [1.2, 0, 0]},)");
    put(R"("body": "arm", "at": [1.2, 0, 0], "direction": [0, -1, 0])",
        R"("body": "top", "at": [13.2, 0, 0], "direction": [-1, 0, 0])");
    return buckling_findings_of(text);
  };
  EXPECT_TRUE(pressed(0.98).empty());
  EXPECT_THROW(pressed(1.02), SimulationError);
}

/// However many frames it has, and whether their stretches share its elements or divide them.
TEST(SidewaysBuckling, OfADividedBeamIsThatOfTheWhole) {
  for (const char* frames : {R"(, "frames": 2)", R"(, "frames": 12)"}) {
    const auto findings = [&](double share) {
      return buckling_findings_of(cantilever(share * critical_force(), thin, "{}", frames));
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
    return buckling_findings_of(cantilever(1.3 * critical_force(), thin, "{}", held));
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
    std::string text = cantilever(share * euler, thin, "{}", held);
    text.replace(text.find("[0, -1, 0]"), 10, "[-1, 0, 0]");
    text.replace(text.find("\"scene\": {"), 10, "\"scene\": {\"gravity\": [0, -1e-3, 0],");
    return buckling_findings_of(text);
  };
  EXPECT_EQ(pressed(1.05, "").size(), 1u);
  const std::string tip = R"(, "held": {"direction": [0, 0, 1], "at": 1})";
  // Clamped and pinned: 20.19 EI/L² in place of 2.467.
  EXPECT_TRUE(pressed(0.97 * 20.19 / 2.467, tip).empty());
  const std::vector<Finding> beyond = pressed(1.03 * 20.19 / 2.467, tip);
  ASSERT_EQ(beyond.size(), 1u);
  EXPECT_TRUE(beyond[0].is_serious) << beyond[0].text;
}

}  // namespace
}  // namespace pleuel::test::sideways_buckling_test
