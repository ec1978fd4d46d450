#include <cstdlib>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/response/effect_measurement.hpp"
#include "core/scene/body_constants.hpp"
#include "core/scene/visit_constants.hpp"
#include "core/trust/check_list.hpp"
#include "sensitivity/constant_gradients.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/core/response/exchange.hpp"
#include "tests/core/trust/trust_scenes.hpp"
#include "tests/support/at_start.hpp"
#include "tests/support/files.hpp"
#include "tests/support/parameter_name.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::imported_body_test {
namespace {

// Nothing changes but round-off.

class ExchangeOf : public Exchange, public testing::WithParamInterface<std::string> {};

/// Edits of the problem, one a case: planar, in space, without stiffening, reduced on a mean axis.
/// Measured 1.5e-12 for values and 6e-11 for gradients, which sum large parts; ten times that. Not
/// the frequency of the reduced one: those of a beam are without reduction, those of its file not.
TEST_P(ExchangeOf, ARodChangesNothingButRoundOff) {
  Json document = slider_crank();
  document.merge_patch(Json::parse(GetParam()));
  const ProblemFile original = read("original.json", document);
  const ProblemFile imported = read("imported.json", exchanged(document));
  const Differences differences = compare(original, imported);
  EXPECT_LE(differences.values, 2e-11);
  EXPECT_LE(differences.direct, 6e-10);
  EXPECT_LE(differences.adjoint, 6e-10);
}

INSTANTIATE_TEST_SUITE_P(
    Edits, ExchangeOf,
    testing::Values(
        R"({})", R"({"effects": {"spatial_motion": "on"}})",
        R"({"effects": {"geometric_stiffening": "off"}})",
        R"({"scene": {"bodies": {"rod": {"frame": "mean-axis", "reduction": {"modes": 3}}}}, )"
        R"("responses": {"rod_frequency": null}})"),
    named_by_value());

/// A chord between two other places against the straight line by hand: u_P − (1 − s) u_A − s u_B with
/// s = (0.4 − 0.2)/(0.8 − 0.2) = 1/3.
TEST_F(Exchange, TakesAnyTwoPlacesForAChord) {
  Json document = slider_crank();
  document["responses"] = Json::parse(R"({
    "a": {"type": "deflection", "body": "rod", "at": 0.2, "over_time": "final"},
    "b": {"type": "deflection", "body": "rod", "at": 0.8, "over_time": "final"},
    "p": {"type": "deflection", "body": "rod", "at": 0.4, "over_time": "final"},
    "mass": {"type": "mass"}})");
  const ProblemFile original = read("original.json", document);
  const InvariantsFile file = exported(original, "rod");
  write(write_invariants(file));
  document = with_file(document, file);
  document["responses"]["bow"] = {{"type", "deflection"},
                                  {"body", "rod"},
                                  {"at", place_at(file, 0.4)},
                                  {"against", "chord"},
                                  {"chord", {place_at(file, 0.2), place_at(file, 0.8)}},
                                  {"over_time", "final"}};
  const ProblemFile problem = read("imported.json", document);
  const Eigen::VectorXd x = start_design(problem);
  auto analysis = analyze(problem, x);
  const Eigen::VectorXd values = values_of(*analysis);  // a, b, p, mass, bow
  EXPECT_NEAR(values(4), values(2) - 2.0 / 3.0 * values(0) - 1.0 / 3.0 * values(1),
              1e-12 * std::abs(values(2)));
  const Eigen::MatrixXd slopes = gradients(problem, x, *analysis, GradientMethod::direct);
  const Eigen::RowVectorXd expected =
      slopes.row(2) - 2.0 / 3.0 * slopes.row(0) - 1.0 / 3.0 * slopes.row(1);
  EXPECT_LE((slopes.row(4) - expected).cwiseAbs().maxCoeff(),
            1e-9 * slopes.row(2).cwiseAbs().maxCoeff());
  document["responses"]["bow"]["chord"][1] = place_at(file, 0.2);
  EXPECT_THAT(complaint(document), HasSubstr("/responses/bow/chord must name two places that are "
                                             "apart from each other"));
  document["responses"]["bow"]["chord"][1] = "nowhere";
  EXPECT_THAT(complaint(document),
              HasSubstr("/responses/bow/chord/1 names the unknown place \"nowhere\""));
}

