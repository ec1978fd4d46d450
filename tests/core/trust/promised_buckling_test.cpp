#include "core/trust/sideways_buckling.hpp"
#include "tests/core/trust/findings_of.hpp"
#include "tests/support/test.hpp"

/// A hydraulic cylinder: a barrel and a rod of 0.5 m each, which slides in the barrel's end, held by a
/// drive; pins at both ends, pressed by 1 kN.
namespace pleuel::test::promised_buckling_test {
namespace {

constexpr double young = 2.1e11, length = 0.5, press = 1000.0, rod = 0.01;

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
          "eye": {{"type": "point-on-line", "bodies": ["ground", "rod"], "at": [{3}, 0, 0],
                  "axis": [1, 0, 0]}}}},
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
  const std::string column = R"j({"scene": {"gravity": [0, 0, 0],
      "bodies": {"bar": {"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "elements": 6,
        "material": "steel", "damping": {"stiffness": 1e-4}, "frame": "chord",
        "section": {"type": "rectangle", "width": 0.01, "height": 0.01}}},
      "joints": {
        "foot": {"type": "revolute", "bodies": ["ground", "bar"], "at": [0, 0, 0]},
        "eye": {"type": "point-on-line", "bodies": ["ground", "bar"], "at": [1, 0, 0],
                "axis": [1, 0, 0]}},
      "loads": {"press": {"type": "force", "body": "bar", "at": [1, 0, 0],
                          "direction": [-1, 0, 0], "value": 1500}}},
    "simulation": {"end_time": 0.01, "step": 0.005, "initial_state": "quasi-static"},
    "responses": {"own": {"type": "buckling", "body": "bar", "over_time": "max"}}})j";
  EXPECT_THAT(findings_of(read_scene(column), check_promised_buckling), IsEmpty());
}

/// Without its load this beam would move in another set of constraints: a torque in a plane on a
/// planar joint, which has no equations there.
TEST(PromisedBuckling, IsNotAskedWhereLoadsDecideWhatConstraintsThereAre) {
  const std::string sliding = R"j({"scene": {
      "bodies": {"bar": {"type": "beam", "from": [0, 0, 0], "to": [0.5, 0, 0], "elements": 4,
        "material": "steel", "section": {"type": "rectangle", "width": 0.02, "height": 0.03}}},
      "joints": {"p": {"type": "planar", "bodies": ["ground", "bar"], "at": [0, 0, 0],
                       "axis": [0, 0, 1]}},
      "loads": {"turn": {"type": "torque", "body": "bar", "at": [0.5, 0, 0],
                         "direction": [0, 0, 1],
                         "value": {"type": "ramp", "to": 100, "end": 0.005}}}},
    "simulation": {"end_time": 0.005, "step": 0.0005},
    "responses": {"own": {"type": "buckling", "body": "bar", "over_time": "max"}}})j";
  EXPECT_THAT(findings_of(read_scene(sliding), check_promised_buckling), IsEmpty());
}

}  // namespace
}  // namespace pleuel::test::promised_buckling_test
