#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "core/scene/problem_reader.hpp"
#include "sensitivity/finite_difference.hpp"
#include "sensitivity/gradients.hpp"

/// Frequencies of modes along an axis, where those of two modes coincide.
namespace pleuel::test::frequency_direction_test {
namespace {

/// A square cantilever that is fixed to the ground, turned by 30° about its axis z = global z: local y
/// stays in the global plane x y. Both planes of bending have one frequency.
ProblemFile square_cantilever(const std::string& joints = "", const std::string& bodies = "") {
  return read_problem_text(
             fmt::format(R"j({{"scene": {{"bodies": {{"mast": {{"type": "beam", "from": [0, 0, 0],
    "to": [0.4330127018922193, 0.25, 0], "material": "steel", "elements": 4,
    "section": {{"type": "rectangle", "width": "= w", "height": "= h"}}}}{}}},
    "joints": {{"root": {{"type": "fixed", "bodies": ["ground", "mast"], "at": [0, 0, 0]}}{}}}}},
  "simulation": {{"end_time": "2 ms", "step": "1 ms", "resolution_check": false}},
  "variables": {{"w": {{"start": "16 mm", "lower": "5 mm", "upper": "60 mm"}},
                "h": {{"start": "16 mm", "lower": "5 mm", "upper": "60 mm"}}}},
  "responses": {{
    "body_y": {{"type": "frequency", "body": "mast", "direction": "y"}},
    "body_z": {{"type": "frequency", "body": "mast", "direction": "z"}},
    "second_z": {{"type": "frequency", "body": "mast", "direction": "z", "mode": 2}},
    "across": {{"type": "frequency", "direction": "z"}},
    "second_across": {{"type": "frequency", "direction": "z", "mode": 2}},
    "in_plane": {{"type": "frequency", "direction": "y"}},
    "first": {{"type": "frequency"}}}}}})j",
                         bodies, joints),
             "mast.json")
      .complete();
}

/// ω is proportional to the thickness in the direction of bending, but for rotary inertia, (βr)² = 3e-4
/// for the first mode and 7 times that for the second: its derivative by that thickness is ω/h, and
/// by the other one zero. The mean of both is what modes in the order of frequencies have.
TEST(FrequencyDirection, HasTheGradientOfItsPlaneWherePlanesCoincide) {
  const ProblemFile problem = square_cantilever();
  const Eigen::VectorXd x = start_design(problem);
  const auto analysis = analyze(problem, x);
  const Eigen::VectorXd values = values_of(*analysis);
  const Eigen::MatrixXd gradients = direct_gradients(*analysis) * x.asDiagonal();
  for (int i = 0; i < 7; ++i) {
    const bool is_second = i == 2 || i == 4;
    EXPECT_NEAR(values(i) / values(is_second ? 2 : 0), 1.0, 1e-7) << problem.responses[i].name;
    const bool is_of_width = i >= 1 && i <= 4;
    const double of_width = i == 6 ? 0.5 : is_of_width ? 1.0 : 0.0;
    const double allowed = is_second ? 1e-2 : 1e-3;
    EXPECT_NEAR(gradients(i, 0) / values(i), of_width, allowed) << problem.responses[i].name;
    EXPECT_NEAR(gradients(i, 1) / values(i), 1.0 - of_width, allowed) << problem.responses[i].name;
  }
}

/// Along vectors, as of a beam whose section stands obliquely: those of its own axes.
TEST(FrequencyDirection, MayBeAVector) {
  ProblemFile problem = square_cantilever();
  for (ResponseSettings& response : problem.responses) {
    if (response.name == "in_plane") response.mode.axis = {{-0.5, 0.8660254037844386, 0.0}};
  }
  problem.variables[0].start = 0.012;  // so that planes do not coincide
  const Eigen::VectorXd x = start_design(problem);
  const Eigen::VectorXd values = values_of(*analyze(problem, x));
  EXPECT_NEAR(values(5) / values(0), 1.0, 1e-7);
}

/// They are smooth there: central differences of designs on both sides have one limit. 1e-6: what
/// differences of fourth order with steps of 1e-3 leave of frequencies that are exact to 1e-12.
TEST(FrequencyDirection, IsSmoothWherePlanesCoincide) {
  const ProblemFile problem = square_cantilever();
  const Eigen::VectorXd x = start_design(problem);
  const auto analysis = analyze(problem, x);
  const Eigen::VectorXd values = values_of(*analysis);
  const Eigen::MatrixXd direct = direct_gradients(*analysis) * x.asDiagonal();
  const Eigen::MatrixXd wide = central_differences(problem, x, 2e-3) * x.asDiagonal();
  const Eigen::MatrixXd narrow = central_differences(problem, x, 1e-3) * x.asDiagonal();
  const Eigen::MatrixXd error = (4.0 * narrow - wide) / 3.0 - direct;
  for (int i = 0; i < 6; ++i) {
    EXPECT_LE(error.row(i).lpNorm<Eigen::Infinity>(), 1e-6 * values(i))
        << problem.responses[i].name;
  }
}

/// Of two masts without a joint between them, whose frequencies all coincide in fours.
TEST(FrequencyDirection, IsFoundAmongFourModesThatCoincide) {
  const ProblemFile problem = square_cantilever(
      R"j(, "second_root": {"type": "fixed", "bodies": ["ground", "other"], "at": [1, 0, 0]})j",
      R"j(, "other": {"type": "beam", "from": [1, 0, 0], "to": [1.4330127018922193, 0.25, 0],
    "material": "steel", "elements": 4,
    "section": {"type": "rectangle", "width": "= w", "height": "= h"}})j");
  const Eigen::VectorXd x = start_design(problem);
  const auto analysis = analyze(problem, x);
  const Eigen::VectorXd values = values_of(*analysis);
  const Eigen::MatrixXd gradients = direct_gradients(*analysis) * x.asDiagonal();
  const int across = 3, second_across = 4, in_plane = 5;
  EXPECT_NEAR(values(second_across) / values(across), 1.0, 1e-7);
  EXPECT_NEAR(gradients(across, 0) / values(across), 1.0, 1e-3);
  EXPECT_NEAR(gradients(second_across, 0) / values(across), 1.0, 1e-3);
  EXPECT_NEAR(gradients(in_plane, 1) / values(in_plane), 1.0, 1e-3);
}

}  // namespace
}  // namespace pleuel::test::frequency_direction_test
