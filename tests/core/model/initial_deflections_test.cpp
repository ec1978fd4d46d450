#include "core/model/initial_deflections.hpp"

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/trust/check_list.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/core/trust/trust_scenes.hpp"
#include "tests/support/at_start.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/sample_scenes.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::initial_deflections_test {
namespace {

constexpr double length = 1.0, width = 0.02, height = 0.03, young = 2.1e11, bow = 2e-4, rate = 0.3;

ResponseSettings deflection_at(double at, OverTime over_time) {
  return {"bow", DeflectionResponse{{"beam", at}}, over_time};
}

const EnergyResponse elastic_energy{"beam", EnergyKind::elastic};
const StressResponse axial_stress{{{"beam"}}, StressPart::axial};

InitialDeflection along_y(double at, Number displacement, Number speed = 0.0) {
  return {{at, 0.0, 0.0}, {0, 1, 0}, displacement, speed};
}

/// A beam without weight, held at one end or at both; its height is the first variable.
ProblemFile released(ReferenceCondition frame, std::vector<InitialDeflection> deflections,
                     int elements = 4) {
  ProblemFile problem;
  problem.scene = swinging_beam(length, RectangleSection{width, Number::bound(0)}, elements);
  problem.scene.gravity = {0.0, 0.0, 0.0};
  if (frame == ReferenceCondition::chord) {
    Joint guide = problem.scene.joints[0];
    guide.name = "guide";
    guide.type = JointType::point_on_line;
    guide.at = {length, 0.0, 0.0};
    guide.axis = {1, 0, 0};
    problem.scene.joints.push_back(guide);
  } else {
    problem.scene.joints[0].type = JointType::fixed;
  }
  std::get<BeamBody>(problem.scene.bodies[0].shape).frame = frame;
  problem.scene.bodies[0].initial_deflections = std::move(deflections);
  problem.variables = {{"height", height, 0.01, 0.1, ""}};
  problem.simulation.end_time = 2e-3;
  problem.simulation.step = 2e-5;
  return problem;
}

/// Of the first channel of a response.
double value_at(const Analysis& analysis, int step, std::size_t response = 0) {
  State state = state_of(analysis.trajectory, step);
  Signal& signal = *analysis.responses[response].history()->signal;
  Eigen::VectorXd values(signal.channels());
  signal.observe(state, values);
  return values(0);
}

/// Under a force at its tip a cantilever has 5/16 of the tip's deflection in the middle, and strain
/// energy ½ (3EI/L³) d².
TEST(InitialDeflections, AreThoseOfAForceAtTheTip) {
  ProblemFile problem = released(ReferenceCondition::tangent, {along_y(length, bow)});
  for (double at : {1.0, 0.5}) problem.responses.push_back(deflection_at(at, OverTime::max));
  problem.responses.push_back({"energy", elastic_energy});
  const auto analysis = analyze(problem, start_design(problem));
  EXPECT_EQ(analysis->model.bodies[0].frame.rotation, RotationCoordinates::angle);  // in a plane
  EXPECT_NEAR(value_at(*analysis, 0), bow, 1e-12 * bow);
  EXPECT_NEAR(value_at(*analysis, 0, 1), 5.0 / 16.0 * bow, 1e-9 * bow);
  const double inertia = width * std::pow(height, 3) / 12;
  const double expected = 1.5 * young * inertia * bow * bow / std::pow(length, 3);
  // Nothing is lost: the largest energy is that of the start. No axial force comes of bending: with one
  // it would be 1e-4 more.
  EXPECT_NEAR(analysis->reductions[2].value, expected, 1e-6 * expected);
}

/// Between two supports a force in the middle bows the quarter 11/16 as far.
TEST(InitialDeflections, AreThoseOfAForceBetweenSupports) {
  ProblemFile problem = released(ReferenceCondition::chord, {along_y(length / 2, bow)});
  problem.responses = {deflection_at(0.25, OverTime::max)};
  const auto analysis = analyze(problem, start_design(problem));
  EXPECT_NEAR(value_at(*analysis, 0), 11.0 / 16.0 * bow, 1e-9 * bow);
}

/// Two places may be given; the modes of a reduced beam hold the shape of each exactly.
TEST(InitialDeflections, HoldForReducedBeams) {
  ProblemFile problem =
      released(ReferenceCondition::tangent, {along_y(length, bow), along_y(length / 2, -bow)});
  std::get<BeamBody>(problem.scene.bodies[0].shape).reduction = CraigBampton{1, {}, 0};
  for (double at : {1.0, 0.5, 0.25}) problem.responses.push_back(deflection_at(at, OverTime::max));
  const auto reduced = analyze(problem, start_design(problem));
  std::get<BeamBody>(problem.scene.bodies[0].shape).reduction.reset();
  const auto full = analyze(problem, start_design(problem));
  EXPECT_NEAR(value_at(*reduced, 0, 0), bow, 1e-10 * bow);
  EXPECT_NEAR(value_at(*reduced, 0, 1), -bow, 1e-10 * bow);
  EXPECT_NEAR(value_at(*reduced, 0, 2), value_at(*full, 0, 2), 1e-9 * bow);
  EXPECT_LT(value_at(*full, 0, 2), -0.1 * bow);
}

/// The rate goes over into motion: y(h) − y(0) = ḋ h to first order in the step.
TEST(InitialDeflections, HaveRates) {
  ProblemFile problem = released(ReferenceCondition::tangent, {along_y(length, 0.0, rate)});
  problem.responses = {deflection_at(1.0, OverTime::max)};
  problem.simulation.step = 1e-7;
  problem.simulation.end_time = 1e-6;
  const auto analysis = analyze(problem, start_design(problem));
  EXPECT_EQ(value_at(*analysis, 0), 0.0);
  EXPECT_NEAR(value_at(*analysis, 1) / 1e-7, rate, 1e-4 * rate);
}

/// Along the beam, two places and the amounts follow the design; by differences of the whole. Between
/// two fixed pins joints change the shape.
TEST(InitialDeflections, HaveGradients) {
  for (const auto frame :
       {ReferenceCondition::tangent, ReferenceCondition::mean_axis, ReferenceCondition::chord}) {
    const bool is_stretched = frame == ReferenceCondition::chord;
    const double outer = is_stretched ? 0.75 * length : length;
    ProblemFile problem = released(frame, {along_y(outer, Number::bound(1), Number::bound(2)),
                                           along_y(length / 2, Number::bound(1, -0.5))});
    if (is_stretched) problem.scene.joints[1].type = JointType::spherical;
    std::get<BeamBody>(problem.scene.bodies[0].shape).segments = {
        {RectangleSection{width, Number::bound(0)}, 2, {}}, {RectangleSection{width, 0.02}, 2, {}}};
    problem.variables.push_back({"bow", bow, 0.0, 1e-3, ""});
    problem.variables.push_back({"rate", rate, 0.0, 1.0, ""});
    for (double at : {1.0, 0.25}) problem.responses.push_back(deflection_at(at, OverTime::rms));
    problem.responses.push_back({"stretch", axial_stress, OverTime::rms});
    const Started start = started(problem);
    const Eigen::VectorXd& x = start.x;
    const Eigen::MatrixXd direct = gradients(problem, x, *start.analysis, GradientMethod::direct);
    const Eigen::MatrixXd adjoint = gradients(problem, x, *start.analysis, GradientMethod::adjoint);
    const auto expect_equal = [&](const Eigen::MatrixXd& found, const Eigen::MatrixXd& expected,
                                  double tolerance) {
      EXPECT_LE(relative_difference(found.topRows(2), expected.topRows(2)), tolerance);
      if (!is_stretched) return;
      // Of the stress, ten times what differences of it are off by.
      EXPECT_LE(relative_difference(found.bottomRows(1), expected.bottomRows(1)), 20 * tolerance);
    };
    expect_equal(adjoint * x.asDiagonal(), direct * x.asDiagonal(), 1e-9);
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      SCOPED_TRACE(i);
      const Eigen::VectorXd difference = derivative_at_zero(
          [&](double change) {
            Eigen::VectorXd moved = x;
            moved(i) *= 1.0 + change;
            return values_of(*analyze(problem, moved));
          },
          1e-4);
      expect_equal(direct.col(i) * x(i), difference, 1e-6);
    }
  }
}

