#include <gtest/gtest.h>

#include "tests/scene/good_problem.hpp"

namespace pleuel::test::binding_test {
namespace {

const BeamBody& beam(const ProblemFile& problem, std::size_t body) {
  return std::get<BeamBody>(problem.scene.bodies[body].shape);
}

TEST(Binding, RefersToTheVariableByItsPlaceInTheFile) {
  const ProblemFile problem = read(good_json());
  const auto& crank = std::get<RectangleSection>(beam(problem, 0).segments[0].section);
  const auto& rod = std::get<TubeSection>(beam(problem, 1).segments[0].section);
  EXPECT_EQ(problem.variables[0].name, "width");
  EXPECT_EQ(problem.variables[1].name, "diameter");
  EXPECT_EQ(crank.width.variable, 0);
  EXPECT_EQ(rod.outer_diameter.variable, 1);
  EXPECT_EQ(std::get<PointMass>(problem.scene.bodies[2].shape).mass.variable, 2);
}

TEST(Binding, HasTheFactorOneUnlessItIsGiven) {
  const ProblemFile problem = read(good_json());
  const auto& crank = std::get<RectangleSection>(beam(problem, 0).segments[0].section);
  EXPECT_EQ(crank.width.factor, 1.0);
  EXPECT_EQ(crank.height.factor, 2.0);
  EXPECT_EQ(resolve(crank.height, Design<double>{0.02, 0.0, 0.0}), 0.04);
}

TEST(Binding, LeavesOtherNumbersFixed) {
  const ProblemFile problem = read(good_json());
  const auto& rod = std::get<TubeSection>(beam(problem, 1).segments[0].section);
  EXPECT_FALSE(rod.thickness.is_bound());
  EXPECT_EQ(rod.thickness.constant, 0.002);
}

TEST(Variable, IsInSiAndRemembersItsUnit) {
  const ProblemFile problem = read(good_json());
  const DesignVariable& width = problem.variables[0];
  EXPECT_EQ(width.start, 0.02);
  EXPECT_EQ(width.lower, 0.004);
  EXPECT_EQ(width.upper, 0.06);
  EXPECT_EQ(width.unit, "mm");
  EXPECT_EQ(problem.variables[1].unit, "mm");  // the start is a plain number, the upper bound not
  EXPECT_EQ(problem.variables[2].upper, 1.0);
}

TEST(Variable, WithoutUnitIsPlain) {
  Json document = edited("/variables/load", R"({"start": 0.3, "lower": 0.1, "upper": 1})");
  EXPECT_EQ(read(document).variables[2].unit, "");
}

TEST(Variable, OfALinearConstraintAloneMeasuresWhatTheOthersDo) {
  Json document = edited("/variables/slack", R"({"start": "1 mm", "lower": 0, "upper": "2 mm"})");
  document["constraints"]["slender"]["linear"]["slack"] = 1;
  EXPECT_EQ(read(document).variables[3].start, 0.001);
  document["variables"]["slack"]["start"] = "1 kg";
  EXPECT_EQ(complaint(document),
            "bad.json: /variables/slack/start must be a length [m], got \"1 kg\": \"kg\" measures "
            "something else");
}

TEST(Variable, MayMoveAJointWithTheEndsOfItsBeams) {
  Json document =
      edited("/variables/length", R"({"start": "120 mm", "lower": "100 mm", "upper": "140 mm"})");
  const Json bound = Json::parse(R"([{"variable": "length"}, 0, 0])");
  document["scene"]["bodies"]["crank"]["to"] = bound;
  document["scene"]["bodies"]["rod"]["from"] = bound;
  document["scene"]["joints"]["pin"]["at"] = bound;
  EXPECT_EQ(complaint(document), "");
  document["scene"]["joints"]["pin"]["at"] = Json::parse("[0.12, 0, 0]");
  EXPECT_EQ(complaint(document),
            "bad.json: /scene/joints/pin/at must stay at the share 1 of the length of the beam "
            "\"crank\", which is (0.1, 0, 0) [m], got (0.12, 0, 0), with the variable \"length\" "
            "at its lower "
            "bound");
}

TEST(Joint, MayBeAnywhereAlongABeam) {  // the rod goes from 0.12 m to 0.3 m
  for (const char* x : {"0.12", "0.1425", "0.15", "0.2999"}) {
    Json document = edited("/scene/joints/end/at/0", x);
    document["scene"]["joints"]["guide"]["at"][0] = Json::parse(x);
    document["scene"]["bodies"]["slider"]["at"][0] = Json::parse(x);
    EXPECT_EQ(complaint(document), "") << x;
  }
}

TEST(LinearConstraint, HasItsTermsInOrderAndLimitsInSi) {
  const ProblemFile problem = read(good_json());
  const ConstraintSettings& slender = problem.constraints[3];
  EXPECT_EQ(slender.response, "");
  const std::vector<std::pair<int, double>> expected = {{1, 1.0}, {0, -2.0}};
  EXPECT_EQ(slender.linear, expected);
  EXPECT_EQ(slender.upper, 0.001);
  EXPECT_FALSE(slender.lower.has_value());
}

TEST(Fractions, AreRoundedNumbersThatSumToOneExactly) {
  Json document = edited("/scene/bodies/rod/segments/0/length_fraction", "0.3333333");
  document["scene"]["bodies"]["rod"]["segments"][1]["length_fraction"] = 0.6666666;
  const ProblemFile problem = read(document);
  const std::vector<Segment>& segments = beam(problem, 1).segments;
  EXPECT_DOUBLE_EQ(*segments[0].fraction + *segments[1].fraction, 1.0);
  EXPECT_NEAR(*segments[0].fraction, 1.0 / 3.0, 1e-7);
}

}  // namespace
}  // namespace pleuel::test::binding_test
