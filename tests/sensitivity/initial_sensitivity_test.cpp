#include "sensitivity/initial_sensitivity.hpp"

#include <array>
#include <functional>
#include <ostream>
#include <random>
#include <tuple>

#include "core/base/eager_matrices.hpp"
#include "core/base/rotation_vector.hpp"
#include "core/mechanism/mechanism.hpp"
#include "core/response/analysis.hpp"
#include "sensitivity/direct.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/support/at_start.hpp"
#include "tests/support/dense_algebra.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/model_state.hpp"
#include "tests/support/sample_scenes.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::initial_sensitivity_test {
namespace {

struct StartCase {
  int sample;
  double looseness;  ///< of the given positions and velocities, 0: consistent
};

/// q, v, a, λ on top of each other.
Eigen::VectorXd stacked(const State& state) {
  Eigen::VectorXd all(3 * state.q.size() + state.lambda.size());
  all << state.q, state.v, state.a, state.lambda;
  return all;
}

class StartSensitivity : public testing::TestWithParam<StartCase> {
 protected:
  SampleScene sample_ = all_samples()[GetParam().sample];

  StartSensitivity() {
    // From speed at once: velocities, centripetal accelerations and forces depend on the lengths.
    for (Joint& joint : sample_.scene.joints) {
      if (!joint.drive || !std::holds_alternative<RampToSpeedDrive>(joint.drive->motion)) continue;
      joint.drive = ConstantSpeedDrive{std::get<RampToSpeedDrive>(joint.drive->motion).speed};
    }
  }
  /// Disturbs the guess in the coordinates q of q_model = basis · q.
  void loosen(Model& model, const Eigen::VectorXd& scale, const Eigen::MatrixXd& basis) const {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    const Eigen::VectorXd start = model.mechanism.guess.q;
    Eigen::VectorXd disturbance(start.size()), rate(start.size());
    for (Eigen::Index i = 0; i < start.size(); ++i) {
      const double loose = GetParam().looseness * scale(i);
      disturbance(i) = loose * uniform(random);
      rate(i) = 10 * loose * uniform(random);
    }
    model.mechanism.guess.q += basis * disturbance;
    model.mechanism.guess.v += basis * rate;
    for (int i : model.mechanism.rotations) {
      // Turned before the design turns it: its derivative, a right perturbation, stays what it is.
      model.mechanism.guess.q.segment<3>(i) =
          compose(disturbance.segment<3>(i), start.segment<3>(i));
    }
  }
};

/// At the best of three steps, or the first that is good enough: accelerations of stiff bodies leave
/// little room between truncation and round-off.
TEST_P(StartSensitivity, IsTheDifferenceOfStartsOfNeighbouringDesigns) {
  Model model = sample_.build();
  const auto size = model.mechanism.guess.q.size();
  loosen(model, model.mechanism.scale, Eigen::MatrixXd::Identity(size, size));
  const InitialState initial = initial_state(model.mechanism);
  const StateSensitivity s = initial_sensitivity(model.mechanism, initial);
  const Eigen::VectorXd at = stacked(initial.state);
  for (int j = 0; j < model.mechanism.system->variables(); ++j) {
    const auto index = static_cast<std::size_t>(j);
    const double x = sample_.design[index];
    const auto start_at = [&](double step) {
      auto design = sample_.design;
      design[index] += step;
      Model moved = sample_.build_at(design);
      const Eigen::MatrixXd basis = change_of_basis(model, moved, j, step);
      loosen(moved, model.mechanism.scale, basis);
      State state = initial_state(moved.mechanism).state;
      state.q = solve_dense(basis, state.q);
      state.v = solve_dense(basis, state.v);
      state.a = solve_dense(basis, state.a);
      state.q = difference(model.mechanism.rotations, state.q, initial.state.q);
      return stacked(state);
    };
    Eigen::VectorXd found(at.size());
    found << s.q.col(j), s.v.col(j), s.a.col(j), s.lambda.col(j);
    const std::array<Eigen::Index, 5> parts = {0, size, 2 * size, 3 * size, at.size()};
    std::array<double, 4> best = {1.0, 1.0, 1.0, 1.0};
    constexpr double tolerance = 1e-7;
    for (double relative : {3e-3, 1e-2, 1e-3}) {
      const Eigen::VectorXd expected = derivative_at_zero(start_at, relative * std::abs(x));
      for (std::size_t i = 0; i < 4; ++i) {
        const auto part = [&](const Eigen::VectorXd& all) {
          return all.segment(parts[i], parts[i + 1] - parts[i]);
        };
        const double scale = std::max(part(expected).lpNorm<Eigen::Infinity>(),
                                      part(at).lpNorm<Eigen::Infinity>() / std::abs(x));
        const double error = (part(found) - part(expected)).lpNorm<Eigen::Infinity>();
        best[i] = std::min(best[i], scale > 0.0 ? error / scale : error);
      }
      if (*std::max_element(best.begin(), best.end()) <= tolerance) break;
    }
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_LE(best[i], tolerance)
          << std::array{"q", "v", "a", "lambda"}[i] << ", variable " << sample_.variables[index];
    }
  }
}

