#include "core/start/initial_state.hpp"

#include <random>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/integration/simulate.hpp"
#include "core/mechanism/mechanism.hpp"
#include "tests/support/sample_name.hpp"
#include "tests/support/sample_scenes.hpp"
#include "tests/support/test.hpp"

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

}  // namespace
}  // namespace pleuel::test::initial_state_test
