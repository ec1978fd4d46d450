#include "core/model/initial_deflections.hpp"

#include <cstdio>
#include <fstream>
#include <map>

#include <nlohmann/json.hpp>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/model/resolve_beam.hpp"
#include "core/model/scene_geometry.hpp"
#include "core/scene/visit_numbers.hpp"
#include "core/trust/check_list.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/core/trust/trust_scenes.hpp"
#include "tests/support/at_start.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/files.hpp"
#include "tests/support/sample_scenes.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::initial_deflections_test {
namespace {

constexpr double length = 1.0, width = 0.02, height = 0.03, young = 2.1e11, bow = 2e-4, rate = 0.3;

ResponseSettings deflection_at(double at, OverTime over_time) {
  ResponseSettings response;
  response.name = "bow";
  response.type = ResponseType::deflection;
  response.bodies = {"beam"};
  response.at = at;
  response.over_time = over_time;
  return response;
}

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
  ResponseSettings energy;
  energy.name = "energy";
  energy.type = ResponseType::elastic_energy;
  energy.bodies = {"beam"};
  energy.over_time = OverTime::max;
  problem.responses.push_back(energy);
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
    ResponseSettings stretch = deflection_at(0.25, OverTime::rms);
    stretch.type = ResponseType::stress;
    stretch.part = StressPart::axial;
    problem.responses.push_back(stretch);
    const auto [x, analysis] = started(problem);
    const Eigen::MatrixXd direct = gradients(problem, x, *analysis, GradientMethod::direct);
    const Eigen::MatrixXd adjoint = gradients(problem, x, *analysis, GradientMethod::adjoint);
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
    ResponseSettings axial = deflection_at(0.5, OverTime::max);
    axial.type = ResponseType::stress;
    axial.part = StressPart::axial;
    ResponseSettings energy = deflection_at(0.5, OverTime::max);
    energy.type = ResponseType::elastic_energy;
    problem.responses = {axial, energy};
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

Number doubled(int variable) {
  return Number::bound(variable, 2.0);
}

/// One of every kind, all its numbers bound to the variables 0, 1, …
std::vector<Section> bound_sections() {
  const auto x = [](int i) { return Number::bound(i); };
  return {RectangleSection{x(0), x(1)},
          CircleSection{x(0)},
          TubeSection{x(0), x(2)},
          EllipseSection{x(0), x(1)},
          BoxSection{x(0), x(1), x(2)},
          ISection{x(0), x(1), x(2), doubled(2)},
          GeneralSection{x(0), x(1), x(2), x(3), {{0.01, 0.02, 3.0}}}};
}

const Design<double> design = {0.03, 0.05, 0.004, 0.02};

void expect_derivative(const Dual& dual, double more, double less, double step) {
  const double difference = (more - less) / (2 * step);
  // Central differences with 1e-6 of x: truncation 1e-12, round-off 1e-10 of the value over x.
  EXPECT_NEAR(derivative_of(dual), difference, 1e-8 * std::abs(difference) + 1e-9 * value_of(dual));
}

TEST(ResolvedSection, DependsOnItsVariablesAndOnNoOthers) {
  for (const Section& section : bound_sections()) {
    SCOPED_TRACE(section.index());
    std::set<int> bound;
    visit_numbers(section, [&](const Number& number, const Quantity&) {
      if (number.is_bound()) bound.insert(number.variable);
    });
    for (int i = 0; i < static_cast<int>(design.size()); ++i) {
      const auto k = static_cast<std::size_t>(i);
      Design<Dual> seeded(design.begin(), design.end());
      seeded[k].derivatives()[0] = 1.0;
      Design<double> more = design, less = design;
      const double step = 1e-6 * design[k];
      more[k] += step;
      less[k] -= step;
      const auto dual = resolve_section(section, seeded);
      const auto upper = resolve_section(section, more), lower = resolve_section(section, less);
      expect_derivative(dual.area, upper.area, lower.area, step);
      expect_derivative(dual.inertia_y, upper.inertia_y, lower.inertia_y, step);
      expect_derivative(dual.inertia_z, upper.inertia_z, lower.inertia_z, step);
      expect_derivative(dual.torsion, upper.torsion, lower.torsion, step);
      const double change =
          std::abs(derivative_of(dual.area)) + std::abs(derivative_of(dual.inertia_y)) +
          std::abs(derivative_of(dual.inertia_z)) + std::abs(derivative_of(dual.torsion));
      EXPECT_EQ(change > 0.0, bound.count(i) == 1) << i;
    }
  }
}

/// Each about the right axis: height lies along y.
TEST(ResolvedSection, IsStifferAlongItsHeight) {
  for (const Section& section : bound_sections()) {
    const auto properties = resolve_section(section, design);
    const bool is_round = std::holds_alternative<CircleSection>(section) ||
                          std::holds_alternative<TubeSection>(section);
    const bool is_general = std::holds_alternative<GeneralSection>(section);
    if (is_round || is_general) continue;
    EXPECT_GT(properties.inertia_z, properties.inertia_y) << section.index();
    EXPECT_EQ(properties.points.front().y,
              std::holds_alternative<EllipseSection>(section) ? properties.radius_y : 0.05 / 2)
        << section.index();
  }
}

TEST(ResolvedSection, OfGivenNumbersIsThoseNumbers) {
  const GeneralSection given{1e-4, 2e-8, 3e-8, 4e-8, {{0.01, -0.02, 5.0}, {0.0, 0.03, 6.0}}};
  const auto section = resolve_section<double>(given, {});
  EXPECT_EQ(section.area, 1e-4);
  EXPECT_EQ(section.inertia_y, 2e-8);
  EXPECT_EQ(section.inertia_z, 3e-8);
  EXPECT_EQ(section.torsion, 4e-8);
  EXPECT_FALSE(section.is_round());
  ASSERT_EQ(section.points.size(), 2U);
  EXPECT_EQ(section.points[0].y, 0.01);
  EXPECT_EQ(section.points[0].z, -0.02);
  EXPECT_EQ(section.points[1].shear, 6.0);
}

double square_centimetres(const nlohmann::json& text) {
  return std::stod(text.get<std::string>()) * 1e-4;
}

/// Web and flange [mm] of EN 10365.
const std::map<std::string, std::pair<double, double>> thicknesses = {
    {"IPE 80", {3.8, 5.2}},  {"IPE 100", {4.1, 5.7}}, {"IPE 120", {4.4, 6.3}},
    {"IPE 140", {4.7, 6.9}}, {"IPE 160", {5.0, 7.4}}, {"IPE 180", {5.3, 8.0}},
    {"IPE 200", {5.6, 8.5}}};

/// The section of parts without fillets and corner radii.
Section plain_section(const std::string& name, const nlohmann::json& section) {
  if (const auto of = thicknesses.find(name); of != thicknesses.end()) {
    const nlohmann::json& corner = section.at("points").at(0);
    const auto twice = [&](const char* key) {
      return 2e-3 * std::stod(corner.at(key).get<std::string>());
    };
    return ISection{twice("z"), twice("y"), 1e-3 * of->second.second, 1e-3 * of->second.first};
  }
  double height = 0.0, width = 0.0, wall = 0.0;
  EXPECT_EQ(std::sscanf(name.c_str() + 4, "%lfx%lfx%lf", &height, &width, &wall), 3) << name;
  return BoxSection{1e-3 * width, 1e-3 * height, 1e-3 * wall};
}

/// Four digits of the catalogue, with Poisson's ratio of steel.
TEST(Catalogue, HasTheShearAreasOfItsShapes) {
  std::ifstream stream(std::string(source_folder()) + "/problems/catalogue.json");
  const nlohmann::json catalogue = nlohmann::json::parse(stream);
  int count = 0;
  for (const auto& [name, section] : catalogue.at("sections").items()) {
    if (section.at("type") != "general") continue;
    SectionProperties<double> properties{};
    properties.area = square_centimetres(section.at("area"));
    const ShearArea<double> expected =
        shear_area(plain_section(name, section), properties, 0.3, Design<double>());
    EXPECT_NEAR(square_centimetres(section.at("shear_area_y")) / expected.along_y, 1.0, 5e-4)
        << name;
    EXPECT_NEAR(square_centimetres(section.at("shear_area_z")) / expected.along_z, 1.0, 5e-4)
        << name;
    ++count;
  }
  EXPECT_EQ(count, 20);
}

}  // namespace
}  // namespace pleuel::test::initial_deflections_test