std::string start_case_name(const testing::TestParamInfo<StartCase>& info) {
  return all_samples()[info.param.sample].name +
         (info.param.looseness == 0.0 ? "Consistent" : "Loose");
}
std::vector<StartCase> all_cases() {
  std::vector<StartCase> cases;
  for (double looseness : {0.0, 0.01}) {
    for (int sample = 0; sample < sample_count; ++sample) cases.push_back({sample, looseness});
  }
  return cases;
}
INSTANTIATE_TEST_SUITE_P(Samples, StartSensitivity, testing::ValuesIn(all_cases()),
                         start_case_name);

// Gradients that are known in closed form: frequencies and static deflections of a cantilever are
// products of powers of its numbers.

enum Variable { young, density, length, height, width };
const Eigen::VectorXd design = Eigen::Vector<double, 5>(2.1e11, 7850.0, 0.7, 0.02, 0.03);
/// Small, since a mean axis turns with the bending, by 2e-5 rad: its square is the error of a
/// linear law.
constexpr double load = -0.5;

/// Elastic coordinates that a cantilever may have.
struct NamedBeam {
  const char* name;
  ReferenceCondition frame;
  bool is_reduced;
  EffectChoice spatial;
};

ProblemFile cantilever(const NamedBeam& coordinates) {
  ProblemFile problem;
  const RectangleSection section{Number::bound(width), Number::bound(height)};
  problem.scene = swinging_beam(design[length], section, 4);
  problem.scene.gravity = {0.0, 0.0, 0.0};
  problem.scene.materials.front().young = Number::bound(young);
  problem.scene.materials.front().density = Number::bound(density);
  problem.scene.joints.front().drive = PolynomialFunction{{0.0}};
  BeamBody& beam = std::get<BeamBody>(problem.scene.bodies.front().shape);
  const Point tip{Number::bound(length), 0.0, 0.0};
  beam.to = tip;
  beam.frame = coordinates.frame;
  if (coordinates.is_reduced) beam.reduction = CraigBampton{2, {}};
  PointLoad force{LoadKind::force, "beam", tip, {0.0, 1.0, 0.0}, {}, false};
  force.value = ConstantFunction{load};
  problem.scene.loads = {{"weight", force}};
  problem.effects.spatial_motion = coordinates.spatial;
  // The laws are those of a linear beam without rotary inertia.
  problem.effects.rotary_inertia = problem.effects.geometric_stiffening = EffectChoice::off;
  problem.simulation.end_time = problem.simulation.step = 1e-3;
  problem.simulation.quasi_static_start = true;
  for (const char* name : {"E", "rho", "L", "h", "b"}) {
    const double value = design[problem.variables.size()];
    problem.variables.push_back({name, value, 0.5 * value, 2.0 * value, ""});
  }
  problem.responses = {{"tip", PointMotionResponse{{"beam", 1.0}}, OverTime::final},
                       {"frequency of the mechanism", ModeResponse{}},
                       {"frequency of the body", ModeResponse{"beam"}}};
  return problem;
}

class ScalingLaws : public testing::TestWithParam<NamedBeam> {};

