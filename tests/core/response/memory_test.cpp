#include <gmock/gmock.h>

#include "core/base/error.hpp"
#include "core/base/machine_memory.hpp"
#include "core/response/analysis.hpp"
#include "core/scene/problem_reader.hpp"

namespace pleuel::test::memory_test {
namespace {

constexpr const char* pendulum = R"({"scene": {"gravity": [0, -9.81, 0],
    "materials": {"m": {"young": 210e9, "poisson": 0.3, "density": 7850}},
    "bodies": {"b": {"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "m",
      "section": {"type": "rectangle", "width": 0.02, "height": 0.02}, "elements": 1000}},
    "joints": {"j": {"type": "revolute", "bodies": ["ground", "b"], "at": [0, 0, 0]}}},
  "simulation": {"end_time": 1, "step": 1e-9},
  "responses": {"s": {"type": "stress", "body": "b", "over_time": "max"}}})";

TEST(Memory, ByDefaultFollowsTheMachineUpToFourGigabytes) {
  EXPECT_GT(machine_memory(), 1e7);
  const double states = read_problem_text(pendulum, "p.json").complete().sensitivity.memory;
  EXPECT_LE(states, 4e9);
  EXPECT_LE(states, 0.25 * machine_memory());
  const std::vector<std::string> given = {R"(/sensitivity={"memory": "1 MB"})"};
  EXPECT_EQ(read_problem_text(pendulum, "p.json", given).complete().sensitivity.memory, 1e6);
}

/// 1e9 steps with the stress of thousands of places are some 1e13 bytes.
TEST(Memory, OfHistoriesThatNoMachineHoldsIsTooMuchBeforeTheRun) {
  const ProblemFile problem = read_problem_text(pendulum, "p.json").complete();
  try {
    require_memory(problem);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("1e+09 steps with"));
    EXPECT_THAT(error.what(), testing::HasSubstr("but the machine has"));
  }
  EXPECT_THROW(analyze(problem, start_design(problem)), InputError);
}

}  // namespace
}  // namespace pleuel::test::memory_test
