#include "core/base/eager_matrices.hpp"
#include "core/linear/elastic_stability.hpp"
#include "tests/core/start/quasi_static_beam.hpp"
#include "tests/support/test.hpp"

/// At what share of their loads members buckle, as it is told.
namespace pleuel::test::buckling_load_test {
namespace {

using namespace quasi_static_beam;

/// Euler's load of two pins, π² EI/L², and of a cantilever, a quarter of it, whatever the frame of
/// the body is that the load turns with, and however many there are.
TEST(ElasticStability, TheLoadOfBucklingIsThatOfEveryFrame) {
  const std::string pins =
      joint("a", "revolute", 0.0) + ", " + joint("b", "point-on-line", 1.0, "[1, 0, 0]");
  for (const std::string frame : {"tangent", "chord", "tangent-end", "mean-axis"}) {
    for (const double share : {1.1, 1.5, 3.0}) {
      const double euler = std::numbers::pi * std::numbers::pi * stiffness;
      const std::string at = fmt::format("buckles, at some {:.3g} of", 1.0 / share);
      EXPECT_THAT(error_of(beam(pins, -share * euler, 0.0, 8, "{}", frame)), HasSubstr(at))
          << frame << share;
      EXPECT_THAT(error_of(beam(clamp, -0.25 * share * euler, 0.0, 8, "{}", frame)), HasSubstr(at))
          << frame << share;
    }
  }
}

/// The factor that a refusal tells; 0 if there is none.
double told_factor(const std::string& error) {
  const std::string before = "buckles, at some ";
  const std::size_t at = error.find(before);
  return at == std::string::npos ? 0.0 : std::stod(error.substr(at + before.size()));
}

std::string with(std::string text, const std::string& place, const std::string& more) {
  return text.replace(text.find(place), place.size(), more + place);
}

/// In frames it is that of the whole.
TEST(ElasticStability, TheLoadOfBucklingIsThatOfDividedBeams) {
  const double euler = 0.25 * std::numbers::pi * std::numbers::pi * stiffness;
  EXPECT_THAT(error_of(with(beam(clamp, -1.5 * euler, 0.0), R"("elements":)", R"("frames": 4, )")),
              HasSubstr("buckles, at some 0.667 of"));
}

std::string text_of(const Eigen::Vector3d& vector) {
  return fmt::format("[{}, {}, {}]", vector(0), vector(1), vector(2));
}

/// A clamped column that stands along one axis, thin along another one, under so many times the weight
/// that buckles it, q L³/EI = 7.837 (Timoshenko & Gere, Theory of Elastic Stability, art. 2.12). A
/// force across says which plane it moves in. Its frame turns with it, and so with its weight.
std::string heavy_column(const Eigen::Vector3d& up, const Eigen::Vector3d& across, double share) {
  const double weight = share * 7.837 * stiffness / (7850 * width * height);
  return fmt::format(R"({{"scene": {{
      "materials": {{"m": {{"young": 2.1e11, "poisson": 0.3, "density": 7850}}}},
      "bodies": {{"b": {{"type": "beam", "from": [0, 0, 0], "to": {0}, "reference": {1},
                       "section": {{"type": "rectangle", "width": 0.02, "height": 0.002}},
                       "material": "m", "elements": 8, "frame": "chord"}}}},
      "joints": {{"c": {{"type": "fixed", "bodies": ["ground", "b"], "at": [0, 0, 0]}}}},
      "loads": {{"w": {{"type": "force", "body": "b", "at": {0}, "direction": {1}, "value": 1e-6}}}},
      "gravity": {2}}},
      "effects": {{"spatial_motion": "off"}},
      "simulation": {{"end_time": 0.001, "step": 0.001, "initial_state": "quasi-static"}},
      "responses": {{
        "x": {{"type": "position", "body": "b", "at": 1, "direction": "x", "over_time": "final"}},
        "y": {{"type": "position", "body": "b", "at": 1, "direction": "y", "over_time": "final"}}}}}})",
                     text_of(up), text_of(across), text_of(-weight * up));
}

/// In every plane of motion.
TEST(ElasticStability, TheLoadOfBucklingUnderWeightIsThatOfEveryPlane) {
  const Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  for (const int up : {0, 1, 2}) {
    for (const int across : {(up + 1) % 3, (up + 2) % 3}) {
      const auto error = [&](double share) {
        return error_of(heavy_column(axes.col(up), axes.col(across), share));
      };
      EXPECT_EQ(error(0.98), "") << up << across;
      EXPECT_NEAR(told_factor(error(2.0)), 0.5, 0.005) << up << across;
    }
  }
}

}  // namespace
}  // namespace pleuel::test::buckling_load_test
