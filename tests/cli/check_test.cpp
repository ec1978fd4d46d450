#include <gmock/gmock.h>

#include "tests/cli/program.hpp"

namespace pleuel::test::check_test {
namespace {

TEST(Check, FindsTheDerivativesOfEveryResponseRight) {
  const TemporaryFolder folder;
  const ProgramRun run = run_program(
      folder.path(), joined({"check", problem("slider_crank_round"), "--json"}, quick()));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const nlohmann::json document = run.document();
  ASSERT_EQ(document.at("responses").size(), 8u);  // those of the file
  for (const auto& [name, response] : document.at("responses").items()) {
    const auto& derivatives = response.at("derivatives");
    EXPECT_EQ(derivatives.at("verdict"), "agrees") << name;
    EXPECT_LT(derivatives.at("adjoint_error"), 1e-10) << name;  // both exact: round-off
    ASSERT_EQ(derivatives.at("directions").size(), 1u);
    EXPECT_LE(derivatives.at("directions").at(0).at("error"), 1e-6) << name;
    EXPECT_GE(derivatives.at("directions").at(0).at("curve").size(), 4u);
  }
  EXPECT_EQ(document.at("directions").at(0).size(), 2u);           // both variables together
  for (const nlohmann::json& warning : document.at("warnings")) {  // of the model alone
    EXPECT_THAT(warning.get<std::string>(), ::testing::HasSubstr("stubby: shear"));
  }
}

TEST(Check, WarnsOfNoiseAboveTheTolerance) {
  const TemporaryFolder folder;
  const std::vector<std::string> strict =
      joined(joined({"check", problem("slider_crank_round")}, quick()),
             {"--set", "/optimizer/tolerance=1e-13"});
  EXPECT_THAT(run_program(folder.path(), strict).out,
              ::testing::HasSubstr("Set /optimizer/tolerance to"));
  const ProgramRun run = run_program(folder.path(), joined(strict, {"--json", "--jobs", "2"}));
  EXPECT_THAT(run.document().at("warnings").dump(),
              ::testing::HasSubstr("Set /optimizer/tolerance to"));
}

TEST(Check, NamesTheToleranceWhereDerivativesOnlySeemWrong) {
  const TemporaryFolder folder;
  const ProgramRun run = run_program(
      folder.path(), {"check", problem("four_bar"), "--set", "/simulation/step=1 ms", "--set",
                      "/simulation/end_time=30 ms", "--set", "/simulation/newton_tolerance=1e-3"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, ::testing::Not(::testing::HasSubstr("DIFFERS")));
  EXPECT_THAT(run.out, ::testing::HasSubstr("/simulation/newton_tolerance is 0.001"));
}

TEST(Check, CountsTheFreedomsThatAreLeft) {
  const TemporaryFolder folder;
  const auto rigid_motion = [&](const std::string& name) {
    return run_program(folder.path(),
                       {"check", problem(name), "--json", "--set", "/simulation/end_time=4 ms"})
        .document()
        .at("rigid_motion");
  };
  EXPECT_EQ(rigid_motion("hard/dead_centres").at("free"), 1);
  const auto driven = rigid_motion("hard/impossible_designs");
  EXPECT_EQ(driven.at("free"), 0);
  EXPECT_EQ(driven.at("drives"), 1);
}

TEST(Check, GivesAReasonForEveryEffect) {
  const TemporaryFolder folder;
  const ProgramRun run = run_program(
      folder.path(), joined({"check", problem("slider_crank_round"), "--json"}, quick()));
  const nlohmann::json document = run.document();
  const auto effect_of = [&](const std::string& name, const std::string& body) {
    for (const auto& effect : document.at("effects")) {
      if (effect.at("name") == name && effect.value("body", "") == body) return effect;
    }
    return nlohmann::json{{"built", "missing"}, {"decision", ""}, {"reason", name}};
  };
  struct Expected {
    const char *name, *body;
    bool is_built;
    const char *decision, *reason;
  };
  // The file: all in the plane z = 0, stiffening "on", damping given, no gravity, no loads, no
  // tolerance.
  for (const Expected& expected :
       {Expected{"geometric_stiffening", "rod", true, "forced", "asked for"},
        Expected{"elasticity", "crank", true, "exact", "no tolerance"},
        Expected{"torsional_elasticity", "rod", false, "exact", "in a plane"},
        Expected{"damping", "", true, "exact", "given"},
        Expected{"gravity", "", false, "exact", "none is given"},
        Expected{"loads", "", false, "exact", "none are given"},
        Expected{"spatial_motion", "", false, "exact", "plane with normal (0, 0, 1)"}}) {
    const nlohmann::json effect = effect_of(expected.name, expected.body);
    EXPECT_EQ(effect.at("built"), expected.is_built) << effect;
    EXPECT_EQ(effect.at("decision"), expected.decision) << effect;
    EXPECT_THAT(effect.at("reason").get<std::string>(), ::testing::HasSubstr(expected.reason));
  }
}

TEST(Check, WarnsOfAnUnstableScheme) {
  const TemporaryFolder folder;
  const std::vector<std::string> check = {"check", problem("slider_crank_exudyn"),
                                          "--set", "/simulation/end_time=10 ms",
                                          "--set", "/simulation/spectral_radius=1"};
  EXPECT_THAT(run_program(folder.path(), check).err, ::testing::HasSubstr("unstable"));
  const ProgramRun stabilized = run_program(
      folder.path(), joined(check, {"--set", "/simulation/formulation=stabilized-index-2"}));
  EXPECT_EQ(stabilized.exit_code, 0) << stabilized.err;
  EXPECT_THAT(stabilized.err, ::testing::Not(::testing::HasSubstr("unstable")));
}

TEST(Check, NeedsNoVariables) {
  const TemporaryFolder folder;
  const ProgramRun run = run_program(folder.path(), {"check", problem("slider_crank_exudyn"),
                                                     "--set", "/simulation/end_time=10 ms"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, ::testing::HasSubstr("a valid problem"));
}

}  // namespace
}  // namespace pleuel::test::check_test