/// p · d/dp of a response over the response: the power of p in it. 1e-7: frequencies of mechanisms
/// are differentiated by differences of tangents.
TEST_P(ScalingLaws, AreTheGradientsOfACantilever) {
  const ProblemFile problem = cantilever(GetParam());
  const auto analysis = analyze(problem, design);
  const double inertia = design[width] * std::pow(design[height], 3) / 12;
  const double tip = load * std::pow(design[length], 3) / (3 * design[young] * inertia);
  EXPECT_NEAR(analysis->reductions[0].value / tip, 1.0, 1e-8);
  const Eigen::Vector<double, 5> of_tip(-1.0, 0.0, 3.0, -3.0, -1.0),
      of_frequency(0.5, -0.5, -2.0, 1.0, 0.0);
  for (GradientMethod method : {GradientMethod::direct, GradientMethod::adjoint}) {
    const Eigen::MatrixXd gradient =
        gradients(problem, design, *analysis, method) * design.asDiagonal();
    for (Eigen::Index i = 0; i < 3; ++i) {
      const Eigen::VectorXd powers = gradient.row(i).transpose() / analysis->reductions[i].value;
      const Eigen::VectorXd& law = i == 0 ? of_tip : of_frequency;
      EXPECT_LE((powers - law).lpNorm<Eigen::Infinity>(), 1e-7)
          << problem.responses[i].name << ", " << to_string(method) << ": " << powers.transpose();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Coordinates, ScalingLaws,
    testing::Values(
        NamedBeam{"Nodal", ReferenceCondition::tangent, false, EffectChoice::off},
        NamedBeam{"Reduced", ReferenceCondition::tangent, true, EffectChoice::off},
        NamedBeam{"MeanAxis", ReferenceCondition::mean_axis, false, EffectChoice::off},
        NamedBeam{"NodalInSpace", ReferenceCondition::tangent, false, EffectChoice::on},
        NamedBeam{"ReducedInSpace", ReferenceCondition::tangent, true, EffectChoice::on},
        NamedBeam{"MeanAxisInSpace", ReferenceCondition::mean_axis, false, EffectChoice::on}),
    [](const auto& test) { return std::string(test.param.name); });

/// Large steps: the gradient is that of the scheme at any step, and differences of accelerations,
/// which are Δq/h²β, have the less round-off.
SimulationOptions short_run(const Formulation& formulation) {
  SimulationOptions options{0.02, 2e-3, 0.8};
  options.newton_tolerance = 1e-12;
  options.formulation = formulation;
  return options;
}

struct NamedFormulation {
  std::string name;
  Formulation formulation;

  friend std::ostream& operator<<(std::ostream& stream, const NamedFormulation& named) {
    return stream << (named.name.empty() ? "Index3" : named.name);
  }
};
const NamedFormulation plain{"", {}};
const NamedFormulation stabilized{"StabilizedIndex2", {ConstraintForm::stabilized_index_2}};
const NamedFormulation baumgarte{"Baumgarte", {ConstraintForm::index_1, 50.0}};
const NamedFormulation projected{"Projected", {ConstraintForm::index_1, 0.0, true}};

/// q, v, a, λ of the last step.
std::array<Eigen::VectorXd, 4> end_of(const Trajectory& trajectory) {
  const int last = trajectory.steps();
  return {trajectory.columns().q().col(last), trajectory.columns().v().col(last),
          trajectory.columns().a().col(last), trajectory.columns().lambda().col(last)};
}

using DirectCase = std::tuple<int, NamedFormulation>;

class DirectDifferentiation : public testing::TestWithParam<DirectCase> {
 protected:
  SampleScene sample_ = all_samples()[std::get<0>(GetParam())];
  SimulationOptions options_ = short_run(std::get<1>(GetParam()).formulation);
};

class DifferentiatedConstraints : public DirectDifferentiation {};

/// The whole state after ten steps, every variable, against simulating anew: central differences at
/// the best step of a V-curve, or the first that is good enough. Fast modes change their phase
/// quickly with a design, and accelerations have the round-off of positions over h². Measured at
/// worst 1e-9, 3e-7, 1e-6, 2e-6; times ten.
TEST_P(DirectDifferentiation, IsTheDifferenceOfNeighbouringTrajectories) {
  Model model = sample_.build();
  const Trajectory trajectory = simulate(model.mechanism, options_);
  StateSensitivity s;
  differentiate(model.mechanism, trajectory,
                [&](int step, const State&, const StateSensitivity& now) {
                  if (step == trajectory.steps()) s = now;
                });
  const auto at = end_of(trajectory);
  const std::array<double, 4> tolerance = {1e-8, 3e-6, 1e-5, 2e-5};
  for (int j = 0; j < model.mechanism.system->variables(); ++j) {
    const auto index = static_cast<std::size_t>(j);
    const double x = sample_.design[index];
    const std::array<Eigen::VectorXd, 4> found = {s.q.col(j), s.v.col(j), s.a.col(j),
                                                  s.lambda.col(j)};
    std::array<double, 4> best = {1.0, 1.0, 1.0, 1.0};
    const auto is_found = [&] {
      return std::equal(best.begin(), best.end(), tolerance.begin(), std::less_equal<>());
    };
    for (double relative : {1e-4, 1e-5, 1e-3}) {
      const auto end_at = [&](double change) {
        auto design = sample_.design;
        design[index] += change;
        Model neighbour = sample_.build_at(design);
        auto end = end_of(simulate(neighbour.mechanism, options_));
        const Eigen::MatrixXd basis = change_of_basis(model, neighbour, j, change);
        for (std::size_t i = 0; i < 3; ++i) end[i] = solve_dense(basis, end[i]);
        return end;
      };
      const double h = relative * std::abs(x);
      const auto up = end_at(h), down = end_at(-h);
      for (std::size_t i = 0; i < 4; ++i) {
        const auto change = [&](const Eigen::VectorXd& value) -> Eigen::VectorXd {
          if (i > 0) return value - at[i];
          return difference(model.mechanism.rotations, value, at[i]);
        };
        const Eigen::VectorXd expected = (change(up[i]) - change(down[i])) / (2 * h);
        const double scale = std::max(expected.lpNorm<Eigen::Infinity>(),
                                      at[i].lpNorm<Eigen::Infinity>() / std::abs(x));
        const double error = (found[i] - expected).lpNorm<Eigen::Infinity>() / scale;
        best[i] = std::min(best[i], error);
      }
      if (is_found()) break;
    }
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_LE(best[i], tolerance[i])
          << std::array{"q", "v", "a", "lambda"}[i] << ", variable " << sample_.variables[index];
    }
  }
}

/// The sensitivities stay on the differentiated constraints: measured 1.7e-12 of the largest at
/// worst.
TEST_P(DifferentiatedConstraints, AreKept) {
  Model model = sample_.build();
  System& system = *model.mechanism.system;
  const Trajectory trajectory = simulate(model.mechanism, options_);
  System::Matrix matrix = system.make_matrix();
  Eigen::MatrixXd columns;
  differentiate(
      model.mechanism, trajectory, [&](int, const State& state, const StateSensitivity& s) {
        system.tangent(state, {.q = 1.0}, ConstraintLevel::position, matrix);
        system.design_derivative(state, ConstraintLevel::position, columns);
        const Eigen::MatrixXd phi_x = columns.bottomRows(system.multipliers());
        const Eigen::MatrixXd total =
            (matrix.leftCols(system.coordinates()) * s.q).bottomRows(system.multipliers()) + phi_x;
        const Eigen::RowVectorXd scale =
            phi_x.cwiseAbs().colwise().maxCoeff() + s.q.cwiseAbs().colwise().maxCoeff();
        for (Eigen::Index j = 0; j < total.cols(); ++j) {
          ASSERT_LE(total.col(j).lpNorm<Eigen::Infinity>(), 1e-11 * (scale(j) + 1e-12));
        }
      });
}

std::string direct_case_name(const testing::TestParamInfo<DirectCase>& info) {
  const auto sample = static_cast<std::size_t>(std::get<0>(info.param));
  return all_samples()[sample].name + std::get<1>(info.param).name;
}
INSTANTIATE_TEST_SUITE_P(Samples, DirectDifferentiation,
                         testing::Combine(testing::Range(0, sample_count),
                                          testing::Values(plain, stabilized, baumgarte, projected)),
                         direct_case_name);
INSTANTIATE_TEST_SUITE_P(Samples, DifferentiatedConstraints,
                         testing::Combine(testing::Range(0, sample_count),
                                          testing::Values(plain, stabilized, projected)),
                         direct_case_name);

/// Too few iterations for such steps, so that some are split.
SimulationOptions impatient() {
  SimulationOptions options{0.06, 5e-3, 0.8};
  options.newton_tolerance = 1e-12;
  options.max_newton_iterations = 4;
  return options;
}

/// A step that fails is halved until it works, and the instants that were asked for are met.
TEST(SplitSteps, LeadToEveryRegularInstant) {
  Model model = smooth_planar_sample().build();
  const SimulationOptions options = impatient();
  const Trajectory trajectory = simulate(model.mechanism, options);
  ASSERT_GT(trajectory.split_steps, 0);
  EXPECT_EQ(trajectory.steps(), step_count(options) + trajectory.split_steps);
  for (int step = 0; step <= step_count(options); ++step) {
    const double instant = options.end_time * step / step_count(options);
    EXPECT_LE((trajectory.time.array() - instant).abs().minCoeff(), 1e-15) << step;
  }
  SimulationOptions patient = options;
  patient.max_newton_iterations = 20;
  const Trajectory whole = simulate(model.mechanism, patient);
  EXPECT_EQ(whole.split_steps, 0);
  // The same motion up to the error of the large steps.
  const Eigen::VectorXd end = trajectory.columns().q().col(trajectory.steps()),
                        other = whole.columns().q().col(whole.steps());
  EXPECT_LE((end - other).norm(), 0.05 * other.norm());
}

/// The sequence of steps that ran is differentiated.
TEST(SplitSteps, AreDifferentiatedAsTheyRan) {
  const SampleScene sample = smooth_planar_sample();
  Model model = sample.build();
  const Trajectory trajectory = simulate(model.mechanism, impatient());
  ASSERT_GT(trajectory.split_steps, 0);
  Eigen::MatrixXd s;
  differentiate(model.mechanism, trajectory,
                [&](int, const State&, const StateSensitivity& now) { s = now.q; });
  for (std::size_t j = 0; j < sample.design.size(); ++j) {
    const double h = 1e-5 * sample.design[j];
    const auto end_at = [&](double change) -> Eigen::VectorXd {
      auto design = sample.design;
      design[j] += change;
      Model neighbour = sample.build_at(design);
      const Trajectory found = simulate(neighbour.mechanism, impatient());
      EXPECT_EQ(found.steps(), trajectory.steps()) << "not the same sequence of steps";
      return found.columns().q().col(found.steps());
    };
    const Eigen::VectorXd expected = (end_at(h) - end_at(-h)) / (2 * h);
    const Eigen::VectorXd found = s.col(j);
    EXPECT_LE((found - expected).lpNorm<Eigen::Infinity>(),
              1e-5 * found.lpNorm<Eigen::Infinity>() + 1e-9)
        << sample.variables[j];
  }
}

/// A mechanism in motion sets out with velocities that belong to the size of the first step. Where
/// that fails, the halves have to set out from the initial values, not from where it did.
TEST(SplitSteps, OfTheFirstStepSetOutFromTheInitialValues) {
  const auto [problem, x, split] = AtStart(
      sample_problem("hard/dead_centres", {"/simulation/step=16 ms", "/simulation/end_time=64 ms",
                                           "/simulation/max_newton_iterations=4"}));
  ASSERT_LT(split->trajectory.time(1), 0.01) << "the first step was to be split";
  ProblemFile patient = with_steps_of(split->trajectory, problem);
  patient.simulation.instants.assign(split->trajectory.time.begin(), split->trajectory.time.end());
  patient.simulation.max_newton_iterations = 20;
  const auto whole = analyze(patient, x);
  ASSERT_EQ(whole->trajectory.split_steps, 0);
  ASSERT_EQ(whole->trajectory.steps(), split->trajectory.steps());
  State found, expected;
  for (int step = 0; step <= split->trajectory.steps(); ++step) {
    split->trajectory.states->load(step, found);
    whole->trajectory.states->load(step, expected);
    // What Newton's method leaves, 1e-10, in another number of iterations.
    EXPECT_LE((found.v - expected.v).norm(), 1e-7 * expected.v.norm()) << step;
  }
}

}  // namespace
}  // namespace pleuel::test::initial_sensitivity_test
