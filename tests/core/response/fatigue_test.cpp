#include "core/response/fatigue.hpp"

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::fatigue_test {
namespace {

constexpr FatigueCriterion criteria[] = {FatigueCriterion::goodman, FatigueCriterion::gerber,
                                         FatigueCriterion::soderberg};

/// Budynas & Nisbett, Shigley's Mechanical Engineering Design, 9th ed., example 6-10: σ_a = σ_m =
/// 8.38 kpsi, S_e = 33.9 kpsi, S_u = 100 kpsi, S_y = 84 kpsi; Gerber's factor is 3.66. Goodman's and
/// Soderberg's are 1/(8.38/33.9 + 8.38/100) = 3.02 and 1/(8.38/33.9 + 8.38/84) = 2.88.
TEST(CycleUse, IsThatOfTheTextbook) {
  const double amplitude = 8.38 / 33.9;
  EXPECT_NEAR(1.0 / cycle_use(FatigueCriterion::gerber, amplitude, 0.0838).value, 3.66, 0.005);
  EXPECT_NEAR(1.0 / cycle_use(FatigueCriterion::goodman, amplitude, 0.0838).value, 3.02, 0.005);
  EXPECT_NEAR(1.0 / cycle_use(FatigueCriterion::soderberg, amplitude, 8.38 / 84).value, 2.88,
              0.005);
}

/// What it says of a load, it says of twice the load: the factor of safety is that of the load.
TEST(CycleUse, GrowsAsTheLoadDoes) {
  for (const FatigueCriterion criterion : criteria) {
    for (const double mean : {-0.4, 0.0, 0.3}) {
      EXPECT_NEAR(cycle_use(criterion, 0.4, 2.0 * mean).value,
                  2.0 * cycle_use(criterion, 0.2, mean).value, 1e-15);
    }
  }
}

TEST(CycleUse, OfCompressiveMeanStressIsThatOfTheAmplitude) {
  for (const FatigueCriterion criterion : criteria) {
    const CycleUse use = cycle_use(criterion, 0.3, -0.7);
    EXPECT_EQ(use.value, 0.3);
    EXPECT_EQ(use.by_amplitude, 1.0);
    EXPECT_EQ(use.by_mean, 0.0);
  }
}

/// Central differences with 1e-6: errors of 1e-12, round-off of 1e-10.
TEST(CycleUse, HasTheDerivativesOfItsValue) {
  for (const FatigueCriterion criterion : criteria) {
    const CycleUse use = cycle_use(criterion, 0.3, 0.2);
    const auto value = [&](double a, double m) { return cycle_use(criterion, a, m).value; };
    EXPECT_NEAR(use.by_amplitude, (value(0.3 + 1e-6, 0.2) - value(0.3 - 1e-6, 0.2)) / 2e-6, 1e-9);
    EXPECT_NEAR(use.by_mean, (value(0.3, 0.2 + 1e-6) - value(0.3, 0.2 - 1e-6)) / 2e-6, 1e-9);
  }
}

/// Two points, whose mean counts half as much as their amplitude.
Eigen::MatrixXd two_points(const Eigen::VectorXd& time) {
  Eigen::MatrixXd values(4, time.size());
  for (Eigen::Index i = 0; i < time.size(); ++i) {
    values(0, i) = 0.2 + 0.3 * std::sin(7.0 * time(i));
    values(2, i) = 0.5 + 0.1 * std::sin(3.0 * time(i) + 0.4);
  }
  values.row(1) = 0.5 * values.row(0);
  values.row(3) = 0.5 * values.row(2);
  return values;
}

/// Goodman: 0.3 + 0.1 of the first point, 0.1 + 0.25 of the second. Parabolas through samples 0.07 of
/// a radian apart: 0.035⁴/64 of the amplitude... 1e-6.
TEST(Cycle, TakesThePointThatIsUsedMost) {
  const Eigen::VectorXd time = Eigen::VectorXd::LinSpaced(301, 0.0, 3.0);
  const Reduction goodman =
      reduce_cycle(FatigueCriterion::goodman, time, two_points(time), whole_range(time));
  EXPECT_NEAR(goodman.value, 0.4, 1e-6);
  for (const Sample& sample : goodman.samples) EXPECT_LT(sample.channel, 2);
  // 0.4 and 0.35 do not tie; the peaks of the first point do with each other.
  for (const PeakTie& tie : goodman.ties) EXPECT_LT(tie.other_channel, 2);
}

/// The samples say how the value changes with what is observed.
TEST(Cycle, IsLinearisedInItsSamples) {
  const Eigen::VectorXd time = Eigen::VectorXd::LinSpaced(61, 0.0, 3.0);
  const Eigen::MatrixXd values = two_points(time);
  Eigen::MatrixXd change(4, time.size());
  for (Eigen::Index i = 0; i < time.size(); ++i) {
    for (Eigen::Index row = 0; row < 4; ++row) {
      change(row, i) = std::cos(2.0 * time(i) + static_cast<double>(row));
    }
  }
  // Rows of one point stay proportional: what moves is the factor between them, too.
  change.row(1) = 0.5 * change.row(0) + 0.1 * values.row(0);
  change.row(3) = 0.5 * change.row(2);
  for (const FatigueCriterion criterion : criteria) {
    const auto at = [&](double s) {
      return reduce_cycle(criterion, time, values + s * change, whole_range(time)).value;
    };
    double slope = 0.0;
    for (const Sample& sample : reduce_cycle(criterion, time, values, whole_range(time)).samples) {
      slope += sample.weight * change(sample.channel, sample.step);
    }
    EXPECT_NEAR((at(1e-6) - at(-1e-6)) / 2e-6, slope, 1e-8);
  }
}

/// Mean stress that is nearly zero: Goodman's line has a kink there, Gerber's has none.
TEST(Cycle, KnowsTheKinkAtZeroMean) {
  const Eigen::VectorXd time = Eigen::VectorXd::LinSpaced(401, 0.0, 2.0 * std::numbers::pi);
  Eigen::MatrixXd values(2, time.size());
  for (Eigen::Index i = 0; i < time.size(); ++i) values(0, i) = std::sin(time(i)) + 1e-5;
  values.row(1) = values.row(0);
  const Reduction kink = reduce_cycle(FatigueCriterion::goodman, time, values, whole_range(time));
  ASSERT_EQ(kink.ties.size(), 1U);
  EXPECT_NEAR(kink.ties.front().gap, 1e-5, 1e-8);
  EXPECT_TRUE(reduce_cycle(FatigueCriterion::gerber, time, values, whole_range(time)).ties.empty());
}

// A light bar, 20 mm wide, that is pulled by F₀ + F₁ sin ωt at its end: σ = F/A all along. The
// inertia of 1 kg/m³ and vibrations of 250 kHz do not count.

constexpr double constant_force = 3000.0, force_amplitude = 2000.0;
constexpr double width = 0.02, height = 0.01, endurance = 100e6, ultimate = 400e6, yield = 250e6;

ProblemFile pulled_bar(const std::string& criterion, double constant) {
  return problem_from(fmt::format(
      R"j({{"scene": {{"gravity": [0, 0, 0],
    "materials": {{"light": {{"young": "200 GPa", "poisson": 0.3, "density": 1,
      "strength": "250 MPa", "ultimate_strength": {{"variable": "ultimate"}},
      "endurance_limit": {{"variable": "endurance"}}}}}},
    "bodies": {{"bar": {{"type": "beam", "from": [0, 0, 0], "to": [0.5, 0, 0], "elements": 2,
      "material": "light",
      "section": {{"type": "rectangle", "width": {{"variable": "width"}}, "height": "10 mm"}}}}}},
    "joints": {{"wall": {{"type": "fixed", "bodies": ["ground", "bar"], "at": [0, 0, 0]}}}},
    "loads": {{"pull": {{"type": "force", "body": "bar", "at": [0.5, 0, 0],
                         "direction": [1, 0, 0], "value": {}}},
              "shake": {{"type": "force", "body": "bar", "at": [0.5, 0, 0],
                         "direction": [1, 0, 0],
                         "value": {{"type": "harmonic", "amplitude": "2 kN",
                                    "frequency": "10 Hz"}}}}}}}},
  "effects": {{"geometric_stiffening": "off"}},
  "simulation": {{"end_time": "0.1 s", "step": "1 ms", "initial_state": "quasi-static",
                  "newton_tolerance": 1e-13}},
  "variables": {{"width": {{"start": "20 mm", "lower": "2 mm", "upper": "50 mm"}},
                 "ultimate": {{"start": "400 MPa", "lower": "1 MPa", "upper": "1 GPa"}},
                 "endurance": {{"start": "100 MPa", "lower": "1 MPa", "upper": "1 GPa"}}}},
  "responses": {{"use": {{"type": "fatigue", "body": "bar", "criterion": "{}"}}}}}})j",
      constant, criterion));
}