/// What a body changes without its stiffening. Differences of values: round-off of these.
TEST_F(Exchange, LosesWithItsStiffeningWhatTheBeamLoses) {
  Json document = slider_crank();
  document["simulation"]["end_time"] = 4e-3;
  const ProblemFile original = read("original.json", document);
  const ProblemFile imported = read("imported.json", exchanged(document));
  const auto changes = [](const ProblemFile& problem) {
    for (const EffectInfluence& one : effect_influences(problem, start_design(problem))) {
      const bool is_of_rod = std::ranges::find(one.bodies, "rod") != one.bodies.end();
      if (is_of_rod && one.effect == "geometric_stiffening") return one.changes;
    }
    return Eigen::VectorXd();
  };
  const Eigen::VectorXd values = values_of(*analyze(original, start_design(original)));
  const Eigen::VectorXd expected = changes(original), found = changes(imported);
  ASSERT_EQ(found.size(), values.size());
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    EXPECT_NEAR(found(i), expected(i), 1e-9 * std::abs(values(i))) << original.responses[i].name;
  }
  const Eigen::Index bow = 8;
  EXPECT_GT(std::abs(expected(bow)), 1e-4 * std::abs(values(bow))) << original.responses[bow].name;
}

TEST_F(Exchange, GivesEveryNumberBackExactly) {
  const InvariantsFile file = exported(read("original.json", slider_crank()), "rod");
  const std::string text = write_invariants(file);
  EXPECT_EQ(write_invariants(read_invariants_text(text, "rod.json")), text);
}

/// The stiffness of a mean-axis body does not depend on its density: what round-off leaves of its
/// derivative is symmetric, too, or reading would refuse it.
TEST_F(Exchange, WritesSymmetricDerivatives) {
  Json document = slider_crank();
  document["scene"]["materials"]["stuff"] = Json::parse(
      R"({"young": 4.3e11, "poisson": 0.25, "strength": 5e8, "density": {"variable": "rho"}})");
  document["scene"]["bodies"]["rod"]["material"] = "stuff";
  document["scene"]["bodies"]["rod"]["frame"] = "mean-axis";
  document["variables"]["rho"] = Json::parse(R"({"start": 4121, "lower": 2000, "upper": 8000})");
  const InvariantsFile file = exported(read("original.json", document), "rod");
  ASSERT_FALSE(file.design.empty());
  for (const ConstantsDerivative& derivative : file.design) {
    ASSERT_TRUE(derivative.derivative);
    const Eigen::MatrixXd stiffness = derivative.derivative->stiffness;
    EXPECT_TRUE((stiffness - stiffness.transpose()).isZero(0.0)) << derivative.variable;
  }
}

TEST_F(Exchange, PassesAnImportedBodyOn) {
  const Json document = exchanged(slider_crank());
  EXPECT_EQ(write_invariants(exported(read("imported.json", document), "rod")), text());
}

// Groups of points of stress, and fatigue at them.

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

// Imported bodies under compression: buckling, and vibration about a stressed state.

/// A steel column of 1 m, 20 mm wide and 30 mm high (weaker along z), held at one end and pressed by
/// 5 kN along its axis; E = 210 GPa.
Json column(const std::string& frame) {
  return Json::parse(fmt::format(R"({{
    "name": "column",
    "scene": {{
      "materials": {{"steel": {{"young": "210 GPa", "poisson": 0.3, "density": 7850}}}},
      "bodies": {{"rod": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "steel",
        "section": {{"type": "rectangle", "width": {{"variable": "width"}}, "height": {{"variable": "height"}}}},
        "elements": 6, "frame": "{}"}}}},
      "joints": {{"foot": {{"type": "fixed", "bodies": ["ground", "rod"], "at": [0, 0, 0]}}}},
      "loads": {{"press": {{"type": "force", "body": "rod", "at": [1, 0, 0],
                            "direction": [-1, 0, 0], "value": "5 kN"}}}}}},
    "simulation": {{"end_time": "1 ms", "step": "0.5 ms", "initial_state": "quasi-static"}},
    "effects": {{"spatial_motion": "on"}},
    "variables": {{"width": {{"start": "20 mm", "lower": "5 mm", "upper": "60 mm"}},
                   "height": {{"start": "30 mm", "lower": "5 mm", "upper": "60 mm"}}}},
    "responses": {{
      "buckling": {{"type": "buckling", "body": "rod", "over_time": "max"}},
      "slow": {{"type": "frequency", "mode": 1}},
      "next": {{"type": "frequency", "mode": 2}},
      "mass": {{"type": "mass"}}}},
    "objective": {{"minimize": "mass"}}
  }})",
                                 frame));
}

