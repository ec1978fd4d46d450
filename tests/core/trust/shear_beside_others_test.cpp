#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/section/section_properties.hpp"
#include "tests/core/trust/sheared_beam.hpp"

/// Stubby beams beside others and springs: what shear passes on, and what it is measured by.
namespace pleuel::test::shear_beside_others_test {
namespace {

using namespace sheared_beam;
using ::testing::HasSubstr;

/// A cantilever of two beams that are welded in its middle, 200 mm long and 80 mm deep, and what a force
/// at its tip moves with shear over that without: (h/L)² E/(4 κ G) = 0.12, half of it in each beam.
TEST(ShearOfSeveralBeams, AddsUp) {
  const auto findings = [](const std::string& shear) {
    return findings_of(read_scene(fmt::format(R"j({{"scene": {{"bodies": {{
        "first": {{"type": "beam", "from": [0, 0, 0], "to": [0.1, 0, 0], "material": "steel", "elements": 2, {0},
                   "section": {{"type": "rectangle", "width": "20 mm", "height": "80 mm"}}}},
        "second": {{"type": "beam", "from": [0.1, 0, 0], "to": [0.2, 0, 0], "material": "steel", "elements": 2, {0},
                    "section": {{"type": "rectangle", "width": "20 mm", "height": "80 mm"}}}}}},
      "joints": {{"wall": {{"type": "fixed", "bodies": ["ground", "first"], "at": [0, 0, 0]}},
                 "weld": {{"type": "fixed", "bodies": ["first", "second"], "at": [0.1, 0, 0]}}}},
      "loads": {{"push": {{"type": "force", "body": "second", "at": [0.2, 0, 0], "direction": [0, -1, 0],
                          "value": {{"type": "ramp", "to": 1000, "end": 0.01}}}}}}}},
      "simulation": {{"end_time": 0.01, "step": 0.001}},
      "responses": {{"tip": {{"type": "position", "body": "second", "at": 1, "direction": "y",
                              "over_time": "min"}}}}}})j",
                                              shear)),
                       check_variants);
  };
  const std::vector<Finding> found = findings(R"("shear": false)");
  ASSERT_EQ(found.size(), 1U);
  EXPECT_TRUE(found[0].is_serious);
  EXPECT_THAT(found[0].text, HasSubstr(R"("second", "first" are stubby)"));
  EXPECT_THAT(found[0].text, HasSubstr(R"("tip" by 11 % (of)"));  // 0.12/(1 + 0.12)
  EXPECT_TRUE(findings(R"("shear": true)").empty());
}