double use_of(const std::string& criterion, double constant) {
  const ProblemFile problem = pulled_bar(criterion, constant);
  return analyze(problem, start_design(problem))->reductions[0].value;
}

/// 1e-5: the parabola through samples that are 3.6° apart misses 1e-7 of the amplitude; axial
/// vibrations are excited by the steps.
TEST(Fatigue, OfAPulledBarIsThatOfItsMeanAndAmplitude) {
  const double area = width * height;
  const double amplitude = force_amplitude / area, mean = constant_force / area;
  const double a = amplitude / endurance, m = mean / ultimate;
  EXPECT_NEAR(use_of("goodman", constant_force), a + m, 1e-5);
  EXPECT_NEAR(use_of("soderberg", constant_force), a + mean / yield, 1e-5);
  EXPECT_NEAR(use_of("gerber", constant_force), 0.5 * (a + std::sqrt(a * a + 4.0 * m * m)), 1e-5);
}

TEST(Fatigue, OfAPressedBarIsThatOfItsAmplitude) {
  for (const char* criterion : {"goodman", "gerber", "soderberg"}) {
    EXPECT_NEAR(use_of(criterion, -constant_force), force_amplitude / (width * height) / endurance,
                1e-5);
  }
}

/// ∂(F₁/(A S_e) + F₀/(A S_u)), with respect to the width, S_u and S_e.
TEST(Fatigue, HasTheGradientOfItsClosedForm) {
  const ProblemFile problem = pulled_bar("goodman", constant_force);
  const Eigen::VectorXd x = start_design(problem);
  const auto analysis = analyze(problem, x);
  const double area = width * height;
  const double a = force_amplitude / area / endurance, m = constant_force / area / ultimate;
  const Eigen::Vector3d expected(-(a + m) / width, -m / ultimate, -a / endurance);
  for (const GradientMethod method : {GradientMethod::direct, GradientMethod::adjoint}) {
    const Eigen::VectorXd found = gradients(problem, x, *analysis, method).row(0);
    for (Eigen::Index i = 0; i < 3; ++i) {
      EXPECT_NEAR(found(i) / expected(i), 1.0, 1e-4) << problem.variables[i].name;
    }
  }
}