/// Between two fixed pins a bent beam is stretched: over all of its length alike. By the mean of ½ w'²
/// of the shape of a force in the middle, w = d (3 ξ − 4 ξ³) with ξ = x/L ≤ ½: 12/5 d²/L².
TEST(InitialDeflections, BetweenFixedPinsStretchTheWholeBeam) {
  constexpr double d = 2e-3;
  for (const int elements : {2, 8, 16}) {
    ProblemFile problem = released(ReferenceCondition::chord, {along_y(0.5 * length, d)}, elements);
    problem.scene.joints[1].type = JointType::spherical;
    problem.responses = {{"axial", axial_stress}, {"energy", elastic_energy}};
    const auto analysis = analyze(problem, start_design(problem));
    State start = state_of(analysis->trajectory, 0);
    Signal& stress = *analysis->responses[0].history()->signal;
    Eigen::VectorXd values(stress.channels());
    stress.observe(start, values);
    const double stretch = 2.4 * d * d / (length * length);
    // 0.1 %: stiffening by the stretch itself bends the shape a little otherwise.
    EXPECT_NEAR(values.maxCoeff() / (young * stretch), 1.0, 1e-3) << elements;
    EXPECT_NEAR(values.minCoeff() / (young * stretch), 1.0, 1e-3) << elements;
    const double inertia = width * std::pow(height, 3) / 12;
    EXPECT_NEAR(
        value_at(*analysis, 0, 1) / (0.5 * 48 * young * inertia / std::pow(length, 3) * d * d +
                                     0.5 * young * width * height * length * stretch * stretch),
        1.0, 1e-3)
        << elements;
    EXPECT_TRUE(test::findings_of(problem, check_initial_motion).empty());
  }
}

