#include "core/model/invariant_derivatives.hpp"

#include <complex>

#include "core/base/eager_matrices.hpp"
#include "core/integration/simulate.hpp"
#include "core/model/resolve_beam.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/model_state.hpp"
#include "tests/support/sample_scenes.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::invariant_derivatives_test {
namespace {

using enum InvariantDerivatives;

Number variable(int index) {
  return Number::bound(index);
}

struct NamedSection {
  const char* name;
  Section section;
  std::vector<double> sizes;
};

/// One of every type, all sizes variables.
std::vector<NamedSection> all_sections() {
  const std::vector<GeneralStressPoint> points = {{0.01, 0.01, 2e5}};
  return {
      {"rectangle", RectangleSection{variable(0), variable(1)}, {0.02, 0.03}},
      {"circle", CircleSection{variable(0)}, {0.03}},
      {"tube", TubeSection{variable(0), variable(1)}, {0.03, 0.004}},
      {"ellipse", EllipseSection{variable(0), variable(1)}, {0.02, 0.03}},
      {"box", BoxSection{variable(0), variable(1), variable(2)}, {0.03, 0.04, 0.003}},
      {"i",
       ISection{variable(0), variable(1), variable(2), variable(3)},
       {0.04, 0.08, 0.005, 0.004}},
      {"general",
       GeneralSection{variable(0), variable(1), variable(2), variable(3), points, variable(4),
                      variable(5)},
       {6e-4, 2e-8, 4.5e-8, 4.7e-8, 3e-4, 2e-4}},
  };
}

/// A beam oblique in space whose end, material and damping are variables, too: the first number
/// after the sizes of the section is the x of its end.
SampleScene beam_of(const NamedSection& named, ReferenceCondition frame, bool has_shear = false) {
  SampleScene sample;
  sample.scene = swinging_beam(0.7, named.section, 3);
  sample.effects.spatial_motion = EffectChoice::on;
  sample.design = named.sizes;
  const auto next = [&](double start) {
    sample.design.push_back(start);
    return variable(static_cast<int>(sample.design.size()) - 1);
  };
  auto& beam = std::get<BeamBody>(sample.scene.bodies[0].shape);
  beam.frame = frame;
  beam.has_shear = has_shear;
  beam.to = {next(0.6), Number(0.2), next(0.1)};
  Material& steel = sample.scene.materials[0];
  steel.young = next(2.1e11);
  steel.poisson = next(0.3);
  steel.density = next(7850.0);
  beam.damping = {next(0.5), next(1e-5)};
  return sample;
}

std::vector<DesignDerivative<Invariants<double>>> derivatives_of(
    const SampleScene& sample, const std::string& body, const InvariantDifferentiation& how) {
  return build_model(sample.scene, sample.effects, sample.design, sample.design, how)
      .body(body)
      .invariants_x;
}

/// The worst of all parts, each relative to its largest entry or, where it hardly depends on the
/// variable, to its value per relative change of it. A mean axis leaves of ∫ρS and ∫ρ p₀ S nothing
/// but round-off: there the mass counts.
double error_of(const Invariants<double>& found, const Invariants<double>& expected,
                const Invariants<double>& value, double x) {
  using I = Invariants<double>;
  const auto part = [&](auto member, double least = 0.0) {
    const auto &a = found.*member, &b = expected.*member, &c = value.*member;
    if (b.size() == 0) return 0.0;
    const double natural = std::max(c.template lpNorm<Eigen::Infinity>(), least) / std::abs(x);
    const double size = std::max(b.template lpNorm<Eigen::Infinity>(), natural);
    const double largest = (a - b).template lpNorm<Eigen::Infinity>();
    return size > 0.0 ? largest / size : largest;
  };
  const double of_mass = std::abs(found.mass - expected.mass) * std::abs(x) / value.mass;
  return std::max({of_mass, part(&I::first_moment), part(&I::second_moment),
                   part(&I::shape, value.mass), part(&I::mixed, value.mass), part(&I::moments),
                   part(&I::mass_matrix), part(&I::stiffness), part(&I::damping)});
}

/// The largest of all variables of a body.
double error_of(const SampleScene& sample, const std::string& body,
                const InvariantDifferentiation& how) {
  const Model model = sample.build();
  const BodyModel& built = model.body(body);
  const auto found = derivatives_of(sample, body, how);
  EXPECT_EQ(found.size(), built.invariants_x.size());
  double worst = 0.0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].variable, built.invariants_x[i].variable);
    const double x = sample.design[found[i].variable];
    worst =
        std::max(worst, error_of(found[i].data, built.invariants_x[i].data, built.invariants, x));
  }
  return worst;
}

