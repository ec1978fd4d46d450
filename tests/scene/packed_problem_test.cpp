#include "core/scene/packed_problem.hpp"

#include <filesystem>

#include <gtest/gtest.h>

#include "core/scene/problem_reader.hpp"
#include "tests/support/source_folder.hpp"

namespace pleuel::test::packed_problem_test {
namespace {

namespace fs = std::filesystem;

/// What is unpacked is packed to the same bytes: nothing is lost or rounded. That all members of a
/// struct are named, the compiler sees.
TEST(PackedProblem, IsTheSameWhenItIsUnpacked) {
  int files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(source_folder() + "/problems")) {
    const fs::path& path = entry.path();
    if (path.extension() != ".json" || path.string().find("schema") != std::string::npos) continue;
    ProblemFile problem;
    try {
      problem = read_problem(path).complete();
    } catch (const std::exception&) {
      continue;  // a catalogue, a material
    }
    ++files;
    const std::string bytes = packed(problem);
    EXPECT_EQ(packed(unpacked<ProblemFile>(bytes)), bytes) << path;
  }
  EXPECT_GE(files, 20);
}

TEST(PackedProblem, KeepsWhatNoFileSays) {
  ProblemFile problem =
      read_problem(source_folder() + "/problems/slider_crank_round.json").complete();
  problem.effects.decisions = {};
  problem.effects.decisions.measured[{"rod", "elasticity"}] = {false, 1e-3, "rod_bow"};
  problem.simulation.checks_resolution = false;
  problem.simulation.moves_by_bending = true;
  problem.simulation.instants = {0.0, 0.1 / 3.0};
  const auto same = unpacked<ProblemFile>(packed(problem));
  const MeasuredEffect& effect = same.effects.decisions.measured.at({"rod", "elasticity"});
  EXPECT_FALSE(effect.is_needed);
  EXPECT_EQ(effect.response, "rod_bow");
  EXPECT_FALSE(same.simulation.checks_resolution);
  EXPECT_TRUE(same.simulation.moves_by_bending);
  EXPECT_EQ(same.simulation.instants, problem.simulation.instants);
  EXPECT_EQ(same.variables[0].quantity.has_value(), problem.variables[0].quantity.has_value());
}

}  // namespace
}  // namespace pleuel::test::packed_problem_test
