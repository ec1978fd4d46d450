#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/scene/visit_constants.hpp"
#include "sensitivity/constant_gradients.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/core/response/exchange.hpp"

/// Derivatives of a body from a file: by its design, by each of its numbers, and where it has none.
namespace pleuel::test::imported_gradient_test {
namespace {

using testing::HasSubstr;

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

}  // namespace
}  // namespace pleuel::test::imported_gradient_test
