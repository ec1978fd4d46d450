#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "core/linear/modes.hpp"
#include "core/response/analysis.hpp"
#include "core/scene/problem_reader.hpp"
#include "core/trust/frequency_meaning.hpp"
#include "core/trust/model_variants.hpp"
#include "core/trust/stability.hpp"
#include "tests/core/trust/findings_of.hpp"

namespace pleuel::test::turning_axes_test {
namespace {

/// A steel blade of 1 m × 20 mm × 30 mm that turns at 50 rad/s about its clamped end.
ProblemFile blade(const std::string& frame, double speed = 50.0) {
  return read_problem_text(fmt::format(R"({{"scene": {{
          "materials": {{"m": {{"young": 2.1e11, "poisson": 0.3, "density": 7850}}}},
          "bodies": {{"b": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "m",
            "section": {{"type": "rectangle", "width": 0.02, "height": 0.03}}, "elements": 6, {}}}}},
          "joints": {{"d": {{"type": "revolute", "bodies": ["ground", "b"], "at": [0, 0, 0],
            "drive": {{"type": "constant-speed", "speed": {}}}}}}}}},
        "simulation": {{"end_time": 1e-3, "step": 1e-4, "initial_state": "quasi-static"}},
        "responses": {{"flap": {{"type": "frequency", "mode": 1}},
                       "lag": {{"type": "frequency", "mode": 2}}}}}})",
                                       frame, speed),
                           "blade.json")
      .complete();
}

Eigen::VectorXd frequencies(const Analysis& analysis) {
  const Mechanism& mechanism = model_of_modes(analysis).mechanism;
  const State& state = analysis.vibrating->initial.state;
  return frequencies_of(linearize(mechanism, state, turning_of(mechanism, state), false));
}

/// Southwell: flapping ω₀² + 1.193 Ω² (Wright et al. 1982 to Ω = ω₀: 1.193 within 0.2 %), lagging
/// less Ω². With any frame of the body, which is only another choice of coordinates.
TEST(TurningAxes, GiveARotatingBeamItsFrequenciesInAnyFrame) {
  const double mass = 7850 * 0.02 * 0.03, young = 2.1e11, square = 50.0 * 50.0;
  const double flap = 3.5160 * 3.5160 * young * 0.03 * std::pow(0.02, 3) / 12 / mass;
  const double lag = 3.5160 * 3.5160 * young * 0.02 * std::pow(0.03, 3) / 12 / mass;
  for (const char* frame :
       {R"("frame": "tangent")", R"("frame": "chord")", R"("frame": "mean-axis")",
        R"("frame": "tangent-end")", R"("frames": 2)"}) {
    const ProblemFile problem = blade(frame);
    const auto analysis = analyze(problem, start_design(problem));
    const Eigen::VectorXd found = frequencies(*analysis);
    EXPECT_NEAR(found(0), std::sqrt(flap + 1.193 * square), 0.003 * found(0)) << frame;
    EXPECT_NEAR(found(1), std::sqrt(lag + 0.193 * square), 0.003 * found(1)) << frame;
  }
}

TEST(TurningAxes, LeaveTheFrequenciesOfAMechanismAtRest) {
  const ProblemFile problem = blade(R"("frame": "chord")", 0.0);
  const auto analysis = analyze(problem, start_design(problem));
  const Eigen::VectorXd found = frequencies(*analysis);
  EXPECT_NEAR(found(0), analysis->mechanism_frequencies(0), 1e-9 * found(0));
  EXPECT_NEAR(found(5), analysis->mechanism_frequencies(5), 1e-9 * found(5));
}

TEST(Frequencies, AreDoubtedWhereTheAxesMatter) {
  const auto findings = [](const ProblemFile& problem) {
    const Eigen::VectorXd x = start_design(problem);
    const auto analysis = analyze(problem, x);
    return check_frequencies({problem, x, *analysis, Monitors{}});
  };
  EXPECT_TRUE(findings(blade(R"("frame": "tangent")")).empty());
  EXPECT_TRUE(findings(blade(R"("frame": "chord")", 0.0)).empty());
  const std::vector<Finding> found = findings(blade(R"("frame": "chord")"));
  ASSERT_EQ(found.size(), 1u);  // all frequencies in one sentence
  EXPECT_TRUE(found[0].is_serious);
  EXPECT_NE(found[0].text.find("\"flap\" is "), std::string::npos);
  EXPECT_NE(found[0].text.find("faster or slower by the speed, "), std::string::npos);
}

