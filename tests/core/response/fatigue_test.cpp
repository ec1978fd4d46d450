#include "core/response/fatigue.hpp"

#include <array>
#include <map>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/response/fatigue.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/support/at_start.hpp"
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
    const CycleValue use = cycle_use(criterion, 0.3, -0.7);
    EXPECT_EQ(use.value, 0.3);
    EXPECT_EQ(use.by_amplitude, 1.0);
    EXPECT_EQ(use.by_mean, 0.0);
  }
}

/// Central differences with 1e-6: errors of 1e-12, round-off of 1e-10.
TEST(CycleUse, HasTheDerivativesOfItsValue) {
  for (const FatigueCriterion criterion : criteria) {
    const CycleValue use = cycle_use(criterion, 0.3, 0.2);
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
    "bodies": {{"bar": {{"type": "beam", "from": [0, 0, 0], "to": [0.5, 0, 0], "elements": 2, "material": "light",
      "section": {{"type": "rectangle", "width": {{"variable": "width"}}, "height": "10 mm"}}}}}},
    "joints": {{"wall": {{"type": "fixed", "bodies": ["ground", "bar"], "at": [0, 0, 0]}}}},
    "loads": {{"pull": {{"type": "force", "body": "bar", "at": [0.5, 0, 0], "direction": [1, 0, 0], "value": {}}},
              "shake": {{"type": "force", "body": "bar", "at": [0.5, 0, 0], "direction": [1, 0, 0],
                         "value": {{"type": "harmonic", "amplitude": "2 kN", "frequency": "10 Hz"}}}}}}}},
  "effects": {{"geometric_stiffening": "off"}},
  "simulation": {{"end_time": "0.1 s", "step": "1 ms", "initial_state": "quasi-static", "newton_tolerance": 1e-13}},
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
  const auto [problem, x, analysis] = AtStart(pulled_bar("goodman", constant_force));
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

/// ASTM E1049-85 (2017), figure 6, the example of 5.4.4: peaks and valleys A … I; one cycle EF of
/// range 4, and half cycles AB 3, BC 4, CD 8, DG 9, GH 8, HI 6.
TEST(Rainflow, CountsTheExampleOfTheStandard) {
  const std::vector<double> turning = {-2, 1, -3, 5, -1, 3, -4, 4, -2};
  const std::vector<std::array<double, 3>> expected = {
      {0, 1, 0.5}, {1, 2, 0.5}, {4, 5, 1.0}, {2, 3, 0.5}, {3, 6, 0.5}, {6, 7, 0.5}, {7, 8, 0.5}};
  const std::vector<CountedCycle> found = count_rainflow(turning);
  ASSERT_EQ(found.size(), expected.size());
  std::map<double, double> counts;  // by range
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(static_cast<double>(found[i].from), expected[i][0]);
    EXPECT_EQ(static_cast<double>(found[i].to), expected[i][1]);
    EXPECT_EQ(found[i].count, expected[i][2]);
    counts[std::abs(turning[found[i].to] - turning[found[i].from])] += found[i].count;
  }
  EXPECT_EQ(counts, (std::map<double, double>{{3, 0.5}, {4, 1.5}, {6, 0.5}, {8, 1.0}, {9, 0.5}}));
}

/// Every range between neighbours is counted: of n turning points n − 1 halves.
TEST(Rainflow, CountsEverythingOnce) {
  std::vector<double> turning;
  for (int i = 0; i < 200; ++i) turning.push_back((i % 2 == 0 ? 1.0 : -1.0) * (1 + (i * 37) % 83));
  double halves = 0.0;
  for (const CountedCycle& cycle : count_rainflow(turning)) halves += 2.0 * cycle.count;
  EXPECT_EQ(halves, 199.0);
}

/// The same history as samples with steps between them that are no turning points: Basquin's line
/// with k = 3 and no mean stress: D = Σ n · 2 (range/2/s)³. Peaks are samples: triangles have breaks.
TEST(Damage, IsTheSumOverTheCountedCycles) {
  const std::vector<double> turning = {-2, 1, -3, 5, -1, 3, -4, 4, -2};
  Eigen::VectorXd time = Eigen::VectorXd::LinSpaced(33, 0.0, 32.0);
  Eigen::MatrixXd values = Eigen::MatrixXd::Zero(2, 33);
  BrokenInstants breaks(33, false);
  for (Eigen::Index i = 0; i < 33; ++i) {
    const auto k = static_cast<std::size_t>(i / 4);
    const double share = static_cast<double>(i % 4) / 4.0;
    const double next = k + 1 < turning.size() ? turning[k + 1] : 0.0;
    values(0, i) = ((1.0 - share) * turning[k] + share * next) / 10.0;
    breaks[static_cast<std::size_t>(i)] = i % 4 == 0;
  }
  double expected = 0.0;
  for (const auto& [range, count] : {std::pair(3, 0.5), {4, 1.5}, {6, 0.5}, {8, 1.0}, {9, 0.5}}) {
    expected += count * 2.0 * std::pow(range / 20.0, 3);
  }
  EXPECT_NEAR(
      reduce_damage(FatigueCriterion::goodman, 3.0, time, values, whole_range(time), breaks).value,
      expected, 1e-15);
}

