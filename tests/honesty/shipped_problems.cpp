#include "tests/honesty/shipped_problems.hpp"

#include "core/base/eager_matrices.hpp"
#include "core/scene/problem_reader.hpp"
#include "tests/support/files.hpp"

namespace pleuel::test {

const std::vector<ShippedProblem>& shipped_problems() {
  static const std::vector<ShippedProblem> problems = {
      {"four_bar", {0.005388, 0.008619, 0.01301}},
      {"robot_arm", {0.05412, 0.0015, 0.02624, 0.0015}},
      {"slider_crank", {0.01157, 0.02313, 0.004885, 0.009769}},
      {"slider_crank_round", {0.02283, 0.01143}},
      {"slider_crank_tapered",
       {0.02346, 0.02099, 0.01801, 0.01436, 0.009758, 0.01198, 0.01201, 0.009584}},
      {"spatial_slider_crank", {0.01457, 0.005061, 0.007828}},
      {"slider_crank_exudyn", {}}};
  return problems;
}

ProblemFile read_shipped(const ShippedProblem& problem) {
  return read_problem(source_folder() + "/problems/" + problem.name + ".json", {}).complete();
}

Eigen::VectorXd optimum_of(const ShippedProblem& problem) {
  return Eigen::Map<const Eigen::VectorXd>(problem.optimum.data(),
                                           static_cast<Eigen::Index>(problem.optimum.size()));
}

}  // namespace pleuel::test
