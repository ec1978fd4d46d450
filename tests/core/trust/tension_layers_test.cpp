#include "core/trust/tension_layers.hpp"

#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/core/trust/findings_of.hpp"

/// A wire of 2 mm, clamped at one end, pulled and pushed across at the other.
namespace pleuel::test::tension_layers_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

ProblemFile wire(double pull, double across, int elements, const std::string& type = "stress") {
  return read_scene(fmt::format(
      R"j({{"scene": {{"gravity": [0, 0, 0],
        "materials": {{"steel": {{"young": 2.1e11, "poisson": 0.3, "density": 7850}}}},
        "bodies": {{"wire": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "elements": {},
                             "material": "steel", "frame": "tangent",
                             "section": {{"type": "circle", "diameter": 0.002}}}}}},
        "joints": {{"wall": {{"type": "fixed", "bodies": ["ground", "wire"], "at": [0, 0, 0]}}}},
        "loads": {{"pull": {{"type": "force", "body": "wire", "at": [1, 0, 0],
                            "direction": [1, 0, 0], "value": {}}},
                  "across": {{"type": "force", "body": "wire", "at": [1, 0, 0],
                              "direction": [0, -1, 0], "value": {}}}}}}},
      "simulation": {{"end_time": 0.01, "step": 0.005, "initial_state": "quasi-static"}},
      "responses": {{"s": {{"type": "{}", "body": "wire", "over_time": "max"}}}}}})j",
      elements, pull, across, type));
}

/// N/A + F tanh(kL)/k · c/I with k = √(N/EI) = 78/m: 645 MPa. Elements of 250 mm see 336 MPa of it,
/// and twice as many no more; those of 13 mm, 1/k, are judged by their own refinement.
TEST(TautMembers, AreDoubtedWhereElementsAreLongerThanBendingReaches) {
  const double pi = std::numbers::pi, inertia = pi * 1e-12 / 4, area = pi * 1e-6;
  const double k = std::sqrt(1000.0 / (2.1e11 * inertia));
  const double stress = 1000.0 / area + 20.0 * std::tanh(k) / k * 1e-3 / inertia;
  const ProblemFile coarse = wire(1000.0, 20.0, 4);
  const auto analysis = analyze(coarse, start_design(coarse));
  EXPECT_LT(analysis->reductions[0].value, 0.6 * stress);
  const std::vector<Finding> findings = findings_of(coarse, check_tension_layers);
  ASSERT_THAT(findings, SizeIs(1));
  EXPECT_TRUE(findings[0].is_serious);
  EXPECT_THAT(findings[0].text, HasSubstr("under a pull of 1e+03 N it bends within some 0.013 m"));
  EXPECT_THAT(findings[0].responses, ElementsAre("s"));
  EXPECT_THAT(findings_of(wire(1000.0, 20.0, 80), check_tension_layers), IsEmpty());
}

TEST(TautMembers, AreNotDoubtedWhereBendingDoesNotCount) {
  EXPECT_THAT(findings_of(wire(1000.0, 0.0, 4), check_tension_layers), IsEmpty());
  EXPECT_THAT(findings_of(wire(-0.1, 0.01, 4), check_tension_layers), IsEmpty());
  EXPECT_THAT(findings_of(wire(1000.0, 20.0, 4, "elastic-energy"), check_tension_layers),
              IsEmpty());
  EXPECT_THAT(
      findings_of(wire(1000.0, 20.0, 4, R"(stress", "part": "axial)"), check_tension_layers),
      IsEmpty());
}

}  // namespace
}  // namespace pleuel::test::tension_layers_test
