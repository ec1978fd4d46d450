/// Stress of a beam where a load acts, which the mesh of the file need not know of, against beam
/// theory: a simply supported beam of 1 m with everything at 400 mm.
#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "core/response/analysis.hpp"
#include "core/scene/problem_reader.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/support/parameter_name.hpp"
#include "tests/support/problem_runs.hpp"

namespace pleuel::test::point_load_test {
namespace {

constexpr double length = 1.0, width = 0.01, height = 0.02;
constexpr double a = 0.4, b = 0.6;  ///< from the load to either end
constexpr double modulus = width * height * height / 6.0, area = width * height;

/// @param gravity  along y [m/s²]
/// @param load     without its place
ProblemFile supported_beam(int elements, double gravity, const std::string& load) {
  return read_problem_text(fmt::format(
                               R"({{"scene": {{
  "gravity": [0, {}, 0],
  "bodies": {{"beam": {{"type": "beam", "from": [0, 0, 0], "to": [{{"variable": "length"}}, 0, 0],
    "material": "steel", "elements": {}, "frame": "chord",
    "section": {{"type": "rectangle", "width": "10 mm", "height": {{"variable": "height"}}}}}}}},
  "joints": {{
    "left": {{"type": "revolute", "bodies": ["ground", "beam"], "at": [0, 0, 0]}},
    "right": {{"type": "point-on-line", "bodies": ["ground", "beam"],
              "at": [{{"variable": "length"}}, 0, 0], "axis": [1, 0, 0]}}}},
  "loads": {{"load": {{"body": "beam", "at": [{{"variable": "length", "factor": 0.4}}, 0, 0], {}}}}}}},
  "effects": {{"geometric_stiffening": "off"}},
  "simulation": {{"end_time": "0.2 ms", "step": "0.1 ms", "initial_state": "quasi-static"}},
  "variables": {{"length": {{"start": 1, "lower": 0.5, "upper": 2}},
                "height": {{"start": "20 mm", "lower": "10 mm", "upper": "40 mm"}}}},
  "responses": {{"stress": {{"type": "stress", "body": "beam", "over_time": "final"}}}}}})",
                               gravity, elements, load),
                           "beam.json")
      .complete();
}

double stress_of(const ProblemFile& problem) {
  return values_of(*analyze(problem, start_design(problem)))(0);
}

class Meshes : public testing::TestWithParam<int> {};

/// F a b/L + q a b/2; both parts have their largest moment where the force is, or next to it.
TEST_P(Meshes, GiveTheStressUnderAForce) {
  constexpr double force = 100.0, gravity = 9.81, density = 7850.0;
  const double moment = force * a * b / length + density * area * gravity * a * b / 2.0;
  const double stress = stress_of(supported_beam(
      GetParam(), -gravity, R"("type": "force", "direction": [0, -1, 0], "value": "100 N")"));
  EXPECT_NEAR(stress, moment / modulus, 1e-6 * moment / modulus);
}

/// The moment jumps from −M a/L to M b/L.
TEST_P(Meshes, GiveTheStressBesideAMoment) {
  const double stress = stress_of(supported_beam(
      GetParam(), 0.0, R"("type": "torque", "direction": [0, 0, 1], "value": "30 N m")"));
  EXPECT_NEAR(stress, 30.0 * b / length / modulus, 1e-6 * stress);
}

/// The axial force jumps from 600 N to zero; F a b/L of the bending force is on both sides.
TEST_P(Meshes, GiveTheStressBesideAnAxialForce) {
  const double stress = stress_of(supported_beam(
      GetParam(), 0.0, R"("type": "force", "direction": [0.6, -0.8, 0], "value": "1000 N")"));
  const double expected = 600.0 / area + 800.0 * a * b / length / modulus;
  EXPECT_NEAR(stress, expected, 1e-6 * expected);
}

/// ∂(0.24 F L/W): the node at the load moves with the length.
TEST_P(Meshes, GiveTheGradient) {
  const ProblemFile problem = supported_beam(
      GetParam(), 0.0, R"("type": "force", "direction": [0, -1, 0], "value": "100 N")");
  const auto analysis = analyze(problem, start_design(problem));
  const Eigen::MatrixXd gradient = direct_gradients(*analysis);
  const double stress = 100.0 * a * b / length / modulus;
  EXPECT_NEAR(gradient(0, 0), stress / length, 1e-6 * stress / length);
  EXPECT_NEAR(gradient(0, 1), -2.0 * stress / height, 1e-6 * 2.0 * stress / height);
}

/// 5 and 10 have a node there already.
INSTANTIATE_TEST_SUITE_P(Elements, Meshes, testing::Values(1, 2, 3, 4, 5, 7, 8, 10),
                         named_by_value());

}  // namespace
}  // namespace pleuel::test::point_load_test
