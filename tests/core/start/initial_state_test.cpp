#include "core/start/initial_state.hpp"

#include <limits>
#include <random>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/integration/simulate.hpp"
#include "core/mechanism/mechanism.hpp"
#include "core/start/equilibrium.hpp"
#include "sensitivity/gradients.hpp"
#include "sensitivity/initial_sensitivity.hpp"
#include "tests/core/start/quasi_static_beam.hpp"
#include "tests/support/at_start.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/sample_scenes.hpp"
#include "tests/support/test.hpp"

/// Starts from elastic equilibrium: those that have to be found, and those that do not exist.

namespace pleuel::test::initial_state_test {
namespace {

class StartOfAMechanism : public testing::TestWithParam<int> {
 protected:
  StartOfAMechanism() {
    Mechanism& mechanism = model_.mechanism;
    std::mt19937 random(2);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    for (Eigen::Index i = 0; i < mechanism.guess.q.size(); ++i) {
      mechanism.guess.q(i) += 0.02 * mechanism.scale(i) * uniform(random);
      mechanism.guess.v(i) += 0.5 * mechanism.scale(i) * uniform(random);
    }
  }
  Eigen::VectorXd constraints(const State& state, ConstraintLevel level) {
    Eigen::VectorXd residual;
    model_.mechanism.system->residual(state, level, residual);
    return residual.tail(model_.mechanism.system->multipliers());
  }
  /// Φ_q at a state.
  Eigen::MatrixXd jacobian(const State& state) {
    System& system = *model_.mechanism.system;
    System::Matrix matrix = system.make_matrix();
    system.tangent(state, {.q = 1.0}, ConstraintLevel::position, matrix);
    return Eigen::MatrixXd(matrix).bottomLeftCorner(system.multipliers(), system.coordinates());
  }

