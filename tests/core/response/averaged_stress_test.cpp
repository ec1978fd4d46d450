#include <numbers>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "core/response/analysis.hpp"
#include "core/scene/problem_reader.hpp"

namespace pleuel::test::averaged_stress_test {
namespace {

constexpr double pull = 3e4, shake = 190.0, length = 0.4, diameter = 0.02;

/// Mean, rms and integral over two periods of the largest normal and von Mises stress of a rod that is
/// pulled and shaken.
Eigen::VectorXd averages(const std::string& spatial_motion) {
  std::string responses;
  for (const char* part : {"normal", "von-mises"}) {
    for (const char* over_time : {"mean", "rms", "integral"}) {
      responses += fmt::format(
          R"({}"{}-{}": {{"type": "stress", "body": "rod", "part": "{}", "over_time": "{}",
                          "from": 0.2, "to": 0.6}})",
          responses.empty() ? "" : ", ", part, over_time, part, over_time);
    }
  }
  const ProblemFile problem = read_problem_text(fmt::format(R"({{"scene": {{
          "bodies": {{"rod": {{"type": "beam", "from": [0, 0, 0], "to": [{}, 0, 0],
                              "material": "steel", "elements": 2,
                              "section": {{"type": "circle", "diameter": {}}},
                              "damping": {{"stiffness": "1e-4 s"}}}}}},
          "joints": {{"clamp": {{"type": "fixed", "bodies": ["ground", "rod"], "at": [0, 0, 0]}}}},
          "loads": {{
            "pull": {{"type": "force", "body": "rod", "at": [{}, 0, 0], "direction": [1, 0, 0],
                     "value": {{"type": "step", "to": {}, "rise": 0.1}}}},
            "shake": {{"type": "force", "body": "rod", "at": [{}, 0, 0], "direction": [0, 1, 0],
                      "value": {{"type": "harmonic", "amplitude": {}, "frequency": "5 Hz"}}}}}}}},
        "effects": {{"geometric_stiffening": "off", "spatial_motion": "{}"}},
        "simulation": {{"end_time": 0.6, "step": 0.001}}, "responses": {{{}}}}})",
                                                            length, diameter, length, pull, length,
                                                            shake, spatial_motion, responses),
                                                "rod.json")
                                  .complete();
  return values_of(*analyze(problem, start_design(problem)));
}

/// The points of a section stay where they are, in space, too: at each the mean of what shakes is N/A.
TEST(AveragedStress, IsThatOfAPointThatStaysWhereItIs) {
  const Eigen::VectorXd in_plane = averages("off"), in_space = averages("on");
  for (Eigen::Index i = 0; i < in_plane.size(); ++i) {
    EXPECT_NEAR(in_space(i), in_plane(i), 1e-6 * in_plane(i)) << i;
  }
  const double axial = pull / (std::numbers::pi * diameter * diameter / 4.0);
  EXPECT_NEAR(in_space(0), axial, 2e-3 * axial);  // the rod vibrates a little
}

}  // namespace
}  // namespace pleuel::test::averaged_stress_test
