#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/response/analysis.hpp"
#include "core/scene/problem_reader.hpp"
#include "sensitivity/gradients.hpp"

namespace pleuel::test::transmission_angle_test {
namespace {

struct Found {
  Eigen::VectorXd values;
  Eigen::MatrixXd gradients;  ///< a row each response
};

Found found_of(const std::string& text, const Eigen::VectorXd* x = nullptr) {
  const ProblemFile problem = read_problem_text(text, "test.json", {}).complete();
  const auto analysis = analyze(problem, x != nullptr ? *x : start_design(problem));
  return {values_of(*analysis), direct_gradients(*analysis)};
}

std::string bar(const std::string& name, const std::string& from, const std::string& to) {
  return fmt::format(
      R"("{}": {{"type": "beam", "from": {}, "to": {}, "material": "steel", "elements": 1,
      "rigid": true, "section": {{"type": "circle", "diameter": 0.01}}}})",
      name, from, to);
}

/// A crank of r and a rod of l, through a turn: cos of the angle against the normal of the guide is
/// sin φ r/l, so that the least angle is acos(r/l).
TEST(TransmissionAngle, OfASliderCrankIsLeastWhereTheCrankStandsAcross) {
  const double r = 0.1, l = 0.3;
  const std::string text = fmt::format(
      R"({{"scene": {{"bodies": {{{}, {}, "slider": {{"type": "point-mass", "at": [0.4, 0, 0], "mass": 1}}}},
      "joints": {{
        "shaft": {{"type": "revolute", "bodies": ["ground", "crank"], "at": [0, 0, 0],
                  "drive": {{"type": "constant-speed", "speed": 6.283185307179586}}}},
        "pin": {{"type": "revolute", "bodies": ["crank", "rod"], "at": [{{"variable": "r"}}, 0, 0]}},
        "wrist": {{"type": "spherical", "bodies": ["rod", "slider"], "at": [0.4, 0, 0]}},
        "guide": {{"type": "point-on-line", "bodies": ["ground", "slider"], "at": [0.4, 0, 0],
                  "axis": [2, 0, 0]}}}}}},
    "simulation": {{"end_time": 1, "step": 0.0025}},
    "variables": {{"r": {{"start": 0.1, "lower": 0.05, "upper": 0.15}}}},
    "responses": {{"mu": {{"type": "transmission-angle", "body": "rod", "joint": "guide",
                         "over_time": "min"}},
                  "at_end": {{"type": "transmission-angle", "bodies": ["crank", "rod"],
                             "over_time": "final"}}}}}})",
      bar("crank", "[0, 0, 0]", R"([{"variable": "r"}, 0, 0])"),
      bar("rod", R"([{"variable": "r"}, 0, 0])", "[0.4, 0, 0]"));
  const Found found = found_of(text);
  EXPECT_NEAR(found.values(0), std::numbers::pi / 2 - std::asin(r / l), 1e-4);
  EXPECT_NEAR(found.values(1), 0.0, 1e-4) << "in line again after a turn";
  // l = 0.4 − r here: sin(π/2 − μ) = r/(0.4 − r).
  const double sine = r / l, slope = -(1 / l + r / (l * l)) / std::sqrt(1 - sine * sine);
  EXPECT_NEAR(found.gradients(0, 0), slope, 1e-3 * std::abs(slope));
}

/// A four-bar with ground d, crank a, coupler b, rocker c: the angle between coupler and rocker follows from
/// the diagonal e² = a² + d² − 2ad cos φ, cos μ = (b² + c² − e²)/(2bc); its gradient is that of
/// differences.
TEST(TransmissionAngle, OfAFourBarIsThatOfTheTriangleOverItsDiagonal) {
  const auto text_of = [](double end) {
    const double a = 0.1, b = 0.3, c = 0.25, d = 0.32;
    const double e = d - a, cosine = (e * e + b * b - c * c) / (2 * e * b);
    const std::string tip =
        fmt::format("[{:.17g}, {:.17g}, 0]", a + b * cosine, b * std::sqrt(1 - cosine * cosine));
    return fmt::format(
        R"({{"scene": {{"bodies": {{{}, {}, {}}},
      "joints": {{
        "shaft": {{"type": "revolute", "bodies": ["ground", "crank"], "at": [0, 0, 0],
                  "drive": {{"type": "constant-speed", "speed": 1}}}},
        "one": {{"type": "revolute", "bodies": ["crank", "coupler"], "at": [0.1, 0, 0]}},
        "two": {{"type": "revolute", "bodies": ["coupler", "rocker"], "at": {}}},
        "three": {{"type": "revolute", "bodies": ["ground", "rocker"], "at": [{{"variable": "d"}}, 0, 0]}}}}}},
    "simulation": {{"end_time": {}, "step": 0.01}},
    "variables": {{"d": {{"start": 0.32, "lower": 0.3, "upper": 0.34}}}},
    "responses": {{"mu": {{"type": "transmission-angle", "bodies": ["coupler", "rocker"],
                         "over_time": "final"}}}}}})",
        bar("crank", "[0, 0, 0]", "[0.1, 0, 0]"), bar("coupler", "[0.1, 0, 0]", tip),
        bar("rocker", R"([{"variable": "d"}, 0, 0])", tip), tip, end);
  };
  for (const double phi : {0.5, 2.0}) {
    const double a = 0.1, b = 0.3, c = 0.25, d = 0.32;
    const double square = a * a + d * d - 2 * a * d * std::cos(phi);
    const double cosine = (b * b + c * c - square) / (2 * b * c);
    const Found found = found_of(text_of(phi));
    EXPECT_NEAR(found.values(0), std::acos(std::abs(cosine)), 1e-6) << phi;
    const Eigen::VectorXd more = Eigen::VectorXd::Constant(1, d + 1e-5),
                          less = Eigen::VectorXd::Constant(1, d - 1e-5);
    const double slope =
        (found_of(text_of(phi), &more).values(0) - found_of(text_of(phi), &less).values(0)) / 2e-5;
    EXPECT_NEAR(found.gradients(0, 0) / slope, 1.0, 1e-5) << phi;
  }
}

}  // namespace
}  // namespace pleuel::test::transmission_angle_test