/// Im I(x + iδ)/δ of the invariants in nodal coordinates, in complex arithmetic.
Invariants<double> by_complex_step(const SampleScene& sample, const BodyModel& built,
                                   int variable) {
  constexpr double tiny = 1e-40;
  Design<std::complex<double>> design(sample.design.begin(), sample.design.end());
  design[variable] += std::complex<double>(0.0, tiny);
  const auto& beam = std::get<BeamBody>(sample.scene.bodies[0].shape);
  return transform_invariants<double>(
      varied_invariants(resolve_beam(beam, built.mesh, sample.scene, design), built.coordinates,
                        RotaryInertia::included),
      [](const std::complex<double>& number) { return number.imag() / tiny; });
}

/// In nodal coordinates, as a mean axis has none of its own.
TEST(InvariantDerivatives, AreThoseOfTheComplexStepForEverySectionAndFrame) {
  for (const NamedSection& section : all_sections()) {
    for (auto frame : {ReferenceCondition::tangent, ReferenceCondition::tangent_end,
                       ReferenceCondition::chord}) {
      for (const bool has_shear : {false, true}) {
        SCOPED_TRACE(section.name);
        const SampleScene sample = beam_of(section, frame, has_shear);
        const Model model = sample.build();
        const BodyModel& built = model.body("beam");
        ASSERT_EQ(built.invariants_x.size(), sample.design.size());
        for (const auto& [variable, derivative] : built.invariants_x) {
          EXPECT_LE(error_of(derivative, by_complex_step(sample, built, variable), built.invariants,
                             sample.design[variable]),
                    1e-13);
        }
      }
    }
  }
}

/// Rigid bodies, point masses and beams with modes, whose basis is differentiated from the
/// derivatives of mass and stiffness. Central differences of single invariants are good to 1e-9;
/// a basis of modes is not differenced at all.
TEST(InvariantDerivatives, AreThoseOfDifferencesForEveryKindOfBody) {
  for (const SampleScene& sample : all_samples()) {
    SCOPED_TRACE(sample.name);
    for (const Body& body : sample.scene.bodies) {
      EXPECT_LE(error_of(sample, body.name, {central}), 1e-8) << body.name;
    }
  }
}

TEST(InvariantDerivatives, ByDifferencesErrByTheOrderOfTheirStep) {
  const SampleScene sample = beam_of(all_sections()[0], ReferenceCondition::mean_axis);
  const auto expected = derivatives_of(sample, "beam", {exact});
  const std::vector<double> steps = {4e-3, 2e-3, 1e-3};
  for (const auto& [derivatives, order] : {std::pair(forward, 1.0), std::pair(central, 2.0)}) {
    for (const std::size_t i : {0u, 1u, 2u}) {  // width, height, x of the end: not linear
      std::vector<double> errors;
      for (const double step : steps) {
        const auto found = derivatives_of(sample, "beam", {derivatives, step});
        errors.push_back(relative_difference(found[i].data.stiffness, expected[i].data.stiffness));
      }
      EXPECT_NEAR(observed_order(steps, errors), order, 0.02) << "variable " << i;
      EXPECT_LE(errors.back(), 10 * std::pow(steps.back(), order)) << "variable " << i;
    }
  }
}

/// Round-off ε/s and truncation, s or s², where they balance.
TEST(InvariantDerivatives, ByDifferencesAreGoodWithoutAGivenStep) {
  const SampleScene sample = beam_of(all_sections()[0], ReferenceCondition::chord);
  EXPECT_LE(error_of(sample, "beam", {central}), 1e-9);
  EXPECT_LE(error_of(sample, "beam", {forward}), 1e-6);
  EXPECT_GT(error_of(sample, "beam", {forward}), 1e-9);
}

