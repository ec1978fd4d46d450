#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/sample_scenes.hpp"

/// Gradients that are known in closed form: frequencies and static deflections of a cantilever are
/// products of powers of its numbers.
namespace pleuel::test::scaling_law_test {
namespace {

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
  PointForce force{"beam", tip, {0.0, 1.0, 0.0}, {}, false};
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
  ResponseSettings response;
  response.name = "tip";
  response.type = ResponseType::position;
  response.bodies = {"beam"};
  response.at = 1.0;
  response.over_time = OverTime::final;
  problem.responses.push_back(response);
  response.name = "frequency of the mechanism";
  response.type = ResponseType::frequency;
  response.bodies = {};
  problem.responses.push_back(response);
  response.name = "frequency of the body";
  response.bodies = {"beam"};
  problem.responses.push_back(response);
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

}  // namespace
}  // namespace pleuel::test::scaling_law_test
