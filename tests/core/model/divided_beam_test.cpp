#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/model/divided_beams.hpp"
#include "core/response/monitors.hpp"
#include "sensitivity/finite_difference.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/support/at_start.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/one_beam.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::divided_beam_test {
namespace {

std::string place(const AtStart& run, const std::string& response, int channel) {
  const auto i = response_index(run.problem, response);
  return run.analysis->responses[i].history()->signal->describe(channel);
}

/// α = 1 is 10 % off in one frame. Measured against the tables of the elastica, each doubling of
/// the frames takes three quarters of the error.
TEST(DividedBeam, ConvergesToTheElasticaAtLeastAsTheSquareOfItsFrames) {
  for (const std::string motion : {"auto", "on"}) {
    const ElasticaTip& exact = elastica_tips[2];
    std::vector<double> sizes, errors;
    for (int frames : {1, 2, 4, 8}) {
      BentCantilever cantilever{.force_y = exact.load * BentCantilever::bending_stiffness};
      cantilever.frames = frames;
      cantilever.motion = motion;
      const AtStart run(cantilever.problem());
      sizes.push_back(1.0 / frames);
      errors.push_back(
          std::hypot(run.value("y") - exact.deflection, run.value("x") - (1.0 - exact.shortening)));
    }
    EXPECT_NEAR(errors.front(), 0.1 * exact.deflection, 0.02 * exact.deflection) << motion;
    EXPECT_GE(observed_order(sizes, errors), 1.8) << motion;
    EXPECT_LE(errors.back(), 4e-3 * exact.deflection) << motion;
  }
}

/// In both planes at once the deflection is the same, of a square section.
TEST(DividedBeam, BendsInAnyDirectionInSpaceAlike) {
  const ElasticaTip& exact = elastica_tips[3];
  BentCantilever cantilever;
  cantilever.frames = 8;
  cantilever.force_y = 0.6 * exact.load * BentCantilever::bending_stiffness;
  cantilever.force_z = 0.8 * exact.load * BentCantilever::bending_stiffness;
  const AtStart run(cantilever.problem());
  EXPECT_NEAR(run.value("y"), 0.6 * exact.deflection, 5e-3 * exact.deflection);
  EXPECT_NEAR(run.value("z"), 0.8 * exact.deflection, 5e-3 * exact.deflection);
  EXPECT_NEAR(run.value("x"), 1.0 - exact.shortening, 5e-3 * exact.deflection);
}

/// M L/(E I) = 1: an arc of that angle. Its moment is the same everywhere.
TEST(DividedBeam, RollsUpToAnArcUnderAMoment) {
  BentCantilever cantilever;
  cantilever.moment_z = BentCantilever::bending_stiffness;
  cantilever.frames = 8;
  const AtStart run(cantilever.problem());
  EXPECT_NEAR(run.value("x"), std::sin(1.0), 1e-3);
  EXPECT_NEAR(run.value("y"), 1.0 - std::cos(1.0), 1e-3);
  const double stress = 0.005 * 1.2e11 / 1.0;  // E (h/2) κ
  EXPECT_NEAR(run.value("stress"), stress, 1e-6 * stress);
  EXPECT_NEAR(run.value("cut"), stress, 1e-6 * stress);
}

/// Frames of every kind, whole or reduced, make one beam: the deflection is that of the axes at the
/// clamped end, whose position is (x, y).
TEST(DividedBeam, IsTheSameInFramesOfEveryKind) {
  const ElasticaTip& exact = elastica_tips[1];
  for (const std::string frame : {"tangent", "tangent-end", "chord", "mean-axis"}) {
    for (const std::string more : {"", R"(, "reduction": {"modes": 2})"}) {
      BentCantilever cantilever{.force_y = exact.load * BentCantilever::bending_stiffness};
      cantilever.frames = 4;
      cantilever.frame = frame;
      cantilever.more = more;
      ProblemFile problem = cantilever.problem();
      auto& tip =
          std::get<DeflectionResponse>(problem.responses[response_index(problem, "tip")].what);
      if (frame == "mean-axis") tip.against = DeflectionReference::chord;
      const AtStart run(problem);
      EXPECT_NEAR(run.value("y"), exact.deflection, 3e-3 * exact.deflection) << frame << more;
      // The end is where the tangent at the end and the chord pass through.
      const double expected = frame == "tangent" ? run.value("y") : 0.0;
      EXPECT_NEAR(run.value("tip"), expected, 1e-9) << frame;
    }
  }
}

/// The largest stress is at the clamp, and the two stretches that meet in the middle agree.
TEST(DividedBeam, HasOneFieldOfStress) {
  const ElasticaTip& exact = elastica_tips[1];
  BentCantilever cantilever{.force_y = exact.load * BentCantilever::bending_stiffness};
  cantilever.frames = 2;
  const AtStart run(cantilever.problem());
  EXPECT_NEAR(run.value("stress"), run.value("root"), 1e-9 * run.value("root"));
  const Eigen::MatrixXd& cut = run.analysis->histories[response_index(run.problem, "cut")];
  ASSERT_EQ(cut.rows() % 2, 0);
  const Eigen::Index half = cut.rows() / 2;
  EXPECT_LE((cut.topRows(half) - cut.bottomRows(half)).lpNorm<Eigen::Infinity>(),
            5e-3 * cut.lpNorm<Eigen::Infinity>());
  EXPECT_THAT(place(run, "cut", 0), HasSubstr("node 8 towards node 7"));
  EXPECT_THAT(place(run, "cut", static_cast<int>(half)), HasSubstr("node 8 towards node 9"));
  EXPECT_EQ(place(run, "tip", 0), "at 1 of the length");
}

/// What does not depend on frames: mass, frequencies, the load of buckling.
TEST(DividedBeam, HasTheConstantsOfTheWholeBeam) {
  const std::vector<std::string> responses = {
      R"(/responses/m={"type": "mass", "bodies": ["rod"]})",
      R"(/responses/f={"type": "frequency", "body": "rod", "mode": 1})",
      R"(/responses/b={"type": "buckling", "body": "rod", "over_time": "max-abs"})",
      "/simulation/end_time=0.02 s", "/simulation/step=1e-4 s"};
  std::vector<std::string> divided = responses;
  divided.push_back("/scene/bodies/rod/frames=3");
  const AtStart one(sample_problem("slider_crank_tapered", responses)),
      three(sample_problem("slider_crank_tapered", divided));
  EXPECT_NEAR(three.value("m"), one.value("m"), 1e-14 * one.value("m"));
  EXPECT_NEAR(three.value("f"), one.value("f"), 1e-12 * one.value("f"));
  EXPECT_NEAR(three.value("b"), one.value("b"), 1e-3 * one.value("b"));
  EXPECT_EQ(three.analysis->model.parts("rod").size(), 3u);
}

/// A stiff mechanism does not see how its beams are divided: differences are of second order in
/// elastic rotations, some 1e-3.
TEST(DividedBeam, MovesWithAMechanismAsTheWholeBeam) {
  const std::vector<std::string> quick = {"/simulation/end_time=0.06 s", "/simulation/step=1e-4 s"};
  std::vector<std::string> divided = quick;
  divided.insert(divided.end(), {"/scene/bodies/rod/frames=3", "/scene/bodies/crank/frames=2"});
  const AtStart one(sample_problem("slider_crank", quick)),
      many(sample_problem("slider_crank", divided));
  for (const char* name : {"crank_stress", "rod_stress", "rod_bow", "crank_tip", "torque_peak",
                           "torque_rms", "slider_end"}) {
    EXPECT_NEAR(many.value(name), one.value(name), 3e-3 * std::abs(one.value(name))) << name;
  }
  const Monitors monitors = monitor(many.analysis->model, many.analysis->trajectory);
  EXPECT_LE(monitors.energy_error, 1e-2);
  EXPECT_LE(monitors.position_drift, 1e-10);
}

/// Of lengths and points, sections, a load, with every response of a body.
ProblemFile designed_problem() {
  ProblemFile problem = sample_problem(
      "slider_crank",
      {"/simulation/end_time=0.02 s",
       "/simulation/step=2e-4 s",
       "/scene/bodies/rod/frames=2",
       "/scene/bodies/rod/elements=4",
       "/scene/bodies/crank/frames=2",
       "/scene/bodies/crank/elements=3",
       "/scene/bodies/crank/damping={}",
       R"(/variables/end={"start": "300 mm", "lower": "200 mm", "upper": "400 mm"})",
       R"(/variables/pin={"start": "120 mm", "lower": "100 mm", "upper": "140 mm"})",
       R"(/scene/bodies/crank/to/0={"variable": "pin"})",
       R"(/scene/bodies/rod/from/0={"variable": "pin"})",
       R"(/scene/joints/crank_pin/at/0={"variable": "pin"})",
       R"(/scene/bodies/rod/to/0={"variable": "end"})",
       R"(/scene/bodies/slider/at/0={"variable": "end"})",
       R"(/scene/joints/slider_pin/at/0={"variable": "end"})",
       R"(/scene/joints/guide/at/0={"variable": "end"})",
       R"(/responses/buckling={"type": "buckling", "body": "rod", "over_time": "rms"})",
       R"(/responses/chord={"type": "deflection", "body": "crank", "at": 0.4, "against": "chord",
            "over_time": "rms"})",
       R"(/responses/elastic={"type": "elastic-energy", "body": "rod", "over_time": "rms"})",
       R"(/responses/speed={"type": "velocity", "body": "rod", "at": 0.3, "direction": "y", "over_time": "final"})",
       R"(/responses/frequency={"type": "frequency", "body": "rod"})",
       R"(/responses/rod_stress={"type": "stress", "body": "rod", "at": 0.5, "over_time": "rms"})",
       R"(/responses/crank_stress={"type": "stress", "body": "crank", "at": 0.1, "over_time": "rms"})",
       R"(/responses/reaction={"type": "reaction-force", "joint": "crank_pin", "direction": "x",
            "over_time": "rms"})"});
  problem.simulation.newton_tolerance = 1e-13;
  return problem;
}

