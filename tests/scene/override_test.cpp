#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "core/scene/problem_reader.hpp"
#include "tests/scene/good_problem.hpp"

namespace pleuel::test::override_test {
namespace {

ProblemFile read_with(const std::vector<std::string>& overrides) {
  return read_problem_text(good_text(), "good.json", overrides).complete();
}

std::string complaint_with(const std::string& assignment) {
  try {
    read_with({assignment});
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Override, ReplacesAValue) {
  EXPECT_EQ(read_with({"/simulation/step=2e-4"}).simulation.step, 2e-4);
}

TEST(Override, TakesATextWithUnitWithoutQuotes) {
  EXPECT_DOUBLE_EQ(read_with({"/simulation/step=0.2 ms"}).simulation.step, 2e-4);
  EXPECT_DOUBLE_EQ(read_with({"/simulation/step=\"0.2 ms\""}).simulation.step, 2e-4);
}

TEST(Override, TakesTheStartOfAVariableByItsName) {
  const ProblemFile problem = read_with({"width=21 mm"});
  EXPECT_EQ(problem.variables.front().name, "width");
  EXPECT_DOUBLE_EQ(problem.variables.front().start, 0.021);
  EXPECT_DOUBLE_EQ(read_with({"width = 22 mm"}).variables.front().start, 0.022);
  EXPECT_DOUBLE_EQ(read_with({"/simulation/step = 0.2 ms"}).simulation.step, 2e-4);
  EXPECT_EQ(complaint_with("widht=21 mm"),
            "good.json: --set widht=21 mm: must begin with a JSON pointer such as "
            "/simulation/step, or with the name of a design variable; did you mean \"width\"?");
}

TEST(Override, TakesAWholeObject) {
  const ProblemFile problem =
      read_with({R"(/scene/bodies/slider/mass={"variable": "load", "factor": 3})"});
  EXPECT_EQ(std::get<PointMass>(problem.scene.bodies[2].shape).mass.factor, 3.0);
}

TEST(Override, ReachesIntoAList) {
  const ProblemFile problem = read_with({"/scene/bodies/rod/segments/1/elements=7"});
  EXPECT_EQ(std::get<BeamBody>(problem.scene.bodies[1].shape).segments[1].elements, 7);
}

TEST(Override, AddsAKeyToAnObjectThatIsThere) {
  EXPECT_EQ(read_with({"/responses/stress/from=0.02"}).responses[1].from, 0.02);
}

TEST(Override, BeginsABlockThatTheFileLeavesOut) {
  EXPECT_EQ(read_with({"/sensitivity/method=adjoint"}).sensitivity.method, GradientMethod::adjoint);
  EXPECT_EQ(complaint_with("/sensitivity/metod=adjoint"),
            "good.json: /sensitivity has the unknown key \"metod\"; did you mean \"method\"?");
}

TEST(Override, BeginsABlockOfTheSceneThatTheFileLeavesOut) {
  ASSERT_TRUE(read_with({}).scene.loads.empty());
  const ProblemFile problem =
      read_with({R"(/scene/loads/push={"type": "force", "body": "slider", "at": [0.3, 0, 0],
           "direction": [1, 0, 0], "value": "1 N"})"});
  EXPECT_EQ(problem.scene.loads.size(), 1u);
}

TEST(Override, IsAppliedInOrder) {
  EXPECT_EQ(read_with({"/optimizer/backend=a", "/optimizer/backend=b=c"}).optimizer.backend, "b=c");
}

TEST(Override, ReachesKeysWithSlashesAndTildes) {
  Json document = good_json();
  document["responses"]["a/b~c"] = document["responses"]["stress"];
  const ProblemFile problem =
      read_problem_text(document.dump(), "good.json", {"/responses/a~1b~0c/over_time=rms"})
          .complete();
  EXPECT_EQ(problem.responses.back().over_time, OverTime::rms);
}

TEST(Override, IsCheckedLikeTheFile) {
  EXPECT_EQ(complaint_with("/simulation/step=-1"),
            "good.json: /simulation/step must be positive [s], got -1");
  EXPECT_EQ(complaint_with("/simulation/stepp=1"),
            "good.json: /simulation has the unknown key \"stepp\"; did you mean \"step\"?");
  EXPECT_EQ(complaint_with("/simulation/step=1e400"),
            "good.json: /simulation/step must be a time [s], got \"1e400\": it is out of the range "
            "of numbers");
}

TEST(BadOverride, SaysWhatIsWrongWithIt) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", ": has no \"=\"; write /json/pointer=value"},
      {"/simulation/step", "/simulation/step: has no \"=\"; write /json/pointer=value"},
      {"=3", "=3: must begin with a JSON pointer such as /simulation/step"},
      {"simulation/step=1",
       "simulation/step=1: must begin with a JSON pointer such as "
       "/simulation/step"},
      {"/a~2=1", "/a~2=1: has a \"~\" that is neither ~0 (~) nor ~1 (/)"},
      {"/a~=1", "/a~=1: has a \"~\" that is neither ~0 (~) nor ~1 (/)"},
      {"/simulaton/step=1",
       "/simulaton/step=1: the problem has no key \"simulaton\"; did you mean "
       "\"simulation\"?"},
      {"/scene/bodies/shaft/elements=1",
       "/scene/bodies/shaft/elements=1: /scene/bodies has no key \"shaft\"; known are \"crank\", "
       "\"rod\", \"slider\" and \"wheel\""},
      {"/simulation/step/unit=1", "/simulation/step/unit=1: /simulation/step has no members"},
      {"/accuracy/elements/2=1",
       "/accuracy/elements/2=1: /accuracy/elements is a list of 2 values, "
       "counted from 0, and has no \"2\""},
      {"/accuracy/elements/-=1",
       "/accuracy/elements/-=1: /accuracy/elements is a list of 2 "
       "values, counted from 0, and has no \"-\""},
      {"/accuracy/elements/-1=1",
       "/accuracy/elements/-1=1: /accuracy/elements is a list of 2 "
       "values, counted from 0, and has no \"-1\""}};
  for (const auto& [assignment, message] : cases) {
    EXPECT_EQ(complaint_with(assignment), "good.json: --set " + message);
  }
}

}  // namespace
}  // namespace pleuel::test::override_test
