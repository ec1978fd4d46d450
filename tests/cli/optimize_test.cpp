#include <gmock/gmock.h>

#include "tests/cli/program.hpp"

namespace pleuel::test {
namespace {

using ::testing::HasSubstr;

std::vector<std::string> quick_optimization(const std::vector<std::string>& more) {
  return joined(joined({"optimize", problem("slider_crank_round")}, quick()), more);
}

TEST(Optimize, GivesADocumentWithTheDocumentedKeys) {
  const TemporaryFolder folder;
  const ProgramRun run = run_program(folder.path(), quick_optimization({"--json"}));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const nlohmann::json document = run.document();
  for (const char* key :
       {"status", "message", "backend", "objective", "variables", "constraints", "kkt_residual",
        "max_violation", "evaluations", "gradient_evaluations", "iterations", "seconds"}) {
    EXPECT_TRUE(document.contains(key)) << key;
  }
  EXPECT_EQ(document.at("status"), "verified");
  EXPECT_EQ(document.at("objective").at("unit"), "kg");
  EXPECT_LT(document.at("objective").at("value"), document.at("objective").at("start"));
  for (const auto& [name, constraint] : document.at("constraints").items()) {
    // The limits hold to the tolerance of the verdict.
    EXPECT_LE(constraint.at("value"), constraint.at("limit").get<double>() * (1 + 1e-4)) << name;
    EXPECT_TRUE(constraint.contains("multiplier")) << name;
  }
  for (const auto& [name, variable] : document.at("variables").items()) {
    EXPECT_EQ(variable.at("unit"), "m") << name;
    EXPECT_GE(variable.at("value"), variable.at("lower")) << name;
    EXPECT_LE(variable.at("value"), variable.at("upper")) << name;
  }
}

/// Whatever makes the gradients, the optimum is the same: within the tolerance of the optimizer.
TEST(Optimize, MayUseAnyGradients) {
  const TemporaryFolder folder;
  const auto optimum = [&](const std::vector<std::string>& more) {
    const ProgramRun run = run_program(folder.path(), quick_optimization(joined({"--json"}, more)));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return run.document();
  };
  const nlohmann::json chosen = optimum({});
  EXPECT_EQ(chosen.at("gradients").at("method"), "direct");
  for (const std::string method : {"adjoint", "central-difference"}) {
    const nlohmann::json document = optimum({"--method", method});
    EXPECT_EQ(document.at("gradients").at("method"), method);
    EXPECT_EQ(document.at("gradients").at("reason"), "asked for");
    const double expected = chosen.at("objective").at("value");
    EXPECT_NEAR(document.at("objective").at("value"), expected, 1e-5 * expected) << method;
  }
  EXPECT_EQ(
      optimum({"--set", R"(/sensitivity={"method": "adjoint"})"}).at("gradients").at("method"),
      "adjoint");
}

TEST(Optimize, ShowsIterationsAndUnitsOfTheUser) {
  const TemporaryFolder folder;
  const ProgramRun run = run_program(folder.path(), quick_optimization({}));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("iteration"));
  EXPECT_THAT(run.out, HasSubstr("VERIFIED"));
  EXPECT_THAT(run.out, HasSubstr("mm"));
}

TEST(Optimize, CannotVerifyWhatNoDesignCanKeep) {
  const TemporaryFolder folder;
  const ProgramRun run =
      run_program(folder.path(),
                  quick_optimization({"--json", "--set", "/constraints/rod_stiffness/upper=1e-12",
                                      "--set", "/optimizer/max_iterations=10"}));
  EXPECT_EQ(run.exit_code, 4) << run.err;
  EXPECT_EQ(run.document().at("status"), "infeasible");
}

TEST(Optimize, WithoutTimeToFinishItIsNotVerified) {
  const TemporaryFolder folder;
  const ProgramRun run =
      run_program(folder.path(), quick_optimization({"--set", "/optimizer/max_iterations=2"}));
  EXPECT_EQ(run.exit_code, 4) << run.err;
  EXPECT_THAT(run.out, HasSubstr("NOT VERIFIED"));
}

TEST(Optimize, AStartThatCannotBeSimulatedIsASimulationFailure) {
  const TemporaryFolder folder;
  const ProgramRun run =
      run_program(folder.path(),
                  quick_optimization({"--json", "--set", "/simulation/max_newton_iterations=1"}));
  EXPECT_EQ(run.exit_code, 3) << run.err;
  EXPECT_EQ(run.document().at("status"), "failed");
}

/// Rubber at 30 rad/s bends too far for linear elasticity, wherever one iteration leads.
TEST(Optimize, SaysWhereLinearElasticityIsLeft) {
  const TemporaryFolder folder;
  const ProgramRun run =
      run_program(folder.path(), {"optimize", problem("hard/soft_rod"), "--set",
                                  "/scene/joints/bearing/drive/speed=30", "--set",
                                  R"(/objective={"minimize": "rod_bow"})", "--set",
                                  R"(/optimizer={"max_iterations": 1})"});
  EXPECT_THAT(unwrapped(run.out), HasSubstr("too far for linear elasticity"));
  const auto result =
      nlohmann::json::parse(read_file(folder.path() / "runs/soft_rod-optimize/result.json"));
  EXPECT_GT(result.at("monitors").at("elastic_rotation"), 0.2);
  EXPECT_THAT(run_program(folder.path(), quick_optimization({})).out,
              ::testing::Not(HasSubstr("linear elasticity")));
}

TEST(Optimize, BackendOfTheCommandLineWinsOverThatOfTheFile) {
  const TemporaryFolder folder;
  const ProgramRun run =
      run_program(folder.path(), quick_optimization({"--json", "--backend", "ipopt"}));
  EXPECT_EQ(run.document().at("backend"), "ipopt");
  EXPECT_EQ(run.document().at("status"), "verified");
}

}  // namespace
}  // namespace pleuel::test
