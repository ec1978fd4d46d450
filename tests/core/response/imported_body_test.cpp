#include <cstdlib>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/response/body_export.hpp"
#include "core/scene/invariants_file.hpp"
#include "core/scene/visit_constants.hpp"
#include "sensitivity/constant_gradients.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/support/parameter_name.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/source_folder.hpp"
#include "tests/support/temporary_folder.hpp"

/// A member that is taken out of a problem by its invariants and put back as a body that is known
/// by them only: nothing may change but round-off.
namespace pleuel::test::imported_body_test {
namespace {

using Json = nlohmann::ordered_json;
using testing::HasSubstr;

constexpr const char* responses = R"({
  "mass": {"type": "mass"},
  "rod_mass": {"type": "mass", "body": "rod"},
  "rod_frequency": {"type": "frequency", "body": "rod", "mode": 2},
  "crank_stress": {"type": "stress", "body": "crank", "over_time": "max"},
  "rod_stress": {"type": "stress", "body": "rod", "over_time": "max"},
  "rod_pull": {"type": "stress", "body": "rod", "part": "normal", "over_time": "max"},
  "rod_use": {"type": "stress", "body": "rod", "part": "utilization", "over_time": "max"},
  "mean_stress": {"type": "stress", "body": "rod", "over_time": "mean"},
  "bow": {"type": "deflection", "body": "rod", "at": 0.5, "over_time": "max-abs"},
  "bow_rms": {"type": "deflection", "body": "rod", "at": 0.4, "over_time": "rms"},
  "sag": {"type": "deflection", "body": "rod", "at": 0.4, "against": "chord", "over_time": "rms"},
  "lag": {"type": "deflection", "body": "rod", "at": 0.5, "against": "rigid-mechanism",
          "direction": "y", "over_time": "max-abs"},
  "place": {"type": "position", "body": "rod", "at": 0.5, "direction": "y", "over_time": "rms"},
  "speed": {"type": "velocity", "body": "rod", "at": 0.4, "direction": "magnitude",
            "over_time": "rms"},
  "jerk": {"type": "acceleration", "body": "rod", "at": 0.5, "direction": "x",
           "over_time": "mean"},
  "energy": {"type": "elastic-energy", "body": "rod", "over_time": "rms"},
  "torque": {"type": "drive-torque", "joint": "bearing", "over_time": "rms"},
  "reaction": {"type": "reaction-force", "joint": "slider_pin", "direction": "magnitude",
               "over_time": "rms"}
})";

/// The slider-crank for 8 ms of a ramp to 200 rad/s, steps of 0.1 ms; with everything that
/// responses can ask of its rod, and a weight on a place between nodes.
Json slider_crank() {
  std::ifstream stream(source_folder() + "/problems/slider_crank.json");
  Json document = Json::parse(stream);
  document["simulation"]["end_time"] = 8e-3;
  document["simulation"]["step"] = 1e-4;
  document["simulation"]["newton_tolerance"] = 1e-13;
  document["scene"]["joints"]["bearing"]["drive"]["ramp"] = 8e-3;
  document["scene"]["materials"]["steel"]["strength"] = "355 MPa";
  document["scene"]["gravity"] = {0, -9.81, 0};
  document["scene"]["loads"]["tug"] = {{"type", "force"},
                                       {"body", "rod"},
                                       {"at", {0.2, 0, 0}},
                                       {"direction", {0, 1, 0}},
                                       {"value", -50}};
  document["responses"] = Json::parse(responses);
  for (const char* key :
       {"constraints", "pareto", "accuracy", "uncertainty", "optimizer", "$schema"}) {
    document.erase(key);
  }
  document["objective"] = {{"minimize", "mass"}};
  return document;
}

class Exchange : public testing::Test {
 protected:
  ProblemFile read(const std::string& name, const Json& document) const {
    std::ofstream(folder_.path() / name) << document;
    return read_problem(folder_.path() / name).complete();
  }