Json imported_column(const Json& document) {
  Json imported = document;
  imported["scene"]["bodies"]["rod"] = {
      {"type", "invariants"}, {"file", "rod.json"}, {"from", {0, 0, 0}}, {"to", {1, 0, 0}}};
  if (imported["responses"].contains("buckling")) {
    imported["responses"]["buckling"]["chord"] = {"foot", "press"};
  }
  return imported;
}

class ColumnFile : public Exchange {
 protected:
  Json imported(const Json& document) const {
    write(write_invariants(exported(read("original.json", document), "rod")));
    return imported_column(document);
  }
};

class Column : public ColumnFile, public testing::WithParamInterface<std::string> {};

/// Cubic shapes of six elements overestimate the load of a pinned column by (π/6)⁴/720 = 1.0e-4, and its
/// derivatives as much. The beam's is the closed form P_E = π² E I/L².
TEST_P(Column, BucklesUnderTheLoadOfTheBeam) {
  const Json document = column(GetParam());
  const ProblemFile original = read("original.json", document);
  const ProblemFile problem = read("imported.json", imported(document));
  const Eigen::VectorXd x = start_design(original);
  const auto a = analyze(original, x), b = analyze(problem, x);
  const double euler = std::numbers::pi * std::numbers::pi * 210e9 * 0.03 * std::pow(0.02, 3) / 12;
  EXPECT_NEAR(values_of(*a)(0), 5000.0 / euler, 1e-6 * 5000.0 / euler);
  const double expected = values_of(*a)(0) / (1.0 + std::pow(std::numbers::pi / 6.0, 4) / 720.0);
  EXPECT_NEAR(values_of(*b)(0), expected, 1e-5 * expected);
  for (const GradientMethod method : {GradientMethod::direct, GradientMethod::adjoint}) {
    const Eigen::RowVectorXd of_beam = gradients(original, x, *a, method).row(0);
    const Eigen::RowVectorXd found = gradients(problem, x, *b, method).row(0);
    EXPECT_LE((found - of_beam).norm(), 3e-4 * of_beam.norm());
  }
}

/// A quarter of the column's Euler load is taken from its stiffness: frequencies about that state are
/// those of the beam, and so are their derivatives. Round-off, as imported_body_test.
TEST_P(Column, VibratesUnderLoadAsTheBeam) {
  Json document = column(GetParam());
  document["responses"].erase("buckling");
  const ProblemFile original = read("original.json", document);
  const Differences differences = compare(original, read("imported.json", imported(document)));
  EXPECT_LE(differences.values, 1e-9);
  EXPECT_LE(differences.direct, 1e-7);
  // The load counts: without it the lowest frequency is another.
  document["scene"]["loads"]["press"]["value"] = 1.0;
  const ProblemFile free = read("free.json", document);
  const double loaded = values_of(*analyze(original, start_design(original)))(0);
  EXPECT_LT(loaded, 0.9 * values_of(*analyze(free, start_design(free)))(0));
}