Eigen::MatrixXd waves(const Eigen::VectorXd& time) {
  Eigen::MatrixXd values(4, time.size());
  for (Eigen::Index i = 0; i < time.size(); ++i) {
    const double t = time(i);
    values(0, i) = 0.1 + 0.3 * std::sin(7.0 * t) + 0.15 * std::sin(19.0 * t + 0.5);
    values(2, i) = 0.2 * std::sin(3.0 * t + 0.4) - 0.1 * std::cos(11.0 * t);
  }
  values.row(1) = 0.6 * values.row(0);
  values.row(3) = 0.6 * values.row(2);
  return values;
}

/// One turn of a motion that repeats itself, begun at any of its samples. Whole cycles by hand: of
/// 0, 6, 2, 4, −4, 1, −1 one each of the ranges 10 (6 … −4), 2 (2 … 4) and 2 (1 … −1).
TEST(Damage, OfAMotionThatRepeatsItselfDoesNotDependOnItsBeginning) {
  const std::vector<double> turn = {0, 6, 2, 4, -4, 1, -1};
  const auto samples = static_cast<Eigen::Index>(2 * turn.size());
  const Eigen::VectorXd time = Eigen::VectorXd::LinSpaced(samples + 1, 0.0, 14.0);
  const BrokenInstants breaks(static_cast<std::size_t>(samples + 1), true);
  const double expected = 2.0 * (std::pow(0.5, 3) + 2.0 * std::pow(0.1, 3));
  for (Eigen::Index shift = 0; shift < samples; ++shift) {
    Eigen::MatrixXd values = Eigen::MatrixXd::Zero(2, samples + 1);
    for (Eigen::Index i = 0; i <= samples; ++i) {
      const auto at = static_cast<std::size_t>((i + shift) % samples);
      const double here = turn[at / 2], next = turn[(at / 2 + 1) % turn.size()];
      values(0, i) = (at % 2 == 0 ? here : 0.5 * (here + next)) / 10.0;
    }
    const auto damage = [&](RangeEnds ends) {
      return reduce_damage(FatigueCriterion::goodman, 3.0, time, values, whole_range(time), breaks,
                           ends)
          .value;
    };
    EXPECT_NEAR(damage(RangeEnds::repeating), expected, 1e-15) << shift;
    EXPECT_LE(damage(RangeEnds::cut), expected * (1.0 + 1e-12)) << shift;
  }
}

/// Peaks between samples, also across the end of the turn: 2 (σ_a/σ_f')^k of each phase.
TEST(Damage, OfASineThatRepeatsItselfIsThatOfOneCycle) {
  for (const double phase : {0.0, 0.01, 0.7, 1.5707, 3.0}) {
    const Eigen::VectorXd time = Eigen::VectorXd::LinSpaced(101, 0.0, 2.0);
    Eigen::MatrixXd values = Eigen::MatrixXd::Zero(2, 101);
    for (Eigen::Index i = 0; i < 101; ++i) {
      values(0, i) = 0.3 * std::sin(std::numbers::pi * time(i) + phase);
    }
    values.col(100) = values.col(0);
    const double found = reduce_damage(FatigueCriterion::goodman, 4.0, time, values,
                                       whole_range(time), {}, RangeEnds::repeating)
                             .value;
    EXPECT_NEAR(found / (2.0 * std::pow(0.3, 4)), 1.0, 1e-6) << phase;
  }
}

