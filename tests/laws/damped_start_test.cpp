#include "core/integration/damped_start.hpp"

#include <algorithm>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/laws/law_gradients.hpp"
#include "tests/laws/law_problems.hpp"
#include "tests/support/convergence.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/parameter_name.hpp"

namespace pleuel::test::damped_start_test {
namespace {

/// A rod of steel, hinged at one end, that is let go while it lies undeformed: gravity acts on it
/// all at once. Its height is the variable.
ProblemFile released_rod(const std::vector<std::string>& overrides = {}) {
  return read_problem_text(R"({
  "scene": {
    "gravity": [0, -9.81, 0],
    "bodies": {"rod": {"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "steel",
      "section": {"type": "rectangle", "width": 0.02, "height": {"variable": "height"}}, "elements": 8, "frame": "chord", "damping": {"stiffness": 1e-3}}},
    "joints": {"hinge": {"type": "revolute", "bodies": ["ground", "rod"], "at": [0, 0, 0]}}
  },
  "simulation": {"end_time": 0.1, "step": 2e-3},
  "variables": {"height": {"start": 0.02, "lower": 0.01, "upper": 0.1}},
  "responses": {
    "stress": {"type": "stress", "body": "rod", "over_time": "max"},
    "reaction": {"type": "reaction-force", "joint": "hinge", "direction": "magnitude", "over_time": "max"},
    "speed": {"type": "velocity", "body": "rod", "at": 1, "direction": "y", "over_time": "rms"}
  },
  "objective": {"minimize": "stress"}
})",
                           "rod.json", overrides)
      .complete();
}

/// The stress is that of steps four times as short, whatever the mesh and the scheme: 27 steps for
/// a period of the first vibration take up to 1 % for themselves. What a step makes of
/// accelerations that last for far less gave up to sixty times as much.
TEST(DampedStart, DoesNotRingWhateverTheMeshAndTheDampingOfTheScheme) {
  const double fine = value_at_start(released_rod({"/simulation/step=0.125 ms"}), "stress");
  for (const int elements : {4, 16, 64}) {
    for (const char* radius : {"0", "0.5", "0.8", "1"}) {
      for (const char* formulation : {"index-3", "index-1"}) {
        if (elements == 16 && std::string(formulation) == "index-1") continue;
        const ProblemFile problem = released_rod(
            {"/simulation/step=0.5 ms", fmt::format("/scene/bodies/rod/elements={}", elements),
             fmt::format("/simulation/spectral_radius={}", radius),
             fmt::format("/simulation/formulation={}", formulation)});
        EXPECT_NEAR(value_at_start(problem, "stress") / fine, 1.0, 0.02)
            << elements << " elements, radius " << radius << ", " << formulation;
      }
    }
  }
}

/// Without damping that is stiff in a step, the start is that of the equations.
TEST(DampedStart, TakesTheAccelerationsOfTheEquationsWhereTheStepResolvesTheDamping) {
  const ProblemFile problem =
      released_rod({"/scene/bodies/rod/elements=1", "/scene/bodies/rod/damping/stiffness=1e-4",
                    "/effects/axial_elasticity=off"});
  const auto analysis = analyze(problem, start_design(problem));
  State start;
  analysis->trajectory.states->load(0, start);
  const DampedStart gentle(analysis->model.mechanism, start, generalized_alpha(8e-6, 0.5), 0.0);
  EXPECT_EQ(gentle.a(), start.a);
  const ProblemFile stiff = released_rod({"/scene/bodies/rod/elements=32"});
  const auto other = analyze(stiff, start_design(stiff));
  other->trajectory.states->load(0, start);
  const DampedStart damped(other->model.mechanism, start, generalized_alpha(2e-3, 0.5), 0.0);
  EXPECT_LT(damped.a().lpNorm<Eigen::Infinity>(), 0.1 * start.a.lpNorm<Eigen::Infinity>());
}

/// Reactions from the first step on, where the start rings but the steps are short enough to see
/// it.
class ReactionsOfASuddenStart : public testing::TestWithParam<const char*> {};

TEST_P(ReactionsOfASuddenStart, AreOfSecondOrderFromTheFirstStepOn) {
  const auto run = [](int steps) {
    return [steps](const std::string& formulation) {
      const ProblemFile problem = released_rod(
          {"/scene/bodies/rod/elements=1", "/scene/bodies/rod/damping/stiffness=1e-4",
           "/effects/axial_elasticity=off", "/simulation/end_time=4e-3",
           "/simulation/newton_tolerance=1e-13", "/simulation/formulation=" + formulation,
           fmt::format("/simulation/step={:.17g}", 4e-3 / steps)});
      return Eigen::MatrixXd(
          analyze(problem, start_design(problem))->trajectory.columns().lambda());
    };
  };
  const int reference_steps = 3200;
  const Eigen::MatrixXd reference = run(reference_steps)(GetParam());
  std::vector<double> sizes, errors, first;
  for (const int steps : {200, 400, 800}) {
    const Eigen::MatrixXd lambda = run(steps)(GetParam());
    const int ratio = reference_steps / steps;
    double worst = 0.0;
    for (int i = 1; i <= steps; ++i) {
      const double error = (lambda.col(i) - reference.col(i * ratio)).norm();
      if (i == 1) first.push_back(error);
      worst = std::max(worst, error);
    }
    sizes.push_back(1.0 / steps);
    errors.push_back(worst);
  }
  EXPECT_GE(observed_order(sizes, errors), 1.8);
  EXPECT_GE(observed_order(sizes, first), 1.8);
}

INSTANTIATE_TEST_SUITE_P(Formulations, ReactionsOfASuddenStart,
                         testing::Values("index-3", "stabilized-index-2", "index-1"),
                         [](const auto& test) {
                           std::string name = test.param;
                           std::erase(name, '-');
                           return name;
                         });

class GradientOfADampedStart : public testing::TestWithParam<std::vector<std::string>> {};

TEST_P(GradientOfADampedStart, IsThatOfItsSimulation) {
  std::vector<std::string> overrides = {"/simulation/newton_tolerance=1e-13",
                                        "/simulation/end_time=20 ms"};
  overrides.insert(overrides.end(), GetParam().begin(), GetParam().end());
  const ProblemFile problem = released_rod(overrides);
  const auto [direct, adjoint, expected] = law_gradients(problem);
  for (Eigen::Index i = 0; i < expected.rows(); ++i) {
    EXPECT_NEAR(adjoint(i, 0), direct(i, 0), 1e-10 * std::abs(direct(i, 0)));
    EXPECT_NEAR(direct(i, 0), expected(i, 0), 1e-6 * std::abs(expected(i, 0))) << i;
  }
}

using Overrides = std::vector<std::string>;
INSTANTIATE_TEST_SUITE_P(Schemes, GradientOfADampedStart,
                         testing::Values(Overrides{}, Overrides{"/simulation/spectral_radius=0"},
                                         Overrides{"/simulation/formulation=stabilized-index-2"},
                                         Overrides{"/simulation/formulation=index-1"},
                                         Overrides{"/simulation/scheme=newmark"},
                                         Overrides{"/simulation/scheme=implicit-euler"},
                                         Overrides{"/effects/spatial_motion=on"}),
                         named_as_printed());

}  // namespace
}  // namespace pleuel::test::damped_start_test
