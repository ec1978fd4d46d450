#include "core/trust/lateral_stability.hpp"

#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/response/analysis.hpp"
#include "core/scene/problem_reader.hpp"
#include "core/section/rectangle_section.hpp"
#include "core/trust/sideways_buckling.hpp"
#include "tests/core/trust/doubts_of.hpp"

namespace {

using namespace pleuel;
using test::doubts_of;
using test::read_scene;

constexpr double young = 2.1e11, shear = 8.0e10, length = 1.2;
constexpr int count = 16;
const double pi = std::numbers::pi;

/// So thin that 1 − EI/EI_bending is one to 1e-4.
Beam<double> thin_beam() {
  BeamElement<double> element{length / count, young, shear, 7850.0,
                              rectangle_section<double>(0.0005, 0.05)};
  Beam<double> beam;
  beam.elements.assign(count, element);
  return beam;
}

struct Ends {
  LateralSupport first, last;
};
constexpr LateralSupport clamped{true, true, true}, forked{true, false, true}, open{};

double factor(const Ends& ends, double axial, const std::vector<double>& moments) {
  const Beam<double> beam = thin_beam();
  std::vector<LateralSupport> supports(count + 1);
  supports.front() = ends.first;
  supports.back() = ends.last;
  PlaneLoad load;
  for (std::size_t e = 0; e < count; ++e) {
    load.axial.push_back(axial);
    load.moment.push_back({moments[e], moments[e + 1]});
  }
  return lateral_load_factor(beam, BendingPlane::xy, supports, load);
}

double lateral_stiffness() {
  return young * thin_beam().elements[0].section.inertia_y;
}
double torsional_stiffness() {
  return shear * thin_beam().elements[0].section.torsion;
}
double pair_stiffness() {
  return std::sqrt(lateral_stiffness() * torsional_stiffness());
}

/// From x = 0 on, of one newton at the end, and constant.
std::vector<double> tip_force() {
  std::vector<double> moments;
  for (int i = 0; i <= count; ++i) moments.push_back(length * (1.0 - double(i) / count));
  return moments;
}
const std::vector<double> none(count + 1, 0.0), constant(count + 1, 1.0);

// Sixteen elements: 1e-5 in columns. Twist is linear in an element: (π/16)²/24 = 1.6e-3 for a half
// wave of it, less for a quarter.

TEST(LateralStability, OfAConstantMomentBetweenForksIsTheClosedForm) {
  EXPECT_NEAR(factor({forked, forked}, 0.0, constant) / (pi * pair_stiffness() / length), 1.0016,
              2e-4);
}

TEST(LateralStability, OfACantileverWithATipForceIsTheClosedForm) {
  const double critical = 4.0126 * pair_stiffness() / (length * length);
  EXPECT_NEAR(factor({clamped, open}, 0.0, tip_force()) / critical, 1.001, 2e-4);
}

TEST(LateralStability, DoesNotDependOnTheSenseOfBending) {
  std::vector<double> opposite = tip_force();
  for (double& moment : opposite) moment = -moment;
  EXPECT_NEAR(factor({clamped, open}, 0.0, opposite) / factor({clamped, open}, 0.0, tip_force()),
              1.0, 1e-9);
}

TEST(LateralStability, OfColumnsIsTheEulerLoadOfTheirEnds) {
  const double unit = pi * pi * lateral_stiffness() / (length * length);
  EXPECT_NEAR(factor({clamped, open}, -1.0, none) / (unit / 4), 1.0, 1e-4);
  EXPECT_NEAR(factor({forked, forked}, -1.0, none) / unit, 1.0, 1e-4);
  EXPECT_NEAR(factor({clamped, clamped}, -1.0, none) / (4 * unit), 1.0, 1e-4);
  EXPECT_NEAR(factor({clamped, forked}, -1.0, none) / (2.045748 * unit), 1.0, 1e-4);
  EXPECT_TRUE(std::isinf(factor({forked, forked}, 1.0, none))) << "pull";
}

/// A column of two sections, clamped below and free above: by the solutions of EI u'' = −P u on
/// both parts, tan(k₁ l₁) tan(k₂ l₂) = k₂/k₁ with k² = P/EI (Timoshenko & Gere, Theory of Elastic
/// Stability, §2.14).
TEST(LateralStability, OfASteppedColumnIsTheRootOfItsEquation) {
  Beam<double> beam = thin_beam();
  for (int i = 0; i < 6; ++i) {  // 450 mm of 1200 mm
    beam.elements[i].section = rectangle_section<double>(0.0008, 0.05);
  }
  const double below = 6 * length / count, above = length - below;
  const double thick = young * beam.elements.front().section.inertia_y,
               thin = young * beam.elements.back().section.inertia_y;
  const auto open_equation = [&](double load) {
    const double k1 = std::sqrt(load / thick), k2 = std::sqrt(load / thin);
    return std::tan(k1 * below) * std::tan(k2 * above) - k2 / k1;
  };
  // Bisection below the first pole, where k₂ l₂ is a right angle.
  double low = 0.0, high = thin * std::pow(pi / 2 / above, 2) * (1 - 1e-12);
  for (int i = 0; i < 200; ++i) {
    const double middle = (low + high) / 2;
    (open_equation(middle) < 0.0 ? low : high) = middle;
  }
  std::vector<LateralSupport> supports(count + 1);
  supports.front() = clamped;
  PlaneLoad load;
  load.axial.assign(count, -1.0);
  load.moment.assign(count, {0.0, 0.0});
  EXPECT_NEAR(lateral_load_factor(beam, BendingPlane::xy, supports, load) / low, 1.0, 1e-4);
  // Between those of its two sections.
  EXPECT_GT(low, 1.2 * pi * pi * thin / (4 * length * length));
}

TEST(LateralStability, OfABeamThatNothingHoldsIsNotANumber) {
  EXPECT_TRUE(std::isnan(factor({open, open}, -1.0, none)));
}

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

std::vector<Doubt> sideways_doubts_of(const std::string& text) {
  return doubts_of(read_scene(text), doubt_sideways_buckling);
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
          doubts_of(read_scene(cantilever(0.5 * critical_force(), thin, effects, body))).empty());
      // From three quarters on.
      EXPECT_TRUE(
          doubts_of(read_scene(cantilever(0.73 * critical_force(), thin, effects, body))).empty());
      EXPECT_EQ(
          doubts_of(read_scene(cantilever(0.77 * critical_force(), thin, effects, body))).size(),
          1u);
      const auto near =
          doubts_of(read_scene(cantilever(0.9 * critical_force(), thin, effects, body)));
      ASSERT_EQ(near.size(), 1u) << effects << body;
      EXPECT_FALSE(near[0].is_serious);
      const auto beyond =
          doubts_of(read_scene(cantilever(1.1 * critical_force(), thin, effects, body)));
      ASSERT_EQ(beyond.size(), 1u) << effects << body;
      EXPECT_FALSE(beyond[0].is_serious) << "a member that is held sideways";
      EXPECT_NE(beyond[0].text.find("\"arm\" buckles out of the plane"), std::string::npos);
      EXPECT_NE(beyond[0].text.find("lateral-torsional"), std::string::npos);
    }
  }
}

