#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/start/elastic_stability.hpp"
#include "tests/core/start/quasi_static_beam.hpp"

/// At what share of their loads members buckle, as it is told.
namespace pleuel::test::buckling_load_test {
namespace {

using namespace quasi_static_beam;
using testing::HasSubstr;

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

/// Divided into frames, and under its own weight: q L³/EI = 7.837 (Timoshenko & Gere, Theory of Elastic
/// Stability, art. 2.12).
TEST(ElasticStability, TheLoadOfBucklingIsThatOfDividedBeamsAndOfWeight) {
  const auto with = [](std::string text, const std::string& place, const std::string& more) {
    return text.replace(text.find(place), place.size(), more + place);
  };
  const double euler = 0.25 * std::numbers::pi * std::numbers::pi * stiffness;
  EXPECT_THAT(error_of(with(beam(clamp, -1.5 * euler, 0.0), R"("elements":)", R"("frames": 4, )")),
              HasSubstr("buckles, at some 0.667 of"));
  const double weight = 2.0 * 7.837 * stiffness / (7850 * width * height);
  const std::string text = error_of(with(beam(clamp, 0.0, 0.0), R"("materials":)",
                                         fmt::format(R"("gravity": [{}, 0, 0], )", -weight)));
  const std::string before = "buckles, at some ";
  ASSERT_THAT(text, HasSubstr(before));
  EXPECT_NEAR(std::stod(text.substr(text.find(before) + before.size())), 0.5, 0.005);
}

}  // namespace
}  // namespace pleuel::test::buckling_load_test