/// P_E = π² E I/(4 L²) of a column that is held at one end. The motion itself shows nothing.
TEST_P(Column, BucklesUnderALoadThatComesLate) {
  const double euler = 0.25 * std::numbers::pi * std::numbers::pi * 210e9 * 0.03 * 8e-6 / 12.0;
  const auto findings_at = [&](double share) {
    Json document = column(GetParam());
    document["scene"]["loads"]["press"]["value"] = {
        {"type", "table"},
        {"interpolation", "monotone"},
        {"times", {0.0, 0.01, 0.02, 1.0}},
        {"values", {0.0, 0.0, share * euler, share * euler}}};
    document["simulation"] = {{"end_time", 0.15}, {"step", 5e-4}};
    document["responses"].erase("buckling");
    return findings_of(read("imported.json", imported(document)), check_stability);
  };
  EXPECT_THAT(findings_at(0.95), testing::IsEmpty());
  const Finding beyond = only(findings_at(1.3));
  EXPECT_TRUE(beyond.is_serious);
  EXPECT_THAT(beyond.text, HasSubstr("buckles"));
}

INSTANTIATE_TEST_SUITE_P(Frames, Column, testing::Values("tangent", "chord"));

/// The same force in the same column, whatever its effects are.
TEST_F(ColumnFile, CountsItsForceWithoutStiffening) {
  Json document = imported(column("tangent"));
  const ProblemFile with = read("with.json", document);
  document["effects"]["geometric_stiffening"] = "off";
  const ProblemFile without = read("without.json", document);
  const Eigen::VectorXd x = start_design(with);
  EXPECT_NEAR(values_of(*analyze(without, x))(0), values_of(*analyze(with, x))(0), 1e-6);
}

TEST_F(ColumnFile, SaysWhatItsBucklingNeeds) {
  const Json document = imported(column("tangent"));
  Json edited = document;
  edited["responses"]["buckling"].erase("chord");
  EXPECT_THAT(complaint(edited), HasSubstr("/responses/buckling is missing the key \"chord\""));
  edited["responses"]["buckling"]["chord"] = {"foot", "node 3"};
  EXPECT_THAT(complaint(edited), HasSubstr("is not that of the line from \"foot\" to \"node 3\""));
  InvariantsFile file = read_invariants(path());
  file.design.clear();
  file.constants.stretching.reset();
  file.constants.stress.reset();
  write(write_invariants(file));
  EXPECT_THAT(complaint(document),
              HasSubstr("/responses/buckling/body names a body whose file rod.json has no block "
                        "\"stiffening\""));
}

// Derivatives of a body from a file: by its design, by each of its numbers, and where it has none.

double size_of_product(double a, double b) {
  return std::abs(a * b);
}
template <class Matrix>
double size_of_product(const Matrix& a, const Matrix& b) {
  return a.cwiseProduct(b).cwiseAbs().sum();
}

/// Σ |dJ/dI · dI/dx|
double sizes_along(const BodyConstants& gradient, const BodyConstants& change) {
  double sum = 0.0;
  const auto add = [&](const ConstantsBlock&, const auto& a, const auto& b) {
    sum += size_of_product(a, b);
  };
  visit_constants(add, gradient, change);
  return sum;
}

/// Σ dJ/dI · dI/dx over all numbers of the rod is dJ/dx of the variables that only the rod has. Parts of the sum may be larger
/// than it: errors are relative to the sum of their sizes.
TEST_F(Exchange, HasGradientsByItsNumbersThatAddUpToThoseByVariables) {
  Json document = slider_crank();
  document["simulation"]["end_time"] = 2e-3;
  document["scene"]["bodies"]["rod"]["elements"] = 2;
  document["responses"].erase("crank_stress");
  const auto [problem, x, analysis] = AtStart(read("imported.json", exchanged(document)));
  const Eigen::MatrixXd expected = gradients(problem, x, *analysis, GradientMethod::adjoint);
  const ConstantGradients found = constant_gradients(problem, x, "rod");
  const auto& rod = std::get<ImportedBody>(problem.scene.bodies[1].shape);
  ASSERT_EQ(rod.variables.size(), 2U) << "height and width of the rod";
  for (const ImportedVariable& of : rod.variables) {
    const BodyConstants& change = *rod.file->design[of.in_design].derivative;
    for (std::size_t i = 0; i < problem.responses.size(); ++i) {
      const double sum = along(found.numbers[i], change);
      const double slope = expected(static_cast<Eigen::Index>(i), of.number.variable);
      EXPECT_NEAR(sum, slope, 1e-12 * sizes_along(found.numbers[i], change))
          << problem.responses[i].name;
    }
  }
}