  Model model_ = all_samples()[GetParam()].build();
};

TEST_P(StartOfAMechanism, ClosesWhatWasGivenLoosely) {
  const State state = initial_state(model_.mechanism).state;
  EXPECT_LE(constraints(state, ConstraintLevel::position).lpNorm<Eigen::Infinity>(), 1e-12);
  EXPECT_LE(constraints(state, ConstraintLevel::velocity).lpNorm<Eigen::Infinity>(), 1e-10);
}

TEST_P(StartOfAMechanism, AcceleratesByItsEquationsOfMotion) {
  const State state = initial_state(model_.mechanism).state;
  Eigen::VectorXd residual;
  model_.mechanism.system->residual(state, ConstraintLevel::acceleration, residual);
  const double size = state.lambda.lpNorm<Eigen::Infinity>() + state.a.lpNorm<Eigen::Infinity>();
  EXPECT_LE(residual.lpNorm<Eigen::Infinity>(), 1e-10 * size);
}

/// W (q − q̂) + Φ_qᵀ μ = 0 and W (v − v̂) + Φ_qᵀ μ' = 0: the conditions of the nearest point.
TEST_P(StartOfAMechanism, IsTheNearestOneToWhatWasGiven) {
  Mechanism& mechanism = model_.mechanism;
  const InitialState initial = initial_state(mechanism);
  const Eigen::MatrixXd phi_q = jacobian(initial.state);
  const auto expect_nearest = [&](const Eigen::VectorXd& distance, const Eigen::VectorXd& mu) {
    const Eigen::VectorXd pull = mechanism.assembly_weight.cwiseProduct(distance);
    // Elastic coordinates weigh some 1e10 times what frames do, and so does their round-off.
    const double round_off = 1e-14 * mechanism.assembly_weight.maxCoeff();
    EXPECT_LE((pull + phi_q.transpose() * mu).lpNorm<Eigen::Infinity>(),
              1e-8 * pull.lpNorm<Eigen::Infinity>() + round_off);
  };
  expect_nearest(difference(mechanism.rotations, initial.state.q, mechanism.guess.q),
                 initial.position_multipliers);
  expect_nearest(initial.state.v - mechanism.guess.v, initial.velocity_multipliers);
}

INSTANTIATE_TEST_SUITE_P(Samples, StartOfAMechanism, testing::Range(0, sample_count), sample_name);

/// q² + 1 = 0 has no solution.
class Impossible : public Term {
 public:
  std::string name() const override { return "impossible"; }
  void declare_entries(EntryList& entries) const override { entries = {{0, 0}, {0, 1}, {1, 0}}; }
  void add_residual(const State& at, ConstraintLevel, Eigen::VectorXd& residual) override {
    residual(0) += at.a(0) + 2 * at.q(0) * at.lambda(0);
    residual(1) += at.q(0) * at.q(0) + 1;
  }
  void linearize(const State& at, const WeightList& weights, ConstraintLevel level,
                 Eigen::VectorXd& residual, const EntryBlocks& entries) override {
    add_residual(at, level, residual);
    for (std::size_t i = 0; i < weights.size(); ++i) {
      double* block = entries.block(i);
      block[0] = weights[i].a + 2 * weights[i].q * at.lambda(0);
      block[1] = 2 * at.q(0);
      block[2] = 2 * weights[i].q * at.q(0);
    }
  }
  void add_design_derivative(const State&, ConstraintLevel, Eigen::MatrixXd&) override {}
  int parameter_adjoint_count() const override { return 0; }
  void add_parameter_adjoints(const State&, ConstraintLevel, const ConstColumns&,
                              Columns) override {}
  void add_design_gradients(const ConstColumns&, Eigen::MatrixXd&) const override {}
};

TEST(StartOfAMechanism, SaysThatItCannotBeAssembled) {
  std::vector<std::unique_ptr<Term>> terms;
  terms.push_back(std::make_unique<Impossible>());
  Mechanism mechanism;
  mechanism.system = std::make_unique<System>(1, 1, 0, std::move(terms));
  mechanism.guess = State(1, 1);
  mechanism.guess.q(0) = 0.7;
  mechanism.scale = mechanism.assembly_weight = Eigen::VectorXd::Ones(1);
  EXPECT_THAT(thrown<SimulationError>([&] { initial_state(mechanism); }),
              HasSubstr("cannot be assembled"));
}

/// A rope whose ends would have to meet where the beam cannot reach.
TEST(StartOfAMechanism, NamesTheJointThatCannotBeClosed) {
  Scene scene = swinging_beam(0.3, CircleSection{0.01}, 2);
  Joint rope;
  rope.name = "rope";
  rope.type = JointType::distance;
  rope.bodies = {ground_name, "beam"};
  rope.at = {1.0, 0.0, 0.0};
  rope.to = {0.3, 0.0, 0.0};
  rope.drive = Drive(PolynomialFunction{{-0.5}}, DrivenCoordinate::displacement);
  scene.joints.push_back(rope);
  Model model = build_model(scene, {}, {}, {});
  EXPECT_THAT(thrown<SimulationError>([&] { initial_state(model.mechanism); }),
              HasSubstr("joint rope"));
}

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
    problem.responses.push_back({over_time == OverTime::max ? "highest" : "lowest",
                                 DeflectionResponse{{"beam", 1.0}}, over_time});
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
  const auto [problem, x, analysis] = AtStart(cantilever(true));
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
    const ReactionResponse reaction{problem->scene.joints[0].name, ReactionKind::force, 1};
    problem->responses.push_back({"reaction", reaction, OverTime::mean});
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

/// Beside that of another design, and beside states that lead nowhere or are of another mechanism.
TEST_P(EquilibriumOfASample, IsFoundBesideAnother) {
  Model model = build_at(sample_.design);
  const State expected = initial_state(model.mechanism).state;
  Design<double> design = sample_.design;
  for (double& x : design) x *= 1.05;
  Model moved = build_at(design);
  const State close = initial_state(moved.mechanism).state;
  State nowhere = close, other = close;
  nowhere.q.setConstant(std::numeric_limits<double>::quiet_NaN());
  other.q.conservativeResize(close.q.size() - 1);
  for (const State& similar : {close, nowhere, other}) {
    const State found = initial_state(model.mechanism, &similar).state;
    EXPECT_LE((found.q - expected.q).lpNorm<Eigen::Infinity>(), 1e-11);
    EXPECT_LE((found.lambda - expected.lambda).norm(), 1e-8 * expected.lambda.norm());
    EXPECT_EQ(found.time, expected.time);
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
                "section": {{"type": "circle", "diameter": 0.03}}, "elements": 4, "frame": "chord"}}}},
        "joints": {{
          "a": {{"type": "revolute", "bodies": ["ground", "l"], "at": [-0.5, 0, 0]}},
          "c": {{"type": "revolute", "bodies": ["ground", "r"], "at": [0.5, 0, 0]}},
          "t": {{"type": "revolute", "bodies": ["l", "r"], "at": [0, 0.02, 0]}}}},
        "loads": {{"f": {{"type": "force", "body": "l", "at": [0, 0.02, 0],
                         "direction": [0, -1, 0], "value": {}}}}}}},
      "simulation": {{"end_time": 0.001, "step": 0.0005, "initial_state": "quasi-static"}},
      "responses": {{"y": {{"type": "position", "body": "l", "at": 1, "direction": "y", "over_time": "min"}}}}}})",
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