/// A window without the whole cycle sees less: from 0 to 25 ms the force grows from F₀ to F₀ + F₁.
TEST(Fatigue, IsThatOfTheWindow) {
  ProblemFile problem = pulled_bar("goodman", constant_force);
  problem.responses[0].to = 0.025;
  const double area = width * height, half = 0.5 * force_amplitude;
  EXPECT_NEAR(analyze(problem, start_design(problem))->reductions[0].value,
              half / area / endurance + (constant_force + half) / area / ultimate, 1e-5);
}

/// A round cantilever that is bent to and fro, 45° between its axes: σ = 32 F L/(π d³) where the
/// outline is met at 45°, not at the ends of its axes.
TEST(Fatigue, OfARoundSectionIsSeenAllAroundIt) {
  const ProblemFile problem = problem_from(R"j({"scene": {"gravity": [0, 0, 0],
    "materials": {"light": {"young": "200 GPa", "poisson": 0.3, "density": 1,
      "ultimate_strength": "400 MPa", "endurance_limit": "100 MPa"}},
    "bodies": {"bar": {"type": "beam", "from": [0, 0, 0], "to": [0.5, 0, 0], "elements": 2,
      "material": "light", "section": {"type": "circle", "diameter": "20 mm"}}},
    "joints": {"wall": {"type": "fixed", "bodies": ["ground", "bar"], "at": [0, 0, 0]}},
    "loads": {"shake": {"type": "force", "body": "bar", "at": [0.5, 0, 0],
                        "direction": [0, 1, 1], "value": {"type": "harmonic",
                        "amplitude": "100 N", "frequency": "10 Hz"}}}},
  "effects": {"geometric_stiffening": "off"},
  "simulation": {"end_time": "0.1 s", "step": "1 ms", "initial_state": "quasi-static"},
  "responses": {"use": {"type": "fatigue", "body": "bar", "criterion": "gerber"}}})j");
  const double stress = 32.0 * 100.0 * 0.5 / (std::numbers::pi * std::pow(0.02, 3));
  const auto analysis = analyze(problem, start_design(problem));
  EXPECT_NEAR(analysis->reductions[0].value, stress / 100e6, 1e-4);
  const Sample& sample = analysis->reductions[0].samples.front();
  const std::string place = analysis->responses[0].history()->signal->describe(sample.channel);
  EXPECT_TRUE(place == "node 0, 45 degrees from y to z" ||
              place == "node 0, 225 degrees from y to z")
      << place;
}

/// Amplitude and mean of a material that is given in a scene without file.
TEST(Fatigue, NeedsTheDataOfTheMaterial) {
  ProblemFile problem = pulled_bar("goodman", constant_force);
  problem.scene.materials[0].endurance_limit.reset();
  EXPECT_EQ(thrown<InputError>([&] { analyze(problem, start_design(problem)); }),
            "the response \"use\" cannot be computed: the material of \"bar\" needs an "
            "endurance limit and an ultimate strength");
}

}  // namespace
}  // namespace pleuel::test::fatigue_test