/// Bent about its weak axis, or round, a beam stays in its plane.
TEST(SidewaysBuckling, DoesNotThreatenABeamThatIsStifferSideways) {
  EXPECT_TRUE(doubts_of(read_scene(cantilever(
                            3.0, R"({"type": "rectangle", "width": 0.04, "height": 0.006})", "{}")))
                  .empty());
  EXPECT_TRUE(
      doubts_of(read_scene(cantilever(3.0, R"({"type": "circle", "diameter": 0.01})", "{}")))
          .empty());
}

/// A column whose motion in the plane is stable while it would fall out of it: P = π²EI/4L².
TEST(SidewaysBuckling, OfAColumnOutOfThePlaneOfMotionIsSerious) {
  const double critical = pi * pi * young * 0.04 * std::pow(0.002, 3) / 12 / (4 * 1.2 * 1.2);
  const auto pressed = [&](double share) {
    std::string text = cantilever(share * critical, thin, "{}");
    text.replace(text.find("[0, -1, 0]"), 10, "[-1, 0, 0]");
    // A little weight tells in which plane it moves; so little that there is a doubt about it.
    text.replace(text.find("\"scene\": {"), 10, "\"scene\": {\"gravity\": [0, -1e-3, 0],");
    return sideways_doubts_of(text);
  };
  EXPECT_TRUE(pressed(0.7).empty());
  const std::vector<Doubt> doubts = pressed(1.05);
  ASSERT_EQ(doubts.size(), 1u);
  EXPECT_TRUE(doubts[0].is_serious);
  EXPECT_NE(doubts[0].text.find("about its weak axis"), std::string::npos);
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
    return sideways_doubts_of(text).size();
  };
  EXPECT_EQ(pressed(0.5), 0u);
  EXPECT_EQ(pressed(0.7), 0u);
  EXPECT_EQ(pressed(0.9), 1u);
}

/// However many frames it has, and whether their stretches share its elements or divide them.
TEST(SidewaysBuckling, OfADividedBeamIsThatOfTheWhole) {
  for (const char* frames : {R"(, "frames": 2)", R"(, "frames": 12)"}) {
    const auto doubts = [&](double share) {
      return sideways_doubts_of(cantilever(share * critical_force(), thin, "{}", frames));
    };
    EXPECT_TRUE(doubts(0.7).empty()) << frames;
    EXPECT_EQ(doubts(0.9).size(), 1u) << frames;
    const std::vector<Doubt> beyond = doubts(2.0);
    ASSERT_EQ(beyond.size(), 1u) << frames;
    EXPECT_NE(beyond[0].text.find("\"arm\" buckles out of the plane"), std::string::npos);
    EXPECT_NE(beyond[0].text.find("the critical load is 0.5"), std::string::npos) << beyond[0].text;
  }
}

}  // namespace
