#include "core/base/eager_matrices.hpp"
#include "core/response/effect_measurement.hpp"
#include "core/trust/check_list.hpp"
#include "core/trust/resolution.hpp"
#include "tests/core/trust/trust_scenes.hpp"
#include "tests/support/at_start.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::model_variants_test {
namespace {

// Stress that the file leaves out with axial elasticity.

/// A clamped bar of 20 mm × 20 mm, drawn by 4 kN and bent by a force across its end.
ProblemFile bar(double across, const std::string& axial) {
  return OneBeam{
      .name = "bar",
      .to = "[0.5, 0, 0]",
      .materials = plain_steel,
      .end_loads = {{4000.0, "[1, 0, 0]"}, {across, "[0, -1, 0]"}},
      .simulation = at_rest(0.01, 0.005),
      .responses = R"("s": {"type": "stress", "body": "bar", "over_time": "max"})",
      .rest = fmt::format(
          R"("effects": {{"axial_elasticity": "{}", "geometric_stiffening": "off"}})", axial)}
      .problem();
}

/// N/A = 10 MPa beside the bending stress F L/W = 3.75 MPa for 10 N.
TEST(AxialElasticity, IsMissedWhereStressComesFromIt) {
  const StartRun run(bar(10.0, "off"));
  EXPECT_NEAR(run.analysis->reductions[0].value, 3.75e6, 1e-3 * 3.75e6);
  const LeftOut found = compare_variants(run.run());
  ASSERT_EQ(found.changes.size(), 1u);
  EXPECT_EQ(found.changes[0].name, "axial_elasticity");
  EXPECT_NEAR(found.changes[0].change(0), 10e6, 1e-3 * 10e6);
  ASSERT_EQ(found.findings.size(), 1u);
  EXPECT_TRUE(found.findings[0].is_serious);
  EXPECT_THAT(found.findings[0].responses, ElementsAre("s"));
  EXPECT_THAT(found.findings[0].text, HasSubstr("would change \"s\" by 73 %"));
}

TEST(AxialElasticity, IsNotMissedWhereItIsThere) {
  EXPECT_THAT(findings_of(bar(10.0, "on"), check_variants), IsEmpty());
}

using testing::Contains;
using testing::Field;

/// The first angular frequency of a steel cantilever of 400 × 20 × 8 mm, which a force at its tip
/// has.
constexpr double frequency = 262.48526926, ratio = 0.02;

ProblemFile shaken(double force, const std::string& damping) {
  const double period = 2.0 * std::numbers::pi / frequency;
  return OneBeam{
      .to = "[0.4, 0, 0]",
      .section = rectangle(0.02, 0.008),
      .elements = 8,
      .more = R"("reduction": {"modes": 4}, "damping": )" + damping,
      .end_loads = {{fmt::format(R"({{"type": "harmonic", "amplitude": {}, "frequency": {}}})",
                                 force, frequency)}},
      .simulation = time_loop(period, period / 400.0, R"("initial_state": "periodic")"),
      .responses =
          R"("tip": {"type": "deflection", "body": "beam", "at": 1, "over_time": "max-abs"})"}
      .problem();
}

double tip(const ProblemFile& problem) {
  return analyze(problem, start_design(problem))->reductions.front().value;
}

const std::string by_modes = fmt::format(R"({{"modal": {}}})", ratio);
/// The same ratio of the first mode: ζ = ω β/2.
const std::string by_stiffness = fmt::format(R"({{"stiffness": {}}})", 2.0 * ratio / frequency);

/// At its resonance the tip goes as far as damping lets it: by what the two differ, damping by
/// modes is too much. With a force of a tenth both are the same, and nothing is said.
TEST(ModalDamping, OfABeamThatBendsFarIsTold) {
  const Finding found = only(findings_of(shaken(8.0, by_modes), check_modal_damping));
  EXPECT_THAT(found.text, HasSubstr("some 8 % too much"));
  EXPECT_THAT(findings_of(shaken(8.0, by_modes)),
              Contains(Field(&Finding::text, HasSubstr("some 8 % too much"))));
  EXPECT_NEAR(tip(shaken(8.0, by_stiffness)) / tip(shaken(8.0, by_modes)), 1.08, 0.01);
  EXPECT_THAT(findings_of(shaken(8.0, by_stiffness), check_modal_damping), IsEmpty());
  EXPECT_THAT(findings_of(shaken(0.8, by_modes), check_modal_damping), IsEmpty());
  EXPECT_NEAR(tip(shaken(0.8, by_stiffness)) / tip(shaken(0.8, by_modes)), 1.0, 2e-3);
}

// Stiffening that goes with axial elasticity, and buckling of what a tolerance makes rigid.

/// A pull of 200 N on a rod of 5 mm, 0.3 m long, with 1 N across its middle: of its Euler load
/// π² E I/L² = 706 N 28 %, so that it bends by 1/1.28 of what it would bend by without the pull.
TEST(LostStiffening, IsADoubtWhereAxialForcesAreLarge) {
  const auto findings_at = [](double force) {
    return findings_of(
        OneBeam{.name = "rod",
                .to = "[0.3, 0, 0]",
                .section = circle(0.005),
                .elements = 4,
                .more = R"("frame": "chord")",
                .materials = plain_steel,
                .joints = on_two_supports("rod", "[0.3, 0, 0]"),
                .end_loads = {{force, "[1, 0, 0]"}},
                .loads = R"("push": {"type": "force", "body": "rod", "at": [0.15, 0, 0],
                                     "direction": [0, 1, 0], "value": 1})",
                .simulation = at_rest(0.002, 0.001),
                .responses = R"("bow": {"type": "deflection", "body": "rod", "at": 0.5,
                                        "over_time": "max"})",
                .rest = R"("effects": {"axial_elasticity": "off"})"}
            .problem(),
        check_variants);
  };
  const double pi = 3.14159265358979, radius = 0.0025;
  const double euler = pi * pi * 2.1e11 * pi / 4 * std::pow(radius, 4) / (0.3 * 0.3);
  EXPECT_THAT(findings_at(0.0098 * euler), IsEmpty());
  EXPECT_FALSE(only(findings_at(0.0102 * euler)).is_serious);
  const Finding finding = only(findings_at(200.0));
  EXPECT_TRUE(finding.is_serious);
  EXPECT_THAT(finding.text, HasSubstr("cannot be stretched"));
  EXPECT_THAT(finding.text, HasSubstr("\"bow\" by 28 %"));
}