TEST_F(Exchange, WithoutDerivativesKeepsTheGradientsOfOtherBodies) {
  Json document = slider_crank();
  const ProblemFile original = read("original.json", document);
  InvariantsFile file = exported(original, "rod");
  for (ConstantsDerivative& of : file.design) of.derivative.reset();
  write(write_invariants(file));
  Json edited = with_file(document, file);
  // Its design names variables of the problem, whose influence nobody knows.
  edited["variables"].erase("rod_width");
  EXPECT_THAT(complaint(edited), HasSubstr("/scene/bodies/rod/file names the file rod.json, which "
                                           "has no derivatives with respect to the variable "
                                           "\"rod_height\""));
  edited["variables"].erase("rod_height");
  const ProblemFile imported = read("imported.json", edited);
  const Eigen::VectorXd x = start_design(original), y = start_design(imported);
  auto a = analyze(original, x), b = analyze(imported, y);
  const Eigen::MatrixXd expected =
      gradients(original, x, *a, GradientMethod::direct).leftCols(2);  // of the crank
  const Eigen::MatrixXd found = gradients(imported, y, *b, GradientMethod::adjoint);
  ASSERT_EQ(found.cols(), 2);
  for (Eigen::Index i = 0; i < expected.rows(); ++i) {
    const double size = std::max(expected.row(i).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_LE((found.row(i) - expected.row(i)).cwiseAbs().maxCoeff() / size, 1e-9)
        << original.responses[i].name;
  }
}

TEST_F(Exchange, RefusesAnotherDesignUnlessItMayBeContinued) {
  Json document = exchanged(slider_crank());
  const ProblemFile problem = read("imported.json", document);
  Eigen::VectorXd x = start_design(problem);
  x(0) *= 1.01;  // the crank's own business
  EXPECT_NO_THROW(analyze(problem, x));
  x(3) *= 1.01;
  EXPECT_THAT(thrown<InputError>([&] { analyze(problem, x); }),
              HasSubstr("/scene/bodies/rod/file is known at the design rod_height"
                        " = 0.03 only, not at 0.0303: write rod.json anew"))
      << "simulated at a design that the file knows nothing of";
  document["variables"]["rod_height"]["start"] = "31 mm";
  EXPECT_THAT(complaint(document),
              HasSubstr("/scene/bodies/rod/file names the file rod.json of the design "
                        "rod_height = 0.03 [m], but the variable starts at "
                        "0.031"));
}

/// Continued linearly, central differences see the same derivatives: exact for the linear model.
TEST_F(Exchange, ContinuedLinearlyAgreesWithDifferences) {
  Json document = exchanged(slider_crank());
  document["scene"]["bodies"]["rod"]["other_designs"] = "linear";
  const ProblemFile problem = read("imported.json", document);
  const Eigen::VectorXd x = start_design(problem);
  auto analysis = analyze(problem, x);
  const Eigen::MatrixXd direct = gradients(problem, x, *analysis, GradientMethod::direct);
  const Eigen::MatrixXd central =
      gradients(problem, x, *analysis, GradientMethod::central_difference, {1e-4});
  for (Eigen::Index i = 0; i < direct.rows(); ++i) {
    EXPECT_LE((central - direct).row(i).cwiseAbs().maxCoeff(),
              1e-5 * direct.row(i).cwiseAbs().maxCoeff())
        << problem.responses[i].name;
  }
}

// What is said of bad files, and of what a file cannot do.

/// What is wrong with a file, after one edit of a good one.
struct BadFile {
  const char* pointer;
  const char* value;  ///< "remove" removes it
  const char* complaint;
};

TEST_F(Exchange, SaysWhatIsWrongWithAFile) {
  const Json document = exchanged(slider_crank());
  const Json good = Json::parse(text());
  const BadFile cases[] = {
      {"/format", "\"other\"", "/format must be \"pleuel-invariants\", got \"other\""},
      {"/version", "2", "/version must be 1"},
      {"/units", "\"mm\"", "/units must be \"SI\", got \"mm\""},
      {"/colour", "1", "has the unknown key \"colour\""},
      {"/invariants/mass", "-1", "/invariants/mass must be positive [kg], got -1"},
      {"/invariants/mass", "remove", "/invariants is missing the key \"mass\""},
      {"/invariants/first_moment", "[0, 0]", "/invariants/first_moment must be a list of 3 values"},
      {"/invariants/first_moment/0", "1",
       "/invariants/second_moment must be at least first_moment first_momentᵀ / mass"},
      {"/invariants/stiffness/0/0", "99",
       "/invariants/stiffness/0/0 must be a whole number from 0"},
      {"/invariants/stiffness/1", "[0, 0, 1.0]",
       "/invariants/stiffness/1 is a second entry in row 0, column 0"},
      {"/invariants/stiffness/1/2", "7.0", "/invariants/stiffness must be symmetric"},
      {"/invariants/stiffness", "[]", "/invariants/stiffness must be positive definite"},
      {"/invariants/moment_yy", "[]", "/invariants must have \"mass_matrix\" = \"moment_xx\" +"},
      {"/places/crank_pin/position", "[0.18, 0, 0]",
       "/places/slider_pin is where the place \"crank_pin\" is"},
      {"/stress/of_coordinates/0/2", "\"1\"", "/stress/of_coordinates/0/2 must be a number"},
      {"/stiffening/elements/0/slopes/0/1", "9.0",
       "/stiffening/elements/0/slopes must be symmetric"},
      {"/stiffening/elements/0/axial_stiffness", "0.0",
       "/stiffening/elements/0/axial_stiffness must be positive [N/m]"},
      {"/derivatives/rod_width/invariants/moment_yy", "[]",
       "/derivatives/rod_width/invariants must have \"mass_matrix\""},
      {"/derivatives/width", "{}", "/derivatives/width must have a value in /design"},
      {"/design/rod_width/unit", "\"mm\"", "has the unit \"mm\", which is no SI unit"},
  };
  for (const BadFile& bad : cases) {
    Json edited = good;
    const Json::json_pointer place(bad.pointer);
    if (std::string(bad.value) == "remove") {
      edited.at(place.parent_pointer()).erase(place.back());
    } else {
      edited[place] = Json::parse(bad.value);
    }
    write(edited.dump());
    const std::string found = complaint(document);
    EXPECT_THAT(found, HasSubstr(bad.complaint)) << bad.pointer;
    EXPECT_THAT(found, HasSubstr("rod.json")) << bad.pointer;
  }
}

TEST_F(Exchange, SaysWhatAFileCannotDo) {
  const Json document = exchanged(slider_crank());
  const std::vector<std::array<const char*, 3>> cases = {
      {"/scene/bodies/rod/file", "\"none.json\"", "none.json, which is not there"},
      {"/scene/bodies/rod/elements", "6", "/scene/bodies/rod has the unknown key \"elements\""},
      {"/scene/loads/tug/at", "[0.207, 0, 0]",
       "/scene/loads/tug/at must be at a place of the body \"rod\""},
      {"/responses/bow/at", "\"bwo\"",
       "/responses/bow/at names the unknown place \"bwo\"; did you mean \"bow\""},
      {"/responses/bow/against", "\"chord\"", "/responses/bow is missing the key \"chord\""},
      {"/responses/bow/chord", R"(["bow", "tug"])",
       "/responses/bow/chord is for imported bodies with \"against\": \"chord\""},
      {"/responses/rod_pull/part", "\"bending\"", "/responses/rod_pull/part must be"},
      {"/effects/rotary_inertia", "\"off\"", "from which nothing can be left out"},
  };
  for (const auto& [pointer, value, expected] : cases) {
    Json edited = document;
    edited[Json::json_pointer(pointer)] = Json::parse(value);
    EXPECT_THAT(complaint(edited), HasSubstr(expected));
  }
  InvariantsFile file = read_invariants(folder_.path() / "rod.json");
  file.constants.stress.reset();
  file.constants.stretching.reset();
  for (ConstantsDerivative& of : file.design) of.derivative.reset();
  file.design.clear();
  write(write_invariants(file));
  Json edited = document;
  edited["variables"].erase("rod_width");
  edited["variables"].erase("rod_height");
  EXPECT_THAT(complaint(edited), HasSubstr("has no block \"stress\""));
  for (const char* name : {"rod_stress", "rod_pull", "rod_use", "mean_stress"}) {
    edited["responses"].erase(name);
  }
  EXPECT_THAT(complaint(edited), HasSubstr("has no block \"stiffening\""));
  edited["effects"]["geometric_stiffening"] = "auto";
  EXPECT_EQ(complaint(edited), "");
}

// A rod from a program that shares nothing with this one.

/// Runs docs/invariants/planar_rod.py.
void write_rod_of_another_program(const std::filesystem::path& path) {
  const std::string command = PLEUEL_PYTHON " '" + source_folder() +
                              "/docs/invariants/planar_rod.py' '" + path.string() + "'";
  ASSERT_EQ(std::system(command.c_str()), 0) << command;
}

/// The rod from an independent program (docs/invariants/planar_rod.py) in place of Pleuel's beam.
/// Its matrices are the same integrals: responses differ by round-off. Its derivatives are central
/// differences: 1e-8. Its stress has no fixed-end terms of the inertia load, wℓ²/12 of some wL²/8
/// at nodes: 8/12/36 = 1.9 %.
TEST_F(Exchange, TakesTheRodOfAnotherProgram) {
  Json document = slider_crank();
  document["scene"]["loads"].erase("tug");
  for (const char* name : {"bow_rms", "sag", "speed", "rod_pull", "rod_use", "mean_stress"}) {
    document["responses"].erase(name);
  }
  document["variables"].erase("rod_width");
  document["scene"]["bodies"]["rod"]["section"]["width"] = "20 mm";
  write_rod_of_another_program(folder_.path() / "rod.json");
  const ProblemFile original = read("original.json", document);
  const ProblemFile imported =
      read("imported.json", with_file(document, read_invariants(folder_.path() / "rod.json")));
  const Eigen::VectorXd x = start_design(original);
  auto a = analyze(original, x), b = analyze(imported, x);
  const Eigen::MatrixXd expected = gradients(original, x, *a, GradientMethod::direct);
  const Eigen::MatrixXd found = gradients(imported, x, *b, GradientMethod::direct);
  for (Eigen::Index i = 0; i < expected.rows(); ++i) {
    const std::string& name = original.responses[i].name;
    const bool is_stress = name == "rod_stress";
    EXPECT_NEAR(values_of(*b)(i) / values_of(*a)(i), 1.0, is_stress ? 0.04 : 1e-9) << name;
    EXPECT_LE((found - expected).row(i).cwiseAbs().maxCoeff(),
              (is_stress ? 0.1 : 1e-6) * expected.row(i).cwiseAbs().maxCoeff())
        << name;
  }
}

/// The example of the documentation against the problem it was made from; tolerances as above.
TEST_F(Exchange, ExampleOfTheDocumentationIsTheSliderCrank) {
  write_rod_of_another_program(folder_.path() / "rod.json");
  std::filesystem::copy(source_folder() + "/docs/invariants/slider_crank.json",
                        folder_.path() / "example.json");
  const std::vector<std::string> quick = {"/simulation/end_time=10 ms", "/simulation/step=0.1 ms",
                                          "/scene/joints/bearing/drive/ramp=10 ms"};
  const ProblemFile example = read_problem(folder_.path() / "example.json", quick).complete();
  const ProblemFile original = sample_problem("slider_crank", quick);
  const Eigen::VectorXd found = values_of(*analyze(example, start_design(example)));
  const Eigen::VectorXd expected = values_of(*analyze(original, start_design(original)));
  ASSERT_EQ(example.responses.size(), original.responses.size());
  for (std::size_t i = 0; i < example.responses.size(); ++i) {
    const std::string& name = example.responses[i].name;
    const auto row = static_cast<Eigen::Index>(i);
    EXPECT_EQ(name, original.responses[i].name);
    EXPECT_NEAR(found(row) / expected(row), 1.0, name == "rod_stress" ? 0.04 : 1e-9) << name;
  }
}

}  // namespace
}  // namespace pleuel::test::imported_body_test