/// Newton's steps end in the round-off of stiffnesses whose condition grows as n⁴.
TEST(InitialDeflections, AreFoundOnFineMeshes) {
  for (const int elements : {32, 128}) {
    ProblemFile problem = released(ReferenceCondition::tangent, {along_y(length, 2e-3)}, elements);
    problem.responses = {deflection_at(0.5, OverTime::max)};
    const auto analysis = analyze(problem, start_design(problem));
    EXPECT_NEAR(value_at(*analysis, 0), 5.0 / 16.0 * 2e-3, 1e-7) << elements;
  }
}

/// Joints at both ends turn the frame that is the tangent at one of them.
TEST(InitialDeflections, AgainstATangentThatTurnsAreTold) {
  ProblemFile problem = released(ReferenceCondition::chord, {along_y(0.5 * length, bow)});
  std::get<BeamBody>(problem.scene.bodies[0].shape).frame = ReferenceCondition::tangent;
  problem.responses = {deflection_at(0.5, OverTime::max)};
  const std::vector<Finding> findings = test::findings_of(problem, check_initial_motion);
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_THAT(findings[0].text, HasSubstr("\"frame\": \"chord\""));
  EXPECT_FALSE(findings[0].is_serious);
}

TEST(InitialDeflections, MustBePossible) {
  const auto message = [](std::vector<InitialDeflection> deflections) {
    return thrown<InputError>(
        [&] { started(released(ReferenceCondition::tangent, std::move(deflections))); });
  };
  EXPECT_THAT(
      message({along_y(length, bow), along_y(0.0, bow)}),
      HasSubstr("/scene/bodies/beam/initial_deflections/1 cannot be: the frame of the body holds"));
  EXPECT_THAT(message({along_y(length, bow), along_y(length, 2 * bow)}),
              HasSubstr("initial_deflections/1 says the same as those before it"));
}

}  // namespace
}  // namespace pleuel::test::initial_deflections_test
