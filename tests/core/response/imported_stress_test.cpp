#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "core/base/eager_matrices.hpp"
#include "tests/core/response/exchange.hpp"

/// Groups of points of stress, and fatigue at them.
namespace pleuel::test::imported_stress_test {
namespace {

using testing::HasSubstr;

constexpr const char* responses = R"({
  "mass": {"type": "mass"},
  "first": {"type": "stress", "body": "rod", "segment": 0, "over_time": "max"},
  "second": {"type": "stress", "body": "rod", "segment": 1, "part": "normal", "over_time": "min"},
  "use": {"type": "stress", "body": "rod", "segment": 1, "part": "utilization", "over_time": "rms"},
  "life": {"type": "fatigue", "body": "rod", "criterion": "gerber"},
  "life of second": {"type": "fatigue", "body": "rod", "segment": 1, "criterion": "goodman"},
  "life to yield": {"type": "fatigue", "body": "rod", "criterion": "soderberg"},
  "damage": {"type": "fatigue-damage", "body": "rod", "segment": 0, "criterion": "goodman"}
})";

/// The rod in two segments of a material that tires, whose endurance is a variable.
Json tiring_slider_crank() {
  Json document = slider_crank();
  Json& rod = document["scene"]["bodies"]["rod"];
  Json thin = rod["section"];
  thin["height"] = "26 mm";
  rod["segments"] = {{{"section", rod["section"]}, {"elements", 3}},
                     {{"section", thin}, {"elements", 3}}};
  rod.erase("section");
  rod.erase("elements");
  document["scene"]["materials"]["steel"].update({{"ultimate_strength", "600 MPa"},
                                                  {"endurance_limit", {{"variable", "endurance"}}},
                                                  {"fatigue_strength", "900 MPa"},
                                                  {"fatigue_exponent", 6}});
  document["variables"]["endurance"] = {
      {"start", "250 MPa"}, {"lower", "100 MPa"}, {"upper", "300 MPa"}};
  document["responses"] = Json::parse(responses);
  return document;
}

class TiringRod : public Exchange, public testing::WithParamInterface<const char*> {};

/// As imported_body_test: round-off, which the damage takes to the sixth power. In space stress of the rod
/// is that of bending in one plane, so that its sections are the critical planes, too.
TEST_P(TiringRod, IsThatOfTheBeam) {
  Json document = tiring_slider_crank();
  document.merge_patch(Json::parse(GetParam()));
  const ProblemFile original = read("original.json", document);
  const Differences differences = compare(original, read("imported.json", exchanged(document)));
  EXPECT_LE(differences.values, 1e-10);
  EXPECT_LE(differences.direct, 4e-9);
  EXPECT_LE(differences.adjoint, 4e-9);
}

INSTANTIATE_TEST_SUITE_P(InAPlaneAndInSpace, TiringRod,
                         testing::Values(R"({})", R"({"effects": {"spatial_motion": "on"}})"));

/// Stress that a turn of the body's axes about z by an angle makes of σ_xx.
InvariantsFile turned(InvariantsFile file, double degrees) {
  const double c = std::cos(degrees * std::numbers::pi / 180.0);
  const double s = std::sin(degrees * std::numbers::pi / 180.0);
  const double parts[6] = {c * c, s * s, 0.0, c * s, 0.0, 0.0};
  StressRecovery& stress = *file.constants.stress;
  for (SparseMatrix StressRecovery::*member :
       {&StressRecovery::of_coordinates, &StressRecovery::of_accelerations,
        &StressRecovery::of_stretching}) {
    SparseMatrix& rows = stress.*member;
    SparseMatrix all(rows.rows(), rows.cols());
    for (int i = 0; i < rows.rows(); ++i) all.row(i) = parts[i % 6] * rows.row(i / 6 * 6);
    rows = all;
  }
  return file;
}

class TurnedStress : public Exchange {
 protected:
  double life(const Json& document, const InvariantsFile& file) const {
    write(write_invariants(file));
    const ProblemFile problem = read("turned.json", document);
    return values_of(*analyze(problem, start_design(problem)))(0);
  }
};

/// Planes are 15° apart: one of them meets the stress after 30°; after 37.5° two miss it by 7.5°.
TEST_F(TurnedStress, HasItsCriticalPlane) {
  Json document = tiring_slider_crank();
  document["responses"] = {{"life", document["responses"]["life to yield"]},
                           {"mass", {{"type", "mass"}}}};
  InvariantsFile file = exported(read("original.json", document), "rod");
  for (ConstantsDerivative& of : file.design) of.derivative.reset();
  file.design.clear();
  document = with_file(document, file);
  for (const char* variable : {"rod_width", "rod_height", "endurance"}) {
    document["variables"].erase(variable);
  }
  document["scene"]["materials"]["steel"].erase("endurance_limit");
  const double along = life(document, file);
  EXPECT_NEAR(life(document, turned(file, 30.0)), along, 1e-9 * along);
  const double miss = std::cos(7.5 * std::numbers::pi / 180.0);
  EXPECT_NEAR(life(document, turned(file, 37.5)), miss * miss * along, 1e-9 * along);
}

/// A group is as stressed as the most stressed of its points, which is called by its name.
TEST_F(Exchange, NamesPointsOneByOne) {
  Json document = exchanged(tiring_slider_crank());
  const InvariantsFile file = read_invariants(path());
  const StressRecovery& stress = *file.constants.stress;
  ASSERT_EQ(stress.groups.size(), 2U);
  Json wanted = {{"group", document["responses"]["first"]}};
  for (const int point : stress.groups[0].points) {
    wanted[stress.points[point]] = document["responses"]["first"];
    wanted[stress.points[point]]["at"] = stress.points[point];
  }
  wanted["mass"] = {{"type", "mass"}};
  document["responses"] = wanted;
  const ProblemFile problem = read("points.json", document);
  const Eigen::VectorXd values = values_of(*analyze(problem, start_design(problem)));
  EXPECT_EQ(values(0), values.segment(1, values.size() - 2).maxCoeff());
}

TEST_F(Exchange, SaysWhichPointsThereAre) {
  const Json document = exchanged(tiring_slider_crank());
  Json edited = document;
  edited["responses"]["life of second"]["at"] = "segment 2";
  EXPECT_THAT(complaint(edited),
              HasSubstr("/responses/life of second/at names the unknown point or group of points "
                        "\"segment 2\"; did you mean \"segment "));
  edited = document;
  edited["responses"]["first"]["segment"] = 1;
  EXPECT_THAT(complaint(edited), HasSubstr("/responses/first/segment is for beams only"));
  InvariantsFile file = read_invariants(path());
  file.constants.stress->strengths.fatigue_exponent = 0.0;
  write(write_invariants(file));
  EXPECT_THAT(complaint(document),
              HasSubstr("/responses/damage/criterion needs the \"fatigue_exponent\" of the file"));
}

TEST_F(Exchange, SaysWhatIsWrongWithAGroup) {
  const Json document = exchanged(tiring_slider_crank());
  const Json good = Json::parse(text());
  const std::string point = good["stress"]["points"][0];
  for (const auto& [groups, expected] :
       {std::pair(Json({{"shank", {"node 99"}}}), "/stress/groups/shank/0 names the unknown point"),
        std::pair(Json({{"shank", Json::array()}}), "must name at least one point"),
        std::pair(Json({{point, {point}}}), "has the name of a point")}) {
    Json edited = good;
    edited["stress"]["groups"] = groups;
    write(edited.dump());
    EXPECT_THAT(complaint(document), HasSubstr(expected));
  }
}

}  // namespace
}  // namespace pleuel::test::imported_stress_test