/// The slider-crank of the reduced sample with its slider and a spring between nodes, all beams
/// flexible and longer in elements.
SampleScene sample_with(std::optional<int> modes, EffectChoice spatial,
                        ReferenceCondition rod_frame = ReferenceCondition::chord) {
  SampleScene sample = reduced_sample();
  sample.effects.spatial_motion = spatial;
  for (Body& body : sample.scene.bodies) {
    auto& beam = std::get<BeamBody>(body.shape);
    if (body.name == "rod") beam.frame = rod_frame;
    if (body.name == "rod" || body.name == "crank") beam.segments[0].elements = 6;
    beam.damping = {1.0, 1e-4};  // modal damping is for modes only
    if (body.name == "slider") continue;
    beam.reduction.reset();
    if (modes) beam.reduction = CraigBampton{*modes, {}};
  }
  return sample;
}

/// Places along the crank and the rod, the tips of flag and arm: one row each, a column a step.
Eigen::MatrixXd places_of(const SampleScene& sample, int* coordinates = nullptr) {
  Model model = sample.build();
  if (coordinates) *coordinates = model.mechanism.system->coordinates();
  SimulationOptions options{0.05, 5e-4, 0.8};
  options.newton_tolerance = 1e-13;
  const Trajectory trajectory = simulate(model.mechanism, options);
  Eigen::MatrixXd places(15, trajectory.steps() + 1);
  for (int step = 0; step <= trajectory.steps(); ++step) {
    const State state = trajectory.state_at(step);
    places.col(step) << position_of(model.body("crank"), state, 0.6),
        position_of(model.body("rod"), state, 0.0), position_of(model.body("rod"), state, 0.55),
        position_of(model.body("flag"), state, 0.0), position_of(model.body("arm"), state, 1.0);
  }
  return places;
}

double distance_of(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return (a - b).lpNorm<Eigen::Infinity>();
}

/// All modes span what all nodes span: only round-off differs, multiplied by what the stiffest
/// modes make of it. [m], of a mechanism of half a metre.
TEST(CraigBamptonModes, AllOfThemMoveAsAllNodesDo) {
  for (EffectChoice spatial : {EffectChoice::off, EffectChoice::on}) {
    for (auto frame : {ReferenceCondition::chord, ReferenceCondition::mean_axis}) {
      const auto full = places_of(sample_with({}, spatial, frame));
      const auto reduced = places_of(sample_with(1000, spatial, frame));
      EXPECT_LE(distance_of(reduced, full), 1e-9);
      // They do move, and bend.
      EXPECT_GE((full.col(100) - full.col(0)).lpNorm<Eigen::Infinity>(), 0.02);
    }
  }
}

/// A number means as many modes of bending in the plane, whatever else a beam can do in space.
TEST(CraigBamptonModes, OfANumberAreTheSameInSpaceAsInThePlane) {
  for (auto frame : {ReferenceCondition::chord, ReferenceCondition::mean_axis,
                     ReferenceCondition::tangent, ReferenceCondition::tangent_end}) {
    for (EffectChoice stiffening : {EffectChoice::on, EffectChoice::off}) {
      const auto places_in = [&](EffectChoice spatial) {
        SampleScene sample = sample_with(2, spatial, frame);
        sample.effects.geometric_stiffening = stiffening;
        return places_of(sample);
      };
      // Round-off, multiplied by what the stiffest modes make of it.
      EXPECT_LE(distance_of(places_in(EffectChoice::on), places_in(EffectChoice::off)), 1e-9);
    }
  }
}

/// Measured: 5.8e-6, 2.4e-7, 2.6e-8, 4.1e-9 m.
TEST(CraigBamptonModes, AFewOfThemConverge) {
  int full_size = 0;
  // Less damping than elsewhere: where it is stiff in a step for some of the modes only, starts
  // differ (core/integration/damped_start.hpp), by 1e-6 m here.
  const auto sample_of = [](std::optional<int> modes) {
    SampleScene sample = sample_with(modes, EffectChoice::off);
    for (Body& body : sample.scene.bodies) {
      std::get<BeamBody>(body.shape).damping = {1.0, 5e-5};
    }
    return sample;
  };
  const auto full = places_of(sample_of({}), &full_size);
  double previous = 1.0;
  for (int modes : {0, 1, 2, 4}) {
    int size = 0;
    const double error = distance_of(places_of(sample_of(modes), &size), full);
    EXPECT_LT(error, previous / 3) << modes << " modes";
    EXPECT_LT(size, full_size);
    previous = error;
  }
  EXPECT_LE(previous, 1e-8);
}

}  // namespace
}  // namespace pleuel::test::invariant_derivatives_test
