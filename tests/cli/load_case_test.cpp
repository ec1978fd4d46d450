#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/cli/program.hpp"

namespace pleuel::test {
namespace {

using ::testing::HasSubstr;

TEST(LoadCases, GoThroughSimulateOneAfterTheOther) {
  const TemporaryFolder folder;
  const ProgramRun run = run_program(folder.path(), {"simulate", problem("two_loads"), "--json"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const nlohmann::json cases = run.document().at("cases");
  ASSERT_EQ(cases.size(), 2u);
  const auto torque = [&](const char* name) {
    return cases.at(name).at("responses").at("torque").at("value").get<double>();
  };
  EXPECT_NE(torque("fast"), torque("heavy"));
  // A limit that names a case is that of this case only.
  EXPECT_FALSE(cases.at("fast").at("constraints").contains("rod_strength"));
  EXPECT_TRUE(cases.at("heavy").at("constraints").contains("rod_strength"));
}

TEST(LoadCases, AreTakenAloneByTheirNames) {
  const TemporaryFolder folder;
  const ProgramRun run = run_program(
      folder.path(), {"simulate", problem("two_loads"), "--case", "heavy", "-o", "one"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("two loads [heavy]"));
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "one" / "trajectory.csv"));
  const ProgramRun unknown =
      run_program(folder.path(), {"simulate", problem("two_loads"), "--case", "hevy"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("did you mean \"heavy\"?"));
}

TEST(LoadCases, HaveToBeNamedWhereACommandTakesOne) {
  const TemporaryFolder folder;
  for (const std::string command : {"accuracy", "stability", "uncertainty", "pareto", "prices"}) {
    const ProgramRun run = run_program(folder.path(), {command, problem("two_loads")});
    EXPECT_EQ(run.exit_code, 2) << command;
    EXPECT_THAT(unwrapped(run.err), HasSubstr("--case")) << command;
  }
}

TEST(LoadCases, SayWhichOfThemDecidesALimit) {
  const TemporaryFolder folder;
  const ProgramRun run =
      run_program(folder.path(), {"optimize", problem("two_loads"), "-o", "run"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const nlohmann::json result =
      nlohmann::json::parse(read_file(folder.path() / "run" / "result.json"));
  EXPECT_EQ(result.at("constraints").at("crank_strength [heavy]").at("decides"), true);
  EXPECT_EQ(result.at("constraints").at("crank_strength [fast]").at("decides"), false);
  EXPECT_EQ(result.at("constraints").at("rod_stiffness [fast]").at("case"), "fast");
  EXPECT_EQ(result.at("cases").at("shown"), "heavy");  // its limit costs most
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "run" / "trajectory-optimum-fast.csv"));
  const ProgramRun again =
      run_program(folder.path(), {"optimize", problem("two_loads"), "-o", "run", "--resume"});
  EXPECT_THAT(again.out, HasSubstr("evaluations were known"));
  EXPECT_EQ(nlohmann::json::parse(read_file(folder.path() / "run" / "result.json")).at("variables"),
            result.at("variables"));
  const ProgramRun motion = run_program(folder.path(), {"export", "run", "--vtk"});
  EXPECT_EQ(motion.exit_code, 0) << motion.err;
  const ProgramRun drawn = run_program(folder.path(), {"plot", "run", "torque"});
  EXPECT_EQ(drawn.exit_code, 0) << drawn.err;
}

}  // namespace
}  // namespace pleuel::test