TEST(DividedBeam, HasExactGradients) {
  for (const bool is_spatial : {false, true}) {
    ProblemFile problem = designed_problem();
    if (is_spatial) {
      problem.effects.spatial_motion = EffectChoice::on;
      std::get<BeamBody>(problem.scene.bodies[1].shape).reduction = CraigBampton{2, {}};
    }
    const auto [x, analysis] = started(problem);
    const auto gradients_by = [&, &x = x, &analysis = analysis](GradientMethod method) {
      return Eigen::MatrixXd(gradients(problem, x, *analysis, method) * x.asDiagonal());
    };
    const Eigen::MatrixXd direct = gradients_by(GradientMethod::direct),
                          adjoint = gradients_by(GradientMethod::adjoint);
    const Eigen::MatrixXd wide = central_differences(problem, x, 2e-4) * x.asDiagonal(),
                          narrow = central_differences(problem, x, 1e-4) * x.asDiagonal();
    const Eigen::MatrixXd differences = (4.0 * narrow - wide) / 3.0;
    for (Eigen::Index i = 0; i < direct.rows(); ++i) {
      const std::string& name = problem.responses[i].name;
      const double size = direct.row(i).lpNorm<Eigen::Infinity>();
      EXPECT_LE((adjoint.row(i) - direct.row(i)).lpNorm<Eigen::Infinity>(), 1e-8 * size) << name;
      // Round-off of differences over a step of 1e-4, and their truncation.
      EXPECT_LE((differences.row(i) - direct.row(i)).lpNorm<Eigen::Infinity>(), 2e-6 * size)
          << name << is_spatial;
    }
  }
}