/// A square column of 1 m × 10 mm, clamped, pressed slowly at its tip, which moves by less than 1e-3 of
/// its length: no response calls for its elasticity.
ProblemFile pressed_column(double force, const char* spatial_motion, double tolerance) {
  ProblemFile problem =
      OneBeam{
          .name = "bar",
          .material = "light",
          .section = rectangle(0.01, 0.01),
          .elements = 6,
          .more = R"("damping": {"stiffness": 1e-4})",
          .materials = light,
          .end_loads = {{fmt::format(R"({{"type": "ramp", "to": {}, "end": 0.05}})", force),
                         "[-1, 0, 0]"}},
          .simulation = time_loop(0.05, 0.0025),
          .responses =
              R"("tip": {"type": "position", "body": "bar", "at": 1, "direction": "x", "over_time": "final"})",
          .rest = fmt::format(R"("effects": {{"spatial_motion": "{}", "tolerance": {}}})",
                              spatial_motion, tolerance)}
          .problem();
  decide_effects(problem);
  return problem;
}

/// What is said of buckling, without how far disturbances grow: what is left out is looked for at twice
/// the step, which damps them less.
std::vector<std::string> buckling_of(const std::vector<Finding>& findings) {
  std::vector<std::string> texts = texts_of(findings);
  std::erase_if(texts,
                [](const std::string& text) { return text.find("buckle") == std::string::npos; });
  for (std::string& text : texts) text.resize(std::min(text.size(), text.find(" In this motion")));
  return texts;
}

/// A cantilever buckles at π² EI/4L².
TEST(BucklingOfWhatIsLeftOut, IsThatOfTheCompleteMechanism) {
  const double critical = std::pow(std::numbers::pi / 2, 2) * 2.1e11 * 1e-8 / 12;
  for (const char* spatial_motion : {"auto", "on"}) {
    for (double share : {0.6, 1.02}) {
      const auto [lean, x, analysis] =
          AtStart(pressed_column(share * critical, spatial_motion, 1e-2));
      EXPECT_FALSE(analysis->model.bodies[0].is_elastic);
      const std::vector<std::string> told =
          buckling_of(check_run(lean, start_design(lean), *analysis));
      EXPECT_EQ(told,
                buckling_of(findings_of(pressed_column(share * critical, spatial_motion, 0.0))));
      EXPECT_EQ(told.empty(), share < 1.0) << spatial_motion << " " << share;
    }
  }
}

// Energy that is missing.

/// Of the largest energy, one percent may be missing.
TEST(EnergyBalance, IsDoubtedAboveOnePercent) {
  const auto [problem, x, analysis] = AtStart(read_scene(crank_rocker(driven, closed)));
  Monitors monitors = monitor(analysis->model, analysis->trajectory);
  monitors.energy_error = 0.0098;
  EXPECT_THAT(check_energy_balance(TrustedRun{problem, x, *analysis, monitors}), IsEmpty());
  monitors.energy_error = 0.0102;
  const Finding finding = only(check_energy_balance(TrustedRun{problem, x, *analysis, monitors}));
  EXPECT_THAT(finding.text, HasSubstr("balanced to 1 % of"));
}

