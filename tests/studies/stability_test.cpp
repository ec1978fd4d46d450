#include "studies/stability.hpp"

#include <cmath>

#include <gmock/gmock.h>

#include "core/base/error.hpp"
#include "tests/support/source_folder.hpp"

namespace pleuel::test::stability_test {
namespace {

std::filesystem::path hard(const std::string& name) {
  return std::filesystem::path(source_folder()) / "problems/hard" / (name + ".json");
}

TEST(Stability, RunsEveryFileWithEveryFormulationAndScheme) {
  const auto runs =
      stability_study({hard("dead_centres"), hard("change_point")}, {"/simulation/end_time=50 ms"});
  std::vector<ComparedFormulation> all = compared_formulations();
  all.insert(all.end(), compared_schemes().begin(), compared_schemes().end());
  ASSERT_EQ(runs.size(), 2 * all.size());
  for (std::size_t i = 0; i < runs.size(); ++i) {
    EXPECT_EQ(runs[i].formulation, all[i % all.size()].name);
    EXPECT_TRUE(runs[i].is_ok()) << runs[i].failure;
    EXPECT_GE(runs[i].newton_iterations, runs[i].steps);
    EXPECT_LE(runs[i].position_drift, 1e-3);
    EXPECT_TRUE(std::isfinite(runs[i].energy_error));
  }
}

/// Of what is wrong with the mechanism, not of the formulation: a rod that is too short to be
/// assembled at the start of the drive.
TEST(Stability, MarksARunThatFailsAndGoesOn) {
  int seen = 0;
  const auto runs = stability_study(
      {hard("change_point"), hard("change_point")},
      {"/simulation/end_time=50 ms", "/scene/bodies/rod/to=[0.15, 0, 0]",
       "/scene/bodies/slider/at=[0.15, 0, 0]", "/scene/joints/slider_pin/at=[0.15, 0, 0]",
       "/scene/joints/guide/at=[0.15, 0, 0]",
       R"(/scene/joints/bearing/drive={"type": "polynomial", "coefficients": [1.5, 5]})"},
      [&](const StabilityRun&) { ++seen; });
  EXPECT_EQ(seen, static_cast<int>(runs.size()));
  for (const StabilityRun& run : runs) {
    EXPECT_THAT(run.failure, testing::HasSubstr("cannot be assembled"));
  }
}

TEST(Stability, RefusesABadFileBeforeAnyIsSimulated) {
  int seen = 0;
  EXPECT_THROW(stability_study({hard("dead_centres"), hard("no_such_file")}, {},
                               [&](const StabilityRun&) { ++seen; }),
               InputError);
  EXPECT_EQ(seen, 0);
}

}  // namespace
}  // namespace pleuel::test::stability_test
