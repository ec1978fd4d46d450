#include "core/start/equilibrium.hpp"

#include <limits>

#include "core/base/eager_matrices.hpp"
#include "core/mechanism/mechanism.hpp"
#include "sensitivity/gradients.hpp"
#include "sensitivity/initial_sensitivity.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/sample_name.hpp"
#include "tests/support/sample_scenes.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::equilibrium_test {
namespace {

constexpr double length = 1.0, width = 0.02, height = 0.03, young = 2.1e11, density = 7850,
                 gravity = 9.81;

/// A cantilever under its own weight; its height is the design variable.
ProblemFile cantilever(bool is_quasi_static) {
  ProblemFile problem;
  problem.scene = swinging_beam(length, RectangleSection{width, Number::bound(0)}, 4);
  problem.scene.joints[0].type = JointType::fixed;
  problem.variables = {{"height", height, 0.01, 0.1, ""}};
  problem.simulation.end_time = 0.1;
  problem.simulation.step = 1e-3;
  problem.simulation.quasi_static_start = is_quasi_static;
  for (OverTime over_time : {OverTime::max, OverTime::min}) {
    ResponseSettings tip;
    tip.name = over_time == OverTime::max ? "highest" : "lowest";
    tip.type = ResponseType::deflection;
    tip.bodies = {"beam"};
    tip.at = 1.0;
    tip.over_time = over_time;
    problem.responses.push_back(tip);
  }
  return problem;
}

/// At rest it stays at qL⁴/8EI; without the equilibrium it swings between nothing and twice that.
TEST(QuasiStaticStart, KeepsACantileverAtRestUnderItsWeight) {
  const double stiffness = young * width * std::pow(height, 3) / 12;
  const double sag = -density * width * height * gravity * std::pow(length, 4) / (8 * stiffness);
  const ProblemFile resting = cantilever(true), ringing = cantilever(false);
  const Eigen::VectorXd at_rest = values_of(*analyze(resting, start_design(resting)));
  const Eigen::VectorXd swinging = values_of(*analyze(ringing, start_design(ringing)));
  EXPECT_NEAR(at_rest(0), sag, 1e-6 * std::abs(sag));  // stiffening by the fall of the tip: 1e-7
  EXPECT_NEAR(at_rest(1), sag, 1e-6 * std::abs(sag));
  EXPECT_GT(swinging(0), 0.1 * sag);
  EXPECT_LT(swinging(1), 1.8 * sag);
}

/// qL⁴/8EI falls with the square of the height.
TEST(QuasiStaticStart, HasTheGradientOfTheSag) {
  const ProblemFile problem = cantilever(true);
  const auto analysis = analyze(problem, start_design(problem));
  const Eigen::MatrixXd gradient = direct_gradients(*analysis);
  const double expected = -2 * analysis->reductions[0].value / height;
  EXPECT_NEAR(gradient(0, 0), expected, 1e-6 * std::abs(expected));
}

/// A clamp that is there twice: the second follows from the first, and the beam starts as with one;
/// each carries half of its weight.
TEST(QuasiStaticStart, OfARedundantMechanismIsThatOfTheSameWithoutRedundancy) {
  ProblemFile once = cantilever(true), twice = once;
  Joint again = once.scene.joints[0];
  again.name = "again";
  twice.scene.joints.push_back(again);
  for (ProblemFile* problem : {&once, &twice}) {
    problem->effects.spatial_motion = EffectChoice::on;
    ResponseSettings reaction;
    reaction.type = ResponseType::reaction_force;
    reaction.joint = problem->scene.joints[0].name;
    reaction.direction = 1;
    reaction.over_time = OverTime::mean;
    problem->responses.push_back(reaction);
  }
  const auto found = analyze(twice, start_design(twice)),
             expected = analyze(once, start_design(once));
  EXPECT_EQ(found->model.mechanism.system->left_out().size(), 6u);
  Eigen::VectorXd share = Eigen::VectorXd::Ones(3);
  share(2) = 0.5;
  const Eigen::VectorXd values = values_of(*found),
                        same = share.asDiagonal() * values_of(*expected);
  EXPECT_LE((values - same).norm(), 1e-10 * same.norm());
  const Eigen::MatrixXd gradient = direct_gradients(*found),
                        same_gradient = share.asDiagonal() * direct_gradients(*expected);
  EXPECT_LE((gradient - same_gradient).norm(), 1e-9 * same_gradient.norm());
}

class EquilibriumOfASample : public testing::TestWithParam<int> {
 protected:
  SampleScene sample_ = all_samples()[GetParam()];
  Model build_at(const Design<double>& design) const {
    Model model = sample_.build_at(design);
    model.mechanism.starts_in_equilibrium = true;
    return model;
  }
};

TEST_P(EquilibriumOfASample, HasNoElasticAccelerationAndMeetsAllEquations) {
  Model model = build_at(sample_.design);
  Mechanism& mechanism = model.mechanism;
  const State state = initial_state(mechanism).state;
  const double largest = state.a.lpNorm<Eigen::Infinity>();
  ASSERT_GT(largest, 0.0);
  for (int i : mechanism.elastic) EXPECT_LE(std::abs(state.a(i)), 1e-9 * largest);
  const int m = mechanism.system->multipliers();
  Eigen::VectorXd residual;
  mechanism.system->residual(state, ConstraintLevel::acceleration, residual);
  EXPECT_LE(residual.lpNorm<Eigen::Infinity>(), 1e-9 * (largest + state.lambda.norm()));
  for (auto level : {ConstraintLevel::position, ConstraintLevel::velocity}) {
    mechanism.system->residual(state, level, residual);
    EXPECT_LE(residual.tail(m).lpNorm<Eigen::Infinity>(), 1e-11);
  }
}

TEST_P(EquilibriumOfASample, IsDifferentiated) {
  Model model = build_at(sample_.design);
  const InitialState initial = initial_state(model.mechanism);
  const StateSensitivity s = initial_sensitivity(model.mechanism, initial);
  for (int j = 0; j < model.mechanism.system->variables(); ++j) {
    const auto index = static_cast<std::size_t>(j);
    const double x = sample_.design[index];
    const auto parts = [&](double step) -> Eigen::VectorXd {
      auto design = sample_.design;
      design[index] += step;
      Model moved = build_at(design);
      State state = initial_state(moved.mechanism).state;
      Eigen::VectorXd all(2 * state.q.size() + state.lambda.size());
      all << difference(model.mechanism.rotations, state.q, initial.state.q), state.v, state.lambda;
      return all;
    };
    const Eigen::VectorXd expected = derivative_at_zero(parts, 3e-3 * std::abs(x));
    Eigen::VectorXd found(expected.size());
    found << s.q.col(j), s.v.col(j), s.lambda.col(j);
    const auto n = initial.state.q.size();
    const auto expect_part = [&](Eigen::Index first, Eigen::Index size, double at,
                                 const char* what) {
      // What differences leave of a velocity that is zero, 2e-317, is denormal and has no digits.
      const double scale = std::max({expected.segment(first, size).lpNorm<Eigen::Infinity>(),
                                     at / std::abs(x), std::numeric_limits<double>::min()});
      const double error = (found - expected).segment(first, size).lpNorm<Eigen::Infinity>();
      EXPECT_LE(error, 1e-6 * scale) << what << ", variable " << sample_.variables[index];
    };
    expect_part(0, n, initial.state.q.lpNorm<Eigen::Infinity>(), "q");
    expect_part(n, n, initial.state.v.lpNorm<Eigen::Infinity>(), "v");
    expect_part(2 * n, initial.state.lambda.size(), initial.state.lambda.lpNorm<Eigen::Infinity>(),
                "lambda");
  }
}

/// The pattern is analysed at the first iteration, where nothing is deformed, moves or is loaded.
TEST_P(EquilibriumOfASample, HasOnePatternOfItsJacobian) {
  Model model = build_at(sample_.design);
  Mechanism& mechanism = model.mechanism;
  const int n = mechanism.system->coordinates(), m = mechanism.system->multipliers();
  const InitialState rest{State(n, m), Eigen::VectorXd::Zero(m), Eigen::VectorXd::Zero(m)};
  const Equilibrium equilibrium(mechanism);
  const Eigen::SparseMatrix<double> at_rest = equilibrium.jacobian(rest),
                                    loaded = equilibrium.jacobian(initial_state(mechanism));
  ASSERT_EQ(at_rest.nonZeros(), loaded.nonZeros());
  const auto same = [&](const int* a, const int* b, Eigen::Index size) {
    return std::equal(a, a + size, b);
  };
  EXPECT_TRUE(same(at_rest.outerIndexPtr(), loaded.outerIndexPtr(), at_rest.outerSize() + 1));
  EXPECT_TRUE(same(at_rest.innerIndexPtr(), loaded.innerIndexPtr(), at_rest.nonZeros()));
}

INSTANTIATE_TEST_SUITE_P(Samples, EquilibriumOfASample, testing::Values(0, 2), sample_name);

/// Two bars between hinges 1 m apart, 20 mm flat, pressed down where they meet. With the height y left,
/// they bear P = 2 EA (L₀ − L)/L₀ · y/L, at most some 3651 N. Flat, they would be in line with nothing to
/// bear the load; with shares of four elements Newton's method ends there.
std::string flat_truss(double load) {
  return fmt::format(
      R"({{"scene": {{"gravity": [0, 0, 0],
        "materials": {{"steel": {{"young": 2.1e11, "poisson": 0.3, "density": 7850}}}},
        "bodies": {{
          "l": {{"type": "beam", "from": [-0.5, 0, 0], "to": [0, 0.02, 0], "material": "steel",
                "section": {{"type": "circle", "diameter": 0.03}}, "elements": 4, "frame": "chord"}},
          "r": {{"type": "beam", "from": [0.5, 0, 0], "to": [0, 0.02, 0], "material": "steel",
                "section": {{"type": "circle", "diameter": 0.03}}, "elements": 4,
                "frame": "chord"}}}},
        "joints": {{
          "a": {{"type": "revolute", "bodies": ["ground", "l"], "at": [-0.5, 0, 0]}},
          "c": {{"type": "revolute", "bodies": ["ground", "r"], "at": [0.5, 0, 0]}},
          "t": {{"type": "revolute", "bodies": ["l", "r"], "at": [0, 0.02, 0]}}}},
        "loads": {{"f": {{"type": "force", "body": "l", "at": [0, 0.02, 0],
                         "direction": [0, -1, 0], "value": {}}}}}}},
      "simulation": {{"end_time": 0.001, "step": 0.0005, "initial_state": "quasi-static"}},
      "responses": {{"y": {{"type": "position", "body": "l", "at": 1, "direction": "y",
                          "over_time": "min"}}}}}})",
      load);
}

TEST(QuasiStaticStart, IsNotFoundAtADeadPoint) {
  const double L0 = std::hypot(0.5, 0.02), stiffness = 2.1e11 * std::numbers::pi * 0.015 * 0.015;
  const auto borne = [&](double y) {
    const double L = std::hypot(0.5, y);
    return 2 * stiffness * (L0 - L) / L0 * y / L;
  };
  double most = 0.0;
  for (int i = 0; i <= 1000; ++i) most = std::max(most, borne(0.02 * i / 1000));
  EXPECT_NEAR(most, 3650.8, 0.1);
  const auto height = [](double load) {
    const ProblemFile problem = problem_from(flat_truss(load));
    return values_of(*analyze(problem, start_design(problem)))(0);
  };
  EXPECT_NEAR(borne(height(0.9 * most)), 0.9 * most, 1e-6 * most);
  EXPECT_THROW(height(1.2 * most), UnstableEquilibrium);
  EXPECT_THROW(height(1.3 * most), UnstableEquilibrium);
}

}  // namespace
}  // namespace pleuel::test::equilibrium_test
