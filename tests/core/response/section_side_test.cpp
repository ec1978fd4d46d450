#include <stdexcept>
#include <tuple>

#include "core/base/eager_matrices.hpp"
#include "core/response/monitors.hpp"
#include "core/trust/round_off.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/test.hpp"

/// Section forces on both sides of a load.
namespace pleuel::test::section_side_test {
namespace {

/// A light beam on two supports with a force F upwards at 0.4 of its length: the shear force of the
/// part behind a section on the part before it is +0.6 F before the load and −0.4 F behind it; the
/// moment there is 0.24 F L, and nothing at the pins.
ProblemFile supported_beam(const std::string& responses, int frames = 1, double force = 100.0) {
  return problem_from(fmt::format(R"j({{"scene": {{"gravity": [0, 0, 0],
    "materials": {{"light": {{"young": "200 GPa", "poisson": 0.3, "density": 1}}}},
    "bodies": {{"bar": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "elements": 5,
      "material": "light", "frames": {},
      "section": {{"type": "rectangle", "width": {{"variable": "width"}}, "height": "20 mm"}}}}}},
    "joints": {{"pin": {{"type": "revolute", "bodies": ["ground", "bar"], "at": [0, 0, 0]}},
               "roller": {{"type": "point-on-line", "bodies": ["ground", "bar"], "at": [1, 0, 0],
                          "axis": [1, 0, 0]}}}},
    "loads": {{"push": {{"type": "force", "body": "bar", "at": [0.4, 0, 0],
                         "direction": [0, 1, 0], "value": {}}}}}}},
  "effects": {{"geometric_stiffening": "off"}},
  "simulation": {{"end_time": "10 ms", "step": "1 ms", "initial_state": "quasi-static"}},
  "variables": {{"width": {{"start": "20 mm", "lower": "10 mm", "upper": "40 mm"}}}},
  "objective": {{"minimize": "m"}},
  "responses": {{"m": {{"type": "mass"}}, {}}}}})j",
                                  frames, force, responses));
}

double value_of(const Analysis& analysis, const std::string& name) {
  for (std::size_t i = 0; i < analysis.responses.size(); ++i) {
    if (analysis.responses[i].name == name) return analysis.reductions[i].value;
  }
  throw std::logic_error("no response " + name);
}

double of_shear(const std::string& over_time, const std::string& side = "", int frames = 1) {
  const std::string more = side.empty() ? "" : fmt::format(R"(, "side": "{}")", side);
  const ProblemFile problem =
      supported_beam(fmt::format(R"("s": {{"type": "section-force", "body": "bar", "at": 0.4,
                           "part": "shear-y", "over_time": "{}"{}}})",
                                 over_time, more),
                     frames);
  return value_of(*analyze(problem, start_design(problem)), "s");
}

/// 1e-3 N: vibrations about the equilibrium.
TEST(SectionSides, AreBothInPeaksAndTheLargerMagnitudeElsewhere) {
  EXPECT_NEAR(std::abs(of_shear("max") - of_shear("min")), 100.0, 1e-2);
  EXPECT_NEAR(of_shear("max-abs"), 60.0, 1e-2);
  const double larger = of_shear("max") > 50.0 ? 60.0 : -60.0;
  for (const char* over_time : {"final", "mean"}) {
    EXPECT_NEAR(of_shear(over_time), larger, 1e-2) << over_time;
  }
  EXPECT_NEAR(of_shear("integral"), 0.01 * larger, 1e-4);
}

/// The same beam in two frames that meet at the load, too.
TEST(SectionSides, CanBeChosen) {
  const double before = of_shear("final", "before"), behind = of_shear("final", "behind");
  EXPECT_NEAR(std::abs(before), 60.0, 1e-2);
  EXPECT_NEAR(behind / before, -40.0 / 60.0, 1e-3);
  for (const char* over_time : {"max", "min", "mean"}) {
    EXPECT_NEAR(of_shear(over_time, "before"), before, 1e-2);
    EXPECT_NEAR(of_shear(over_time, "behind"), behind, 1e-2);
  }
}

/// Judged beside the moment in the middle, 24 N mm. A larger force tilts the supports by its deflection,
/// squared: that is no round-off.
TEST(SectionForces, ThatVanishAreRoundOff) {
  std::string responses;
  for (const auto& [name, place, part] : {std::tuple{"a", 0.0, "moment-z"},
                                          {"b", 1.0, "moment-z"},
                                          {"c", 0.4, "axial"},
                                          {"d", 0.4, "moment-z"},
                                          {"e", 0.9, "shear-y"}}) {
    responses += fmt::format(
        R"({}"{}": {{"type": "section-force", "body": "bar", "at": {}, "part": "{}",
                     "over_time": "max-abs"}})",
        responses.empty() ? "" : ", ", name, place, part);
  }
  responses += R"(, "f": {"type": "stress", "body": "bar", "at": 1, "over_time": "max"},
                    "g": {"type": "stress", "body": "bar", "at": 0.5, "over_time": "max"})";
  const ProblemFile problem = supported_beam(responses, 1, 0.1);
  const Eigen::VectorXd x = start_design(problem);
  const auto analysis = analyze(problem, x);
  const Monitors monitors = monitor(analysis->model, analysis->trajectory);
  EXPECT_EQ(find_round_off(TrustedRun{problem, x, *analysis, monitors}),
            (std::vector<bool>{false, true, true, true, false, false, true, false}));
}

}  // namespace
}  // namespace pleuel::test::section_side_test
