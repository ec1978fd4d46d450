#include <fstream>
#include <sstream>

#include "core/base/eager_matrices.hpp"
#include "core/response/analysis.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/source_folder.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::exudyn_test {
namespace {

/// Columns of tests/data/…: time, angle, slider x, slider v, deflection, chord, torque.
Eigen::MatrixXd read_reference(int rod_diameter) {
  std::ifstream stream(source_folder() + "/tests/data/slider_crank_exudyn_rod" +
                       std::to_string(rod_diameter) + "mm.csv");
  std::vector<double> numbers;
  std::string line;
  std::getline(stream, line);
  while (std::getline(stream, line)) {
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) numbers.push_back(std::stod(cell));
  }
  const auto rows = static_cast<Eigen::Index>(numbers.size() / 7);
  return Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 7, Eigen::RowMajor>>(numbers.data(),
                                                                                     rows, 7);
}

/// Largest difference over the whole history, relative to the largest value.
struct Distance {
  double deflection, position, torque;
};

Distance distance_to_exudyn(int rod_diameter, const std::string& stiffening) {
  const Eigen::MatrixXd reference = read_reference(rod_diameter);
  EXPECT_EQ(reference.rows(), 301);
  const auto problem =
      sample_problem("slider_crank_exudyn",
                     {"/scene/bodies/rod/section/diameter=" + std::to_string(rod_diameter) + " mm",
                      "/effects/geometric_stiffening=" + stiffening});
  const auto analysis = analyze(problem, Eigen::VectorXd());
  const Eigen::Index every = analysis->trajectory.steps() / (reference.rows() - 1);
  EXPECT_NEAR(analysis->trajectory.time(every), reference(1, 0), 1e-15);
  const auto distance = [&](std::size_t response, int column) {
    const Eigen::MatrixXd& history = analysis->histories[response];
    double largest = 0.0;
    for (Eigen::Index i = 0; i < reference.rows(); ++i) {
      largest = std::max(largest, std::abs(history(0, i * every) - reference(i, column)));
    }
    return largest / reference.col(column).lpNorm<Eigen::Infinity>();
  };
  return {distance(0, 4), distance(1, 2), distance(2, 6)};
}

/// The limit is 0.5 %. Measured with 8 elements, h = 5e-5 s: deflection 7e-4 and 2.4e-3,
/// torque 1.1e-3 and 1.4e-3, position 6e-7. EXUDYN's model has no rotary inertia (0.02 %).
TEST(SliderCrankAgainstExudyn, IsWithinHalfAPercentOverTheWholeHistory) {
  for (int diameter : {10, 30}) {
    const Distance distance = distance_to_exudyn(diameter, "on");
    EXPECT_LE(distance.deflection, 5e-3) << diameter << " mm";
    EXPECT_LE(distance.torque, 5e-3) << diameter << " mm";
    EXPECT_LE(distance.position, 5e-6) << diameter << " mm";
  }
}

/// The slider pulls with 22 % of the Euler load at the extended position.
TEST(SliderCrankAgainstExudyn, WithoutStiffeningTheThinRodIsEighteenPercentOff) {
  const Distance distance = distance_to_exudyn(10, "off");
  EXPECT_GE(distance.deflection, 0.15);
  EXPECT_LE(distance.deflection, 0.21);
}

}  // namespace
}  // namespace pleuel::test::exudyn_test