/// Two cantilevers, a block of 100 mm and a beam, share a load on the bar that ties their tips: the
/// block yields by shear and leaves more to the beam.
TEST(ShearRange, OfABlockIsToldOfWhatStandsBesideIt) {
  const auto problem = [](bool has_shear) {
    return read_scene(fmt::format(R"j({{"scene": {{"bodies": {{
        "block": {{"type": "beam", "from": [0, 0, 0], "to": [0.1, 0, 0], "material": "steel",
                   "elements": 2, "shear": {},
                   "section": {{"type": "rectangle", "width": 0.01, "height": 0.1}}}},
        "beam": {{"type": "beam", "from": [0, 0.5, 0], "to": [0.5, 0.5, 0], "material": "steel",
                  "elements": 2, "section": {{"type": "rectangle", "width": 0.3, "height": 0.05}}}},
        "bar": {{"type": "rigid", "at": [0.3, 0.25, 0], "mass": 0.001,
                 "inertia": [1e-6, 1e-6, 1e-6, 0, 0, 0]}}}},
      "joints": {{
        "a": {{"type": "fixed", "bodies": ["ground", "block"], "at": [0, 0, 0]}},
        "b": {{"type": "fixed", "bodies": ["ground", "beam"], "at": [0, 0.5, 0]}},
        "to_block": {{"type": "point-on-line", "bodies": ["bar", "block"], "at": [0.1, 0, 0],
                      "axis": [1, 0, 0]}},
        "to_beam": {{"type": "revolute", "bodies": ["bar", "beam"], "at": [0.5, 0.5, 0]}},
        "guide": {{"type": "prismatic", "bodies": ["ground", "bar"], "at": [0.3, 0.25, 0],
                   "axis": [0, 1, 0]}}}},
      "loads": {{"push": {{"type": "force", "body": "bar", "at": [0.3, 0.25, 0],
                           "direction": [0, -1, 0], "value": 1000}}}}}},
      "simulation": {{"end_time": 0.002, "step": 0.001, "initial_state": "quasi-static"}},
      "responses": {{"stress": {{"type": "stress", "body": "beam", "over_time": "max"}},
                     "of_bar": {{"type": "joint-position", "joint": "guide", "over_time": "final"}}}}}})j",
                                  has_shear));
  };
  // Springs side by side: 3EI/L³ of the beam, over (1 + 3EI/(κGAL²)) of the block.
  const double share = 0.5 * (1 + nu) / rectangle_shear_coefficient(nu);
  const double block = 0.01 * 0.001 / 0.001, of_beam = 0.3 * 0.000125 / 0.125;
  const double with = of_beam / (of_beam + block / (1.0 + share)),
               without = of_beam / (of_beam + block);
  const std::vector<Finding> found = findings_of(problem(false), check_variants);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(found[0].is_serious);
  EXPECT_THAT(found[0].responses, testing::ElementsAre("stress", "of_bar"));
  EXPECT_THAT(found[0].text, HasSubstr("\"block\" is stubby"));
  EXPECT_NEAR(told_percent(found[0].text), 100.0 * (1.0 - without / with), 0.6);
  EXPECT_TRUE(findings_of(problem(true), check_variants).empty());
}

/// A spring at the tip of a stubby cantilever, as stiff as that without shear, takes half of the
/// load, and 1/(1 + 1/(1 + s)) of it in truth.
TEST(ShearRange, OfASpringIsThatOfItsLoad) {
  const double share = 0.5 * (1 + nu) / rectangle_shear_coefficient(nu);
  const std::vector<Finding> found = findings_of(read_scene(R"({"scene": {
        "materials": {"m": {"young": 2.1e11, "poisson": 0.3, "density": 7850}},
        "bodies": {"block": {"type": "beam", "from": [0, 0, 0], "to": [0.1, 0, 0], "material": "m",
                   "elements": 2, "section": {"type": "rectangle", "width": 0.01, "height": 0.1}}},
        "joints": {"a": {"type": "fixed", "bodies": ["ground", "block"], "at": [0, 0, 0]}},
        "loads": {"push": {"type": "force", "body": "block", "at": [0.1, 0, 0],
                           "direction": [0, -1, 0], "value": 1000},
                  "spring": {"type": "spring", "bodies": ["block", "ground"],
                             "at": [[0.1, 0, 0], [0.1, -5, 0]], "stiffness": 5.25e8}}},
      "simulation": {"end_time": 0.002, "step": 0.001, "initial_state": "quasi-static"},
      "responses": {"force": {"type": "spring-force", "load": "spring", "over_time": "min"}}})"),
                                                 check_variants);
  ASSERT_EQ(found.size(), 1u);
  const double with = (1.0 + share) / (2.0 + share);
  EXPECT_NEAR(told_percent(found[0].text), 100.0 * (1.0 - 0.5 / with), 0.6);
}