/// A beam that turns about its first end, on a bearing that may be driven.
ProblemFile turning_beam(int frames, const std::string& rest) {
  return problem_from(fmt::format(R"({{"name": "turning", "scene": {{"materials": {{
          "light": {{"young": 7e10, "poisson": 0.3, "density": 3000}},
          "rubber": {{"young": 5e6, "poisson": 0.45, "density": 1100}}}},
        "bodies": {{"beam": {{"type": "beam", "from": [0, 0, 0], "elements": 16, "frames": {},
          {}}})",
                                  frames, rest));
}

/// The spin-up of Kane, Ryan & Banerjee 1987: EXUDYN's geometrically exact beam gives −0.573780 m
/// at 6.75 s. One frame misses 3e-3 of it.
TEST(DividedBeam, SpinsUpAsAGeometricallyExactBeam) {
  const auto tip = [](int frames) {
    // A = 4e-4 m², I = 2e-7 m⁴: of a rectangle with height √(12 I/A)
    const double height = std::sqrt(12.0 * 2e-7 / 4e-4);
    return AtStart(
               turning_beam(frames, fmt::format(R"("to": [10, 0, 0], "material": "light", "section":
            {{"type": "rectangle", "width": {}, "height": {}}}}}}},
          "joints": {{"hub": {{"type": "revolute", "bodies": ["ground", "beam"], "at": [0, 0, 0],
            "drive": {{"type": "ramp-to-speed", "speed": 6, "ramp": 15}}}}}}}},
        "simulation": {{"end_time": 6.75, "step": 5e-3}},
        "responses": {{"tip": {{"type": "deflection", "body": "beam", "at": 1, "over_time": "final"}}}})",
                                                4e-4 / height, height)))
        .value("tip");
  };
  const double exact = -0.573780;
  EXPECT_NEAR(tip(1), exact, 4e-3 * std::abs(exact));
  EXPECT_GE(std::abs(tip(1) - exact), 1e-3 * std::abs(exact));
  EXPECT_NEAR(tip(8), exact, 3e-4 * std::abs(exact));
}

