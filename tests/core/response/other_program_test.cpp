#include <cstdlib>
#include <filesystem>

#include <gmock/gmock.h>

#include "core/base/eager_matrices.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/core/response/exchange.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/source_folder.hpp"

/// A rod from a program that shares nothing with this one.
namespace pleuel::test::other_program_test {
namespace {

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
}  // namespace pleuel::test::other_program_test