/// A cantilever at a height of 0.5 m that a slender one, which has nothing to do with it, out-bends
/// by far: its position is as wrong as how far it sags, 3EI/(κGAL²), and so is the difference to
/// where it is drawn.
TEST(ShearRange, OfAPositionIsThatOfItsOwnMotion) {
  const std::vector<Finding> found = findings_of(read_scene(R"({"scene": {"gravity": [0, 0, 0],
        "materials": {"m": {"young": 2.1e11, "poisson": 0.3, "density": 7850}},
        "bodies": {"block": {"type": "beam", "from": [0, 0.5, 0], "to": [0.1, 0.5, 0], "material": "m",
                   "elements": 2, "section": {"type": "rectangle", "width": 0.01, "height": 0.05}},
                   "reed": {"type": "beam", "from": [1, 0, 0], "to": [2, 0, 0], "material": "m",
                   "elements": 2, "section": {"type": "rectangle", "width": 0.01, "height": 0.01}}},
        "joints": {"a": {"type": "fixed", "bodies": ["ground", "block"], "at": [0, 0.5, 0]},
                   "b": {"type": "fixed", "bodies": ["ground", "reed"], "at": [1, 0, 0]}},
        "loads": {"push": {"type": "force", "body": "block", "at": [0.1, 0.5, 0],
                           "direction": [0, -1, 0], "value": 50000},
                  "bend": {"type": "force", "body": "reed", "at": [2, 0, 0],
                           "direction": [0, -1, 0], "value": 10}}},
      "simulation": {"end_time": 0.002, "step": 0.001, "initial_state": "quasi-static"},
      "responses": {
        "y": {"type": "position", "body": "block", "at": 1, "direction": "y", "over_time": "min"},
        "sag": {"type": "expression", "value": "0.5 m - y"},
        "of_reed": {"type": "position", "body": "reed", "at": 1, "direction": "y",
                    "over_time": "min"}}})"),
                                                 check_variants);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_THAT(found[0].responses, testing::ElementsAre("y", "sag"));
  const double share = 0.5 * (1 + nu) / rectangle_shear_coefficient(nu) * 0.25;
  EXPECT_NEAR(told_percent(found[0].text), 100.0 * share / (1.0 + share), 0.6);
}

/// The damage of one period is small beside 1, and beside nothing else: m powers of the stress. The
/// stress that a spring beside a stubby block leaves to it is 1/(2 + s) of the load, not a half.
TEST(ShearRange, OfASmallDamageIsThatOfTheDamage) {
  const auto damage = [](const std::string& shear) {
    return read_scene(R"({"scene": {"gravity": [0, 0, 0],
        "materials": {"m": {"young": 2.1e11, "poisson": 0.3, "density": 7850,
                            "ultimate_strength": 1e9, "fatigue_strength": 1e9,
                            "fatigue_exponent": 5}},
        "bodies": {"block": {"type": "beam", "from": [0, 0, 0], "to": [0.1, 0, 0], "material": "m",
                   "elements": 2, "section": {"type": "rectangle", "width": 0.01, "height": 0.1}, )" +
                      shear + R"(}},
        "joints": {"a": {"type": "fixed", "bodies": ["ground", "block"], "at": [0, 0, 0]}},
        "loads": {"push": {"type": "force", "body": "block", "at": [0.1, 0, 0],
                           "direction": [0, -1, 0],
                           "value": {"type": "harmonic", "amplitude": 10000, "frequency": 1}},
                  "spring": {"type": "spring", "bodies": ["block", "ground"],
                             "at": [[0.1, 0, 0], [0.1, -5, 0]], "stiffness": 5.25e8}}},
      "simulation": {"end_time": 1, "step": 0.05, "initial_state": "quasi-static"},
      "responses": {"damage": {"type": "fatigue-damage", "body": "block",
                                "criterion": "goodman"}}})");
  };
  const ProblemFile problem = damage(R"("shear": false)");
  const double without = values_of(*analyze(problem, start_design(problem)))(0);
  const ProblemFile other = damage(R"("shear": true)");
  const double with = values_of(*analyze(other, start_design(other)))(0);
  ASSERT_GT(with, 0.0);
  ASSERT_LT(with, 1e-3);
  const std::vector<Finding> found = findings_of(problem, check_variants);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(told_percent(found[0].text), 100.0 * std::abs(without / with - 1.0),
              0.06 * 100.0 * std::abs(without / with - 1.0));
}

}  // namespace
}  // namespace pleuel::test::shear_beside_others_test