/// A pendulum of rubber that bends by half a radian: frames take their share of the rotation, and
/// the motion converges.
TEST(DividedBeam, SwingsAsAPendulumWithoutLosingEnergy) {
  std::vector<double> ends;
  for (int frames : {2, 4, 8}) {
    const AtStart run(turning_beam(frames, R"("to": [0.5, 0, 0], "material": "rubber",
          "section": {"type": "circle", "diameter": 0.02}}},
        "joints": {"pin": {"type": "revolute", "bodies": ["ground", "beam"], "at": [0, 0, 0]}},
        "gravity": [0, -9.81, 0]},
      "simulation": {"end_time": 0.3, "step": 1e-3},
      "responses": {"end": {"type": "position", "body": "beam", "at": 1, "direction": "x",
        "over_time": "final"}})"));
    ends.push_back(run.value("end"));
    const Monitors monitors = monitor(run.analysis->model, run.analysis->trajectory);
    EXPECT_LE(monitors.energy_error, 1e-2) << frames;
    EXPECT_EQ(monitors.most_bent, "beam");
  }
  EXPECT_LE(std::abs(ends[2] - ends[1]), 0.4 * std::abs(ends[1] - ends[0]));
  EXPECT_NEAR(ends[2], ends[1], 5e-3 * 0.5);
}

TEST(DividedBeam, StartsWithTheSpinOfTheWholeBeam) {
  const std::string text = R"({"name": "spin", "scene": {"gravity": [0, 0, 0],
      "bodies": {"beam": {"type": "beam", "from": [0.1, 0.2, 0], "to": [1.1, 0.2, 0],
        "material": "steel", "section": {"type": "circle", "diameter": 0.02}, "elements": 6,
        "frames": 3, "angular_velocity": [0, 0, 5], "velocity": [1, 2, 0]}},
      "loads": {"none": {"type": "force", "body": "beam", "at": [0.1, 0.2, 0],
        "direction": [1, 0, 0], "value": 0}}, "joints": {}},
    "simulation": {"end_time": 2e-5, "step": 1e-5},
    "responses": {
      "first": {"type": "velocity", "body": "beam", "at": 0, "direction": "y", "over_time": "final"},
      "last": {"type": "velocity", "body": "beam", "at": 1, "direction": "y", "over_time": "final"},
      "energy": {"type": "kinetic-energy", "body": "beam", "over_time": "max"}}})";
  const AtStart run(problem_from(text));
  EXPECT_NEAR(run.value("first"), 2.0, 1e-3);
  EXPECT_NEAR(run.value("last"), 2.0 + 5.0 * 1.0, 1e-3);  // v + ω L
}

TEST(DividedBeam, IsRefusedWhereFramesWouldChangeWhatIsMeant) {
  const auto message = [](const std::string& more) -> std::string {
    BentCantilever cantilever;
    cantilever.frames = 2;
    cantilever.more = more;
    return thrown<InputError>([&] { cantilever.problem(); });
  };
  EXPECT_THAT(message(R"(, "rigid": true)"), HasSubstr("/scene/bodies/beam/frames"));
  EXPECT_THAT(message(R"(, "damping": {"mass": 1})"), HasSubstr("\"mass\" damping"));
  EXPECT_THAT(message(R"(, "reduction": {"modes": 2}, "damping": {"modal": 0.01})"),
              HasSubstr("\"modal\" damping"));
  EXPECT_EQ(message(R"(, "damping": {"stiffness": 1e-5})"), "");
}

/// Two elements in three frames: each element is divided into two, and joints within the beam hold
/// on to the stretch that they lie on.
TEST(DividedBeam, HasAnElementAFrameAndItsJointsWhereTheyAre) {
  BentCantilever cantilever;
  cantilever.force_y = 1.0;
  cantilever.frames = 3;
  cantilever.elements = 2;
  ProblemFile problem = cantilever.problem();
  std::get<PointLoad>(problem.scene.loads.front().element).at = {0.5, 0.0, 0.0};
  const DividedScene divided = divide_beams(problem.scene, problem.effects, {});
  ASSERT_EQ(divided.scene.bodies.size(), 3u);
  EXPECT_EQ(divided.divisions, 2);
  int elements = 0;
  for (const Body& body : divided.scene.bodies) {
    const auto& part = std::get<BeamBody>(body.shape);
    EXPECT_EQ(name_in_scene(body), "beam");
    EXPECT_GE(part.segments.front().elements, 1);
    elements += part.segments.front().elements;
  }
  EXPECT_EQ(elements, 4);
  const auto& load = std::get<PointLoad>(divided.scene.loads.front().element);
  const auto holder = std::find_if(divided.scene.bodies.begin(), divided.scene.bodies.end(),
                                   [&](const Body& body) { return body.name == load.body; });
  ASSERT_NE(holder, divided.scene.bodies.end());
  const BeamPart& part = *std::get<BeamBody>(holder->shape).part;
  EXPECT_LE(part.begin, 0.5);
  EXPECT_GE(part.end, 0.5);
}

}  // namespace
}  // namespace pleuel::test::divided_beam_test