/// Central differences: 1e-6 of the change, errors of 1e-12 and round-off of 1e-10.
TEST(Damage, IsLinearisedInItsSamples) {
  const Eigen::VectorXd time = Eigen::VectorXd::LinSpaced(121, 0.0, 3.0);
  const Eigen::MatrixXd values = waves(time);
  Eigen::MatrixXd change(4, time.size());
  for (Eigen::Index i = 0; i < time.size(); ++i) {
    change(0, i) = std::cos(5.0 * time(i));
    change(2, i) = std::sin(5.0 * time(i));
  }
  change.row(1) = 0.6 * change.row(0) + 0.1 * values.row(0);
  change.row(3) = 0.6 * change.row(2);
  for (const auto& [criterion, ends] : {std::pair(FatigueCriterion::goodman, RangeEnds::cut),
                                        {FatigueCriterion::gerber, RangeEnds::cut},
                                        {FatigueCriterion::gerber, RangeEnds::repeating}}) {
    const auto reduced = [&, criterion = criterion, ends = ends](double s) {
      return reduce_damage(criterion, 5.0, time, values + s * change, whole_range(time), {}, ends);
    };
    const auto at = [&](double s) { return reduced(s).value; };
    const Reduction found = reduced(0.0);
    double slope = 0.0;
    for (const Sample& sample : found.samples) {
      slope += sample.weight * change(sample.channel, sample.step);
    }
    ASSERT_GT(found.value, 0.0);
    EXPECT_NEAR((at(1e-6) - at(-1e-6)) / 2e-6 / slope, 1.0, 1e-7);
  }
}

/// A light bar that is pulled by F₀ + F₁ sin(ωt + phase).
/// @param simulation  its time, step and start
ProblemFile pulled_bar(const std::string& simulation, const std::string& phase) {
  ProblemFile problem = problem_from(R"j({"scene": {"gravity": [0, 0, 0],
    "materials": {"light": {"young": "200 GPa", "poisson": 0.3, "density": 1,
      "ultimate_strength": "400 MPa", "fatigue_strength": "900 MPa", "fatigue_exponent": 8}},
    "bodies": {"bar": {"type": "beam", "from": [0, 0, 0], "to": [0.5, 0, 0], "elements": 1, "material": "light",
      "section": {"type": "rectangle", "width": {"variable": "width"}, "height": "10 mm"}}},
    "joints": {"wall": {"type": "fixed", "bodies": ["ground", "bar"], "at": [0, 0, 0]}},
    "loads": {"pull": {"type": "force", "body": "bar", "at": [0.5, 0, 0], "direction": [1, 0, 0], "value": "20 kN"},
              "shake": {"type": "force", "body": "bar", "at": [0.5, 0, 0], "direction": [1, 0, 0],
                        "value": {"type": "harmonic", "amplitude": "40 kN", "frequency": "10 Hz",
                                  "phase": ")j" +
                                     phase + R"j("}}}},
  "effects": {"geometric_stiffening": "off"},
  "simulation": {"newton_tolerance": 1e-13, )j" +
                                     simulation + R"j(},
  "variables": {"width": {"start": "20 mm", "lower": "2 mm", "upper": "50 mm"}},
  "responses": {"damage": {"type": "fatigue-damage", "body": "bar", "criterion": "goodman"}}})j");
  return problem;
}

/// Of a cycle: 2 (σ_ar/s)^k with Goodman's σ_ar = σ_a/(1 − σ_m/S_u).
double bar_damage(double width) {
  const double area = width * 0.01, full = 40e3 / area / (1.0 - 20e3 / area / 400e6);
  return 2.0 * std::pow(full / 900e6, 8);
}

void expect_damage(const ProblemFile& problem, double cycles) {
  const auto [x, analysis] = started(problem);
  // Eight times the 1e-5 of vibrations in the stress.
  EXPECT_NEAR(analysis->reductions[0].value / (cycles * bar_damage(0.02)), 1.0, 1e-4);
  const double slope = cycles * (bar_damage(0.02 + 1e-7) - bar_damage(0.02 - 1e-7)) / 2e-7;
  for (const GradientMethod method : {GradientMethod::direct, GradientMethod::adjoint}) {
    EXPECT_NEAR(gradients(problem, x, *analysis, method)(0, 0) / slope, 1.0, 1e-3);
  }
}

/// Of four periods one whole cycle less closes, the rest are halves; all have one range.
TEST(Damage, OfAPulledBarIsThatOfItsCycles) {
  expect_damage(
      pulled_bar(R"("end_time": "0.4 s", "step": "1 ms", "initial_state": "quasi-static")",
                 "90 deg"),
      4.0);
}

/// The steady state of one period is one cycle, wherever it begins; so is a window of it.
TEST(Damage, OfASteadyStateIsThatOfAWholeCycle) {
  for (const char* phase : {"90 deg", "0 deg", "200 deg"}) {
    SCOPED_TRACE(phase);
    expect_damage(
        pulled_bar(R"("end_time": "0.1 s", "step": "1 ms", "initial_state": "periodic")", phase),
        1.0);
    ProblemFile window = pulled_bar(
        R"("end_time": "0.3 s", "step": "1 ms", "initial_state": {"type": "periodic", "period": "0.1 s"})",
        phase);
    window.responses[0].from = 0.05;
    window.responses[0].to = 0.25;
    expect_damage(window, 2.0);
  }
}

}  // namespace
}  // namespace pleuel::test::fatigue_test
