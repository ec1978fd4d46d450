#include <algorithm>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "core/base/eager_matrices.hpp"
#include "core/response/effect_influence.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/core/response/exchange.hpp"
#include "tests/support/parameter_name.hpp"

/// Nothing changes but round-off.
namespace pleuel::test::imported_body_test {
namespace {

using testing::HasSubstr;

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

}  // namespace
}  // namespace pleuel::test::imported_body_test
