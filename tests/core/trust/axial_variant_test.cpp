#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/core/trust/findings_of.hpp"

/// Stress that the file leaves out with axial elasticity.
namespace pleuel::test::axial_variant_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A clamped bar of 20 mm × 20 mm, drawn by 4 kN and bent by a force across its end.
ProblemFile bar(double across, const std::string& axial) {
  return read_scene(fmt::format(
      R"j({{"scene": {{"gravity": [0, 0, 0],
        "materials": {{"m": {{"young": 2.1e11, "poisson": 0.3, "density": 7850}}}},
        "bodies": {{"bar": {{"type": "beam", "from": [0, 0, 0], "to": [0.5, 0, 0], "elements": 4,
                            "material": "m",
                            "section": {{"type": "rectangle", "width": 0.02, "height": 0.02}}}}}},
        "joints": {{"wall": {{"type": "fixed", "bodies": ["ground", "bar"], "at": [0, 0, 0]}}}},
        "loads": {{"pull": {{"type": "force", "body": "bar", "at": [0.5, 0, 0],
                            "direction": [1, 0, 0], "value": 4000}},
                  "across": {{"type": "force", "body": "bar", "at": [0.5, 0, 0],
                              "direction": [0, -1, 0], "value": {}}}}}}},
      "effects": {{"axial_elasticity": "{}", "geometric_stiffening": "off"}},
      "simulation": {{"end_time": 0.01, "step": 0.005, "initial_state": "quasi-static"}},
      "responses": {{"s": {{"type": "stress", "body": "bar", "over_time": "max"}}}}}})j",
      across, axial));
}

/// N/A = 10 MPa beside the bending stress F L/W = 3.75 MPa for 10 N.
TEST(AxialElasticity, IsMissedWhereStressComesFromIt) {
  const StartRun run(bar(10.0, "off"));
  EXPECT_NEAR(run.analysis->reductions[0].value, 3.75e6, 1e-3 * 3.75e6);
  const LeftOut found = compare_variants(run.run());
  ASSERT_EQ(found.changes.size(), 1u);
  EXPECT_EQ(found.changes[0].name, "axial_elasticity");
  EXPECT_NEAR(found.changes[0].change(0), 10e6, 1e-3 * 10e6);
  ASSERT_EQ(found.findings.size(), 1u);
  EXPECT_TRUE(found.findings[0].is_serious);
  EXPECT_THAT(found.findings[0].responses, ElementsAre("s"));
  EXPECT_THAT(found.findings[0].text, HasSubstr("would change \"s\" by 73 %"));
}

TEST(AxialElasticity, IsNotMissedWhereItIsThere) {
  EXPECT_THAT(findings_of(bar(10.0, "on"), check_variants), IsEmpty());
}

}  // namespace
}  // namespace pleuel::test::axial_variant_test