using namespace quasi_static_beam;

/// The elastica for α = PL²/EI = 0.25 (its equation by shooting): 0.0827459 of deflection, 0.0041178 of
/// shortening. The model is linear in bending: its error is α²-small, some 1 %.
TEST(QuasiStaticStart, OfABentCantileverIsNearTheElastica) {
  const Eigen::Vector2d found = tip(beam(clamp, 0.0, 0.25 * stiffness));
  EXPECT_NEAR(found(1) / 0.0827459154, 1.0, 0.01);
  EXPECT_NEAR((1.0 - found(0)) / 0.0041178184, 1.0, 0.03);
}

/// PL³/3EI up to rotations where linear bending is wrong: it is found and left to warnings. The tip
/// falls by ∫½v'² = P²L⁵/15 (EI)²; axial strain is 1e-9.
TEST(QuasiStaticStart, IsFoundForLargeBending) {
  for (double alpha : {0.1, 0.5, 1.0}) {
    for (int elements : {4, 32, 128}) {
      const Eigen::Vector2d found = tip(beam(clamp, 0.0, alpha * stiffness, elements));
      EXPECT_NEAR(found(1) / (alpha / 3.0), 1.0, 1e-5) << alpha;
      EXPECT_NEAR((1.0 - found(0)) / (alpha * alpha / 15.0), 1.0, 1e-2) << alpha;
    }
  }
}

/// A blade of 5 m at 40 rad/s, far stiffer by its pull than by itself, with a lift at its tip: Newton's
/// method at once comes to an equilibrium with its tip turned by radians, which is not stable. The tip
/// rises by as much as the lift grows.
TEST(QuasiStaticStart, OfATurningBladeIsThatOfLoadsThatGrow) {
  const auto rise = [](double lift) {
    const ProblemFile problem = problem_from(fmt::format(
        R"j({{"scene": {{"gravity": [0, 0, 0],
                  "materials": {{"m": {{"young": 7.17e10, "poisson": 0.33, "density": 2810}}}},
                  "bodies": {{"blade": {{"type": "beam", "from": [0, 0, 0], "to": [5, 0, 0],
                      "material": "m", "elements": 8, "frame": "tangent",
                      "section": {{"type": "rectangle", "width": 0.01, "height": 0.2}},
                      "angular_velocity": [0, 0, 40]}}}},
                  "joints": {{"hub": {{"type": "revolute", "bodies": ["ground", "blade"],
                      "at": [0, 0, 0], "axis": [0, 0, 1], "drive": {{"type": "constant-speed", "speed": 40}}}}}},
                  "loads": {{"lift": {{"type": "force", "body": "blade", "at": [5, 0, 0],
                      "direction": [0, 0, 1], "value": {}}}}}}},
                "simulation": {{"end_time": 5e-4, "step": 5e-4, "initial_state": "quasi-static"}},
                "responses": {{"tip": {{"type": "position", "body": "blade", "at": 1,
                                       "direction": "z", "over_time": "final"}}}}}})j",
        lift));
    return analyze(problem, start_design(problem))->histories[0](0, 0);
  };
  const double little = rise(10.0);
  for (double lift : {150.0, 200.0, 300.0, 400.0}) {
    EXPECT_NEAR(rise(lift) / little, lift / 10.0, 1e-2 * lift / 10.0) << lift;
  }
}

/// Round-off grows with the fourth power of the number of elements: some 1e-6 here.
TEST(QuasiStaticStart, IsFoundForFineMeshes) {
  for (int elements : {96, 160}) {
    const Eigen::Vector2d found = tip(beam(clamp, -2.0, 0.1 * stiffness, elements));
    const double k = std::sqrt(2.0 / stiffness);  // beam-column: v = P (tan kL − kL)/(N k)
    const double expected = 0.1 * stiffness * (std::tan(k) - k) / (2.0 * k);
    EXPECT_NEAR(found(1) / expected, 1.0, 1e-5) << elements;
  }
}

