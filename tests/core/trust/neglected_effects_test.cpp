/// Stiffening that goes with axial elasticity, and buckling of what a tolerance makes rigid.

#include "core/trust/neglected_effects.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/response/effect_measurement.hpp"
#include "tests/core/trust/findings_of.hpp"

namespace pleuel::test::neglected_effects_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

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
  EXPECT_THAT(findings_of(problem_with(1.0), check_lost_stiffening), IsEmpty());
  // From one percent on.
  const double pi = 3.14159265358979, radius = 0.0025;
  const double euler = pi * pi * 2.1e11 * pi / 4 * std::pow(radius, 4) / (0.3 * 0.3);
  EXPECT_THAT(findings_of(problem_with(0.0098 * euler), check_lost_stiffening), IsEmpty());
  EXPECT_THAT(findings_of(problem_with(0.0102 * euler), check_lost_stiffening), SizeIs(1));
  const std::vector<Finding> findings = findings_of(problem_with(200.0), check_lost_stiffening);
  ASSERT_THAT(findings, SizeIs(1));
  EXPECT_TRUE(findings[0].is_serious);
  EXPECT_THAT(findings[0].text, HasSubstr("0.28 of its Euler load"));
}

/// A square column of 1 m × 10 mm, clamped, pressed slowly at its tip, which moves by less than 1e-3 of
/// its length: no response calls for its elasticity.
ProblemFile pressed_column(double force, const char* spatial_motion, double tolerance) {
  ProblemFile problem = read_scene(fmt::format(
      R"j({{"scene": {{
        "materials": {{"light": {{"young": 2.1e11, "poisson": 0.3, "density": 1}}}},
        "bodies": {{"bar": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "elements": 6,
                            "material": "light", "damping": {{"stiffness": 1e-4}},
                            "section": {{"type": "rectangle", "width": 0.01, "height": 0.01}}}}}},
        "joints": {{"wall": {{"type": "fixed", "bodies": ["ground", "bar"], "at": [0, 0, 0]}}}},
        "loads": {{"press": {{"type": "force", "body": "bar", "at": [1, 0, 0],
                             "direction": [-1, 0, 0],
                             "value": {{"type": "ramp", "to": {}, "end": 0.05}}}}}}}},
      "effects": {{"spatial_motion": "{}", "tolerance": {}}},
      "simulation": {{"end_time": 0.05, "step": 0.0025}},
      "responses": {{"tip": {{"type": "position", "body": "bar", "at": 1, "direction": "x",
                             "over_time": "final"}}}}}})j",
      force, spatial_motion, tolerance));
  decide_effects(problem);
  return problem;
}

/// What is said of buckling, without how far disturbances grow: what is left out is looked for at twice
/// the step, which damps them less.
std::vector<std::string> buckling_of(const std::vector<Finding>& findings) {
  std::vector<std::string> texts = texts_of(findings);
  std::erase_if(texts,
                [](const std::string& text) { return text.find("buckle") == std::string::npos; });
  for (std::string& text : texts) text.resize(std::min(text.size(), text.find(" In this motion")));
  return texts;
}

/// A cantilever buckles at π² EI/4L².
TEST(BucklingOfWhatIsLeftOut, IsThatOfTheCompleteMechanism) {
  const double critical = std::pow(std::numbers::pi / 2, 2) * 2.1e11 * 1e-8 / 12;
  for (const char* spatial_motion : {"auto", "on"}) {
    for (double share : {0.6, 1.02}) {
      const ProblemFile lean = pressed_column(share * critical, spatial_motion, 1e-2);
      const auto analysis = analyze(lean, start_design(lean));
      EXPECT_FALSE(analysis->model.bodies[0].is_elastic);
      const std::vector<std::string> told =
          buckling_of(check_run(lean, start_design(lean), *analysis));
      EXPECT_EQ(told,
                buckling_of(findings_of(pressed_column(share * critical, spatial_motion, 0.0))));
      EXPECT_EQ(told.empty(), share < 1.0) << spatial_motion << " " << share;
    }
  }
}

}  // namespace
}  // namespace pleuel::test::neglected_effects_test