  /// The complaint about a document; empty if there is none.
  std::string complaint(const Json& document) const {
    try {
      const ProblemFile problem = read("problem.json", document);
      analyze(problem, start_design(problem));
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  static InvariantsFile exported(const ProblemFile& problem, const std::string& body) {
    const Eigen::VectorXd x = start_design(problem);
    const Design<double> start(x.begin(), x.end());
    const Model model = build_model(problem.scene, problem.effects, start, start);
    return export_body(problem, model, body,
                       std::vector<std::string>(problem.variables.size(), "m"));
  }

  void write(const std::string& text) const { std::ofstream(folder_.path() / "rod.json") << text; }

  /// Exports the rod of a document, and returns the document with the file in place of the rod.
  Json exchanged(const Json& document) const {
    const InvariantsFile file = exported(read("original.json", document), "rod");
    write(write_invariants(file));
    return with_file(document, file);
  }

  /// The name of a place along the rod.
  static std::string place_at(const InvariantsFile& file, double share) {
    for (const BodyPlace& place : file.constants.places) {
      if (std::abs(place.position.x() - 0.18 * share) < 1e-9) return place.name;
    }
    return "";
  }

  /// A beam has the frequencies of both planes whatever the motion has, a file those of its
  /// coordinates: in a plane the rod's second (it is 20 mm wide and 30 mm high) is the file's
  /// first.
  static Json with_file(Json document, const InvariantsFile& file) {
    const bool is_in_space = document.contains(Json::json_pointer("/effects/spatial_motion"));
    if (!is_in_space && document["responses"].contains("rod_frequency")) {
      document["responses"]["rod_frequency"]["mode"] = 1;
    }
    const Json rod = document["scene"]["bodies"]["rod"];
    document["scene"]["bodies"]["rod"] = {
        {"type", "invariants"}, {"file", "rod.json"}, {"from", rod["from"]}, {"to", rod["to"]}};
    for (auto& [name, response] : document["responses"].items()) {
      if (!response.contains("at") || response["body"] != "rod") continue;
      // Responses at the same place share the name of the first.
      const double share = response["at"].get<double>();
      response["at"] = place_at(file, share);
      if (response.value("against", "") == "chord") {
        response["chord"] = {place_at(file, 0.0), place_at(file, 1.0)};
      }
    }
    return document;
  }

  /// The largest difference of responses and of gradients by either method, relative to the largest
  /// of the row, over the gradients that are not zero.
  struct Differences {
    double values = 0.0, direct = 0.0, adjoint = 0.0;
  };
  static Differences compare(const ProblemFile& original, const ProblemFile& imported) {
    const Eigen::VectorXd x = start_design(original);
    auto a = analyze(original, x), b = analyze(imported, start_design(imported));
    Differences differences;
    differences.values =
        (values_of(*b) - values_of(*a)).cwiseQuotient(values_of(*a)).cwiseAbs().maxCoeff();
    const Eigen::MatrixXd expected = gradients(original, x, *a, GradientMethod::direct);
    const auto distance = [&](GradientMethod method) {
      const Eigen::MatrixXd found = gradients(imported, x, *b, method);
      double largest = 0.0;
      for (Eigen::Index i = 0; i < expected.rows(); ++i) {
        const double size = expected.row(i).cwiseAbs().maxCoeff();
        const double error = (found.row(i) - expected.row(i)).cwiseAbs().maxCoeff() / size;
        EXPECT_LE(error, 1e-6) << original.responses[i].name;
        largest = std::max(largest, error);
      }
      return largest;
    };
    differences.direct = distance(GradientMethod::direct);
    differences.adjoint = distance(GradientMethod::adjoint);
    return differences;
  }

  TemporaryFolder folder_;
};

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
  visit_constants(gradient, change,
                  [&](const auto& a, const auto& b) { sum += size_of_product(a, b); });
  return sum;
}

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

/// Σ dJ/dI · dI/dx over all numbers of the rod is dJ/dx of the variables that only the rod has. Parts of the sum may be larger
/// than it: errors are relative to the sum of their sizes.
TEST_F(Exchange, HasGradientsByItsNumbersThatAddUpToThoseByVariables) {
  Json document = slider_crank();
  document["simulation"]["end_time"] = 2e-3;
  document["scene"]["bodies"]["rod"]["elements"] = 2;
  document["responses"].erase("crank_stress");
  const ProblemFile problem = read("imported.json", exchanged(document));
  const Eigen::VectorXd x = start_design(problem);
  const auto analysis = analyze(problem, x);
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
  try {
    analyze(problem, x);
    FAIL() << "simulated at a design that the file knows nothing of";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("/scene/bodies/rod/file is known at the design rod_height"
                                        " = 0.03 only, not at 0.0303: write rod.json anew"));
  }
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
  std::ifstream stream(folder_.path() / "rod.json");
  std::ostringstream text;
  text << stream.rdbuf();
  EXPECT_EQ(write_invariants(exported(read("imported.json", document), "rod")), text.str());
}

/// What is wrong with a file, after one edit of a good one.
struct BadFile {
  const char* pointer;
  const char* value;  ///< "remove" removes it
  const char* complaint;
};

TEST_F(Exchange, SaysWhatIsWrongWithAFile) {
  const Json document = exchanged(slider_crank());
  std::ifstream stream(folder_.path() / "rod.json");
  const Json good = Json::parse(stream);
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
      {"/scene/bodies/rod/file", "\"none.json\"", "/scene/bodies/rod/file must name a file"},
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