/// A force across: the equations of what does not move along hold nothing but round-off.
TEST(QuasiStaticStart, IsFoundWhereNothingPullsAlong) {
  for (int elements : {200, 400}) {
    const Eigen::Vector2d found = tip(beam(clamp, 0.0, 0.007 * stiffness, elements));
    EXPECT_NEAR(found(1) / (0.007 / 3.0), 1.0, 1e-4) << elements;
  }
}

/// Both ends held lengthwise: each of two clamped members carries half of the force, PL³/6EI.
TEST(QuasiStaticStart, OfClampedMembersCoupledAtTheirTipsIsFound) {
  for (const char* type : {"point-on-line", "revolute"}) {
    const std::string text = fmt::format(
        R"({{"scene": {{
      "materials": {{"m": {{"young": 2.1e11, "poisson": 0.3, "density": 7850}}}},
      "bodies": {{
        "one": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "m",
                "section": {{"type": "rectangle", "width": 0.02, "height": 0.03}}, "elements": 3}},
        "two": {{"type": "beam", "from": [2, 0, 0], "to": [1, 0, 0], "material": "m",
                "section": {{"type": "rectangle", "width": 0.02, "height": 0.03}}, "elements": 3}}}},
      "joints": {{"a": {{"type": "fixed", "bodies": ["ground", "one"], "at": [0, 0, 0]}},
                "b": {{"type": "fixed", "bodies": ["ground", "two"], "at": [2, 0, 0]}},
                "link": {{"type": "{}", "bodies": ["one", "two"], "at": [1, 0, 0], "axis": [{}]}}}},
      "loads": {{"f": {{"type": "force", "body": "one", "at": [1, 0, 0], "direction": [0, -1, 0], "value": 10}}}}}},
      "simulation": {{"end_time": 0.001, "step": 0.001, "initial_state": "quasi-static"}},
      "responses": {{"x": {{"type": "mass"}}, "y": {{"type": "position", "body": "one", "at": 1,
                                                "direction": "y", "over_time": "max-abs"}}}}}})",
        type, std::string(type) == "revolute" ? "0, 0, 1" : "1, 0, 0");
    const auto [problem, x, analysis] = AtStart(problem_from(text));
    const double inertia = 0.02 * std::pow(0.03, 3) / 12;
    EXPECT_NEAR(analysis->reductions[1].value * 6 * young * inertia / 10.0, 1.0, 1e-4) << type;
  }
}

/// Columns beyond their Euler loads by 1.3 in the plane: 1/1.3 of the loads is what they bear.
TEST(QuasiStaticStart, RefusesColumnsBeyondTheirEulerLoad) {
  const double unit = std::pow(std::numbers::pi, 2) * stiffness;
  struct Case {
    std::string name, joints, frame;
    double load;
  };
  const std::string guide = joint("g", "point-on-line", 1, "[1, 0, 0]");
  for (const Case& column :
       {Case{"free", clamp, "tangent", unit / 4},
        Case{"pinned", joint("p", "revolute", 0) + "," + guide, "chord", unit},
        Case{"clamped and pinned", clamp + "," + guide, "tangent", 2.045748 * unit}}) {
    for (const char* effects : {"{}", R"({"spatial_motion": "on"})"}) {
      EXPECT_EQ(error_of(beam(column.joints, -0.9 * column.load, 0.0, 8, effects, column.frame)),
                "")
          << column.name << effects;
      const std::string error =
          error_of(beam(column.joints, -1.3 * column.load, 0.0, 8, effects, column.frame));
      EXPECT_THAT(error, HasSubstr("is unstable")) << column.name << effects;
      EXPECT_THAT(error, HasSubstr("the body \"b\" buckles, at some 0.769 of these loads"));
    }
    const std::string bent =
        error_of(beam(column.joints, -1.3 * column.load, 1e-3, 8, "{}", column.frame));
    EXPECT_THAT(bent, HasSubstr("0.769")) << "with a force across: " << column.name;
  }
}

/// What is not held may fall as it likes: a pendulum upside down has no equilibrium, its beam has.
TEST(QuasiStaticStart, LeavesMotionsOfTheWholeMechanismAlone) {
  EXPECT_EQ(error_of(beam(joint("p", "revolute", 0), -0.01 * stiffness, 0.0)), "");
}

}  // namespace
}  // namespace pleuel::test::initial_state_test