/// What does not move has no energy to be balanced: the last digits of its potential are none.
TEST(EnergyBalance, IsNotDoubtedWhereNothingMoves) {
  const ProblemFile problem = OneBeam{.to = "[0.0525, -0.3823, 0.2024]",
                                      .section = circle(0.02),
                                      .elements = 1,
                                      .more = R"("rigid": true)",
                                      .gravity = "[1.336, 8.616, -4.495]",
                                      .simulation = time_loop(0.15, 0.0007673)}
                                  .problem();
  EXPECT_THAT(findings_of(problem, check_energy_balance), IsEmpty());
}

/// An error of a small vibration is not hidden by where a scene stands.
TEST(EnergyBalance, IsAskedOfSmallMotionsFarFromTheOrigin) {
  const auto error_at = [](double height) {
    const auto [problem, x, analysis] = AtStart(read_scene(fmt::format(
        R"({{"scene": {{"gravity": [0, -9.81, 0],
              "bodies": {{"block": {{"type": "rigid", "at": [0, {0}, 0], "mass": 1,
                                    "inertia": [1, 1, 1, 0, 0, 0], "velocity": [1e-3, 0, 0]}}}},
              "joints": {{"guide": {{"type": "prismatic", "bodies": ["ground", "block"],
                                    "at": [0, {0}, 0], "axis": [1, 0, 0]}}}},
              "loads": {{"spring": {{"type": "joint", "joint": "guide", "stiffness": 1e4}}}}}},
            "simulation": {{"end_time": 0.2, "step": 0.01, "spectral_radius": 0.5}},
            "responses": {{"mass": {{"type": "mass"}}}}}})",
        height)));
    return monitor(analysis->model, analysis->trajectory).energy_error;
  };
  const double near = error_at(0.0);
  EXPECT_GT(near, 0.02);
  EXPECT_NEAR(error_at(1000.0), near, 0.01 * near);
}

/// A shaft along x in two bearings, 100 mm apart, with a pull along y beyond the second one.
std::vector<Finding> findings(const std::string& first, const std::string& second,
                              const std::string& more = "") {
  const ProblemFile shaft = read_scene(fmt::format(
      R"({{"scene": {{"gravity": [0, 0, 0], "bodies": {{
            "shaft": {{"type": "rigid", "at": [0.05, 0, 0], "mass": 1, "inertia": [1e-3, 2e-3, 2e-3, 0, 0, 0]}}}},
          "joints": {{"one": {}, "other": {}}},
          "loads": {{"belt": {{"type": "force", "body": "shaft", "at": [0.13, 0, 0],
                               "direction": [0, 1, 0], "value": 500}}}}}},
          "simulation": {{"end_time": 0.01, "step": 0.001}},
          "responses": {{
            "one": {{"type": "reaction-force", "joint": "one", "direction": "y", "over_time": "final"}},
            "other": {{"type": "reaction-force", "joint": "other", "direction": "y", "over_time": "final"}},
            "speed": {{"type": "angular-velocity", "body": "shaft", "direction": "x",
                       "over_time": "max-abs"}}}}{}}})",
      first, second, more));
  return findings_of(shaft, check_undetermined_reactions);
}

std::string bearing(const std::string& type, double at) {
  const std::string axis = type == "spherical" ? "" : R"(, "axis": [1, 0, 0])";
  return fmt::format(R"({{"type": "{}", "bodies": ["ground", "shaft"], "at": [{}, 0, 0]{}}})", type,
                     at, axis);
}

/// Two hinges hold the tilt of the shaft twice: 650 and −150 N follow only where each holds forces
/// alone.
TEST(UndeterminedReactions, OfTwoHingesAreTold) {
  const Finding found = only(findings(bearing("revolute", 0.1), bearing("revolute", 0.0)));
  EXPECT_THAT(found.responses, UnorderedElementsAre("one", "other"));
  EXPECT_FALSE(found.is_serious);
  // Also where a limit asks for another number.
  EXPECT_THAT(findings(bearing("revolute", 0.1), bearing("revolute", 0.0),
                       R"(, "constraints": {"slow": {"response": "speed", "upper": 1}})"),
              SizeIs(1));
  // Nor where only one of them holds the tilt, and the other one the way of its end.
  EXPECT_THAT(findings(bearing("revolute", 0.1), bearing("spherical", 0.0)), SizeIs(1));
}

TEST(UndeterminedReactions, AreNoneOfBearingsThatHoldForces) {
  EXPECT_THAT(findings(bearing("point-on-line", 0.1), bearing("spherical", 0.0)), IsEmpty());
}

}  // namespace
}  // namespace pleuel::test::model_variants_test