/// A column under a force that follows its free end flutters from 20.05 EI/L² on (Beck 1952).
TEST(Frequencies, AreDoubtedWhereAFollowerForceMakesThemGrow) {
  const auto findings = [](double load) {
    const double stiffness = 2.1e11 * 0.013 * std::pow(0.01, 3) / 12;
    const ProblemFile problem = read_problem_text(fmt::format(R"({{"scene": {{
          "materials": {{"m": {{"young": 2.1e11, "poisson": 0.3, "density": 7850}}}},
          "bodies": {{"b": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "m",
            "section": {{"type": "rectangle", "width": 0.01, "height": 0.013}}, "elements": 8}}}},
          "joints": {{"f": {{"type": "fixed", "bodies": ["ground", "b"], "at": [0, 0, 0]}}}},
          "loads": {{"p": {{"type": "force", "body": "b", "at": [1, 0, 0], "follows": true,
            "direction": [-1, 0, 0], "value": {}}}}}}},
        "simulation": {{"end_time": 1e-3, "step": 1e-4, "initial_state": "quasi-static"}},
        "responses": {{"first": {{"type": "frequency"}}}}}})",
                                                              load * stiffness),
                                                  "beck.json")
                                    .complete();
    const Eigen::VectorXd x = start_design(problem);
    const auto analysis = analyze(problem, x);
    return check_stability({problem, x, *analysis, Monitors{}});
  };
  EXPECT_TRUE(findings(20.0).empty());
  const std::vector<Finding> found = findings(20.15);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NE(found[0].text.find("(flutter)"), std::string::npos) << found[0].text;
}

/// A cantilever that a moment at its tip bends by 0.084 rad. Counted in a frame at the free end its
/// fourth frequency is 2.6 % below that of six frames along it, where rotations are small.
TEST(Frequencies, AreDoubtedWhereMoreFramesChangeThem) {
  const auto bent = [](const char* from, const char* to, int frames) {
    return read_problem_text(fmt::format(R"({{"scene": {{"gravity": [0, 0, 0],
          "materials": {{"m": {{"young": 2.1e11, "poisson": 0.3, "density": 7850}}}},
          "bodies": {{"b": {{"type": "beam", "from": {0}, "to": {1}, "material": "m",
            "section": {{"type": "rectangle", "width": 0.008, "height": 0.016}}, "elements": 6,
            "frames": {2}}}}},
          "joints": {{"wall": {{"type": "fixed", "bodies": ["ground", "b"], "at": [0, 0, 0]}}}},
          "loads": {{"moment": {{"type": "torque", "body": "b", "at": [0.6, 0, 0],
                               "direction": [0, 1, 0], "value": 20}}}}}},
        "simulation": {{"end_time": 1e-3, "step": 5e-4, "initial_state": "quasi-static"}},
        "responses": {{"first": {{"type": "frequency", "mode": 1}},
                      "fourth": {{"type": "frequency", "mode": 4}}}}}})",
                                         from, to, frames),
                             "bent.json")
        .complete();
  };
  const char *wall = "[0, 0, 0]", *tip = "[0.6, 0, 0]";
  const auto fourth = [](const ProblemFile& problem) {
    return values_of(*analyze(problem, start_design(problem)))(1);
  };
  const double divided = fourth(bent(wall, tip, 6));
  EXPECT_NEAR(fourth(bent(wall, tip, 1)), divided, 0.003 * divided);
  EXPECT_NEAR(fourth(bent(tip, wall, 1)), 0.974 * divided, 0.002 * divided);
  const auto left_out = [](const TrustedRun& run) { return compare_variants(run).findings; };
  EXPECT_TRUE(findings_of(bent(wall, tip, 1), left_out).empty());
  EXPECT_TRUE(findings_of(bent(wall, tip, 6), left_out).empty());
  const std::vector<Finding> findings = findings_of(bent(tip, wall, 1), left_out);
  ASSERT_EQ(findings.size(), 1);
  EXPECT_EQ(findings[0].responses, std::vector<std::string>{"fourth"});
}

}  // namespace
}  // namespace pleuel::test::turning_axes_test
