#include "core/trust/geometric_error.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "core/trust/beam_state.hpp"
#include "core/trust/bending_range.hpp"
#include "tests/support/bent_cantilever.hpp"
#include "tests/support/problem_runs.hpp"

namespace pleuel::test::geometric_error_test {
namespace {

using ::testing::HasSubstr;

struct BentBeam {
  ProblemFile problem;
  Eigen::VectorXd x;
  std::unique_ptr<Analysis> analysis;
  Monitors monitors;

  explicit BentBeam(ProblemFile file)
      : problem(std::move(file)), x(start_design(problem)), analysis(analyze(problem, x)) {}
  explicit BentBeam(const BentCantilever& cantilever) : BentBeam(cantilever.problem()) {}

  double value(const std::string& response) const {
    return analysis->reductions[response_index(problem, response)].value;
  }
  GeometricError error() const {
    State state;
    analysis->trajectory.states->load(analysis->trajectory.steps(), state);
    const BodyModel& body = analysis->model.bodies.front();
    return estimate_geometric_error(body, nodal_displacements(body, state));
  }
  std::vector<Doubt> doubts() const {
    return doubt_bending_range({problem, x, *analysis, monitors});
  }
};

BentCantilever pushed(double alpha) {
  return {.force_y = alpha * BentCantilever::bending_stiffness};
}

double relative(double found, double exact) {
  return std::abs(found - exact) / std::abs(exact);
}

/// The deflection of linear elasticity is α/3; the exact one is that of the elastica. Estimates are
/// right to leading order, within a factor of 1.5 up to 35 %.
TEST(GeometricError, OfDeflectionIsThatAgainstTheElastica) {
  for (const ElasticaTip& exact : elastica_tips) {
    BentCantilever cantilever = pushed(exact.load);
    cantilever.stiffening = "off";
    const BentBeam run(cantilever);
    const double deflection = relative(run.value("y"), exact.deflection);
    EXPECT_NEAR(run.value("y"), exact.load / 3.0, 1e-6);
    EXPECT_LT(std::abs(std::log(run.error().deflection / deflection)), std::log(1.1)) << exact.load;
  }
}

/// Geometric stiffening shortens by α²/15, in the limit of small deflections.
TEST(GeometricError, OfShorteningIsThatAgainstTheElastica) {
  for (std::size_t i : {0u, 1u}) {
    const ElasticaTip& exact = elastica_tips[i];
    const BentBeam run(pushed(exact.load));
    const double shortening = relative(1.0 - run.value("x"), exact.shortening);
    EXPECT_LT(std::abs(std::log(run.error().position / shortening)), std::log(1.2)) << exact.load;
  }
}

/// Without geometric stiffening bending shortens nothing: positions miss (1 − sin φ/φ) of the
/// length.
TEST(GeometricError, KnowsAboutMissingShortening) {
  BentCantilever cantilever;
  cantilever.moment_z = 0.3 * BentCantilever::bending_stiffness;
  cantilever.stiffening = "off";
  const BentBeam run(cantilever);
  EXPECT_NEAR(run.error().position, 1.0 - std::sin(0.3) / 0.3, 1e-3);
  EXPECT_NEAR(run.error().deflection, relative(0.15, (1.0 - std::cos(0.3)) / 0.3), 1e-3);
}

/// The same beam in other frames: against the chord, and in space, with modes.
TEST(GeometricError, IsOfTheSameSizeInSpaceAndWithModes) {
  const double alone = BentBeam(pushed(0.5)).error().deflection;
  BentCantilever spatial = pushed(0.5);
  spatial.motion = "on";
  EXPECT_NEAR(BentBeam(spatial).error().deflection, alone, 1e-3 * alone);
  BentCantilever reduced = pushed(0.5);
  reduced.more = R"(, "reduction": {"modes": 4})";
  EXPECT_NEAR(BentBeam(reduced).error().deflection, alone, 0.05 * alone);
  BentCantilever oblique;
  oblique.force_y = 0.6 * 50.0;
  oblique.force_z = 0.8 * 50.0;
  EXPECT_NEAR(BentBeam(oblique).error().deflection, alone, 0.02 * alone);
}

/// The largest relative change of what a cantilever does by so many frames: deflection, moment at the
/// root, shortening.
double change_by_frames(const BentBeam& run, BentCantilever cantilever, int frames) {
  cantilever.frames = frames;
  const BentBeam divided(cantilever);
  const auto change = [&](const char* response) {
    return relative(run.value(response), divided.value(response));
  };
  const double shortening = relative(1.0 - run.value("x"), 1.0 - divided.value("x"));
  return std::max({change("y"), change("root"), shortening});
}

/// All but that of the length, which frames leave as it is.
double largest_but_strain(GeometricError error) {
  error.strain = 0.0;
  return error.largest();
}

/// A beam that its tension holds, N L²/EI = 20 and 100: what many frames change, where an estimate
/// without the tension is some ten times too large.
TEST(GeometricError, OfATautBeamIsThatAgainstManyFrames) {
  for (const double tension : {20.0, 100.0}) {
    for (const double slope : {0.1, 0.2, 0.3}) {
      BentCantilever cantilever;
      cantilever.force_x = tension * BentCantilever::bending_stiffness;
      cantilever.force_y = slope * cantilever.force_x;
      cantilever.elements = 32;
      const BentBeam run(cantilever);
      const double expected = change_by_frames(run, cantilever, 8);
      EXPECT_LT(std::abs(std::log(largest_but_strain(run.error()) / expected)), std::log(1.6))
          << tension << " " << slope;
    }
  }
}

/// A cantilever that is pressed by a share of its buckling load π² EI/4L² and bent by a tenth of its
/// length: what many frames change of it, which grows as it comes near. An estimate without the
/// pressure falls, since less of a force bends it as far.
TEST(GeometricError, OfAPressedBeamIsThatAgainstManyFrames) {
  for (const double share : {0.3, 0.5, 0.8, 0.9}) {
    BentCantilever cantilever;
    cantilever.force_x = -share * 0.25 * 9.869604401 * BentCantilever::bending_stiffness;
    cantilever.force_y = 0.1 * 3.0 * (1.0 - share) * BentCantilever::bending_stiffness;
    cantilever.elements = 32;
    const BentBeam run(cantilever);
    const double expected = change_by_frames(run, cantilever, 16);
    EXPECT_LT(std::abs(std::log(largest_but_strain(run.error()) / expected)), std::log(2.0))
        << share;
  }
}

/// A beam as soft in shear as in bending, 3EI/(κGAL²) = 1: the estimate is what a division into 16
/// frames changes, and no shear is taken for an error.
TEST(GeometricError, OfABeamThatShearsIsThatAgainstManyFrames) {
  for (const double alpha : {0.05, 0.25, 0.5}) {
    BentCantilever cantilever = pushed(alpha);
    cantilever.stiffening = "off";
    cantilever.section = R"({"type": "general", "area": 1e-4, "inertia_y": 8.3333333333333e-10,
      "inertia_z": 8.3333333333333e-10, "torsion": 1.4e-9, "shear_area_y": 6.5e-9,
      "shear_area_z": 6.5e-9, "points": [{"y": 0.005, "z": 0.005, "shear": 0}]})";
    cantilever.more = R"(, "shear": true)";
    const BentBeam run(cantilever);
    EXPECT_NEAR(run.value("y"), 2.0 * alpha / 3.0, 1e-6);
    cantilever.frames = 16;
    const double expected = relative(run.value("y"), BentBeam(cantilever).value("y"));
    EXPECT_LT(std::abs(std::log(run.error().deflection / expected)), std::log(1.2)) << alpha;
  }
}

/// At an error of 1 % of deflection (α = 0.3) there is a doubt, at 0.3 % (α = 0.16) there is none.
TEST(BendingRange, IsLeftAtAnErrorOfOnePercent) {
  ASSERT_EQ(BentBeam(pushed(0.32)).doubts().size(), 1u);
  EXPECT_TRUE(BentBeam(pushed(0.32)).doubts().front().is_serious);
  EXPECT_TRUE(BentBeam(pushed(0.16)).doubts().empty());
  EXPECT_TRUE(BentBeam(pushed(-0.16)).doubts().empty());
  // Of the elastica: without stiffening the deflection α/3 is 1 % off at α = 0.297; with it the
  // shortening α²/15 is 1.2 % off at 0.25, 1 % at 0.23.
  const auto doubts = [](double alpha, const char* stiffening) {
    BentCantilever cantilever = pushed(alpha);
    cantilever.stiffening = stiffening;
    return BentBeam(cantilever).doubts().size();
  };
  EXPECT_EQ(doubts(0.285, "off"), 0u);
  EXPECT_EQ(doubts(0.308, "off"), 1u);
  EXPECT_EQ(doubts(0.218, "on"), 0u);
  EXPECT_EQ(doubts(0.242, "on"), 1u);
}

/// As many frames as the doubt asks for leave an error below 1 %, and no doubt.
TEST(BendingRange, NamesFramesThatCure) {
  for (const ElasticaTip& exact : {elastica_tips[1], elastica_tips[2], elastica_tips[3]}) {
    BentCantilever cantilever = pushed(exact.load);
    cantilever.stiffening = "off";  // in one frame it finds no equilibrium that far
    const std::vector<Doubt> doubts = BentBeam(cantilever).doubts();
    ASSERT_EQ(doubts.size(), 1u);
    const std::string& text = doubts.front().text;
    EXPECT_THAT(text, HasSubstr("\"beam\""));
    const std::string key = "\"frames\": ";
    cantilever.frames = std::stoi(text.substr(text.find(key) + key.size()));
    EXPECT_LE(cantilever.frames, 12);
    cantilever.stiffening = "on";
    const BentBeam cured(cantilever);
    EXPECT_LE(relative(cured.value("y"), exact.deflection), 0.01) << exact.load;
    EXPECT_TRUE(cured.doubts().empty()) << exact.load;
  }
}

/// One element a frame: the elastica's deflection and shortening are met, and nothing is said. What
/// the quadrature of an element's shortening leaves is no error of the frames.
TEST(BendingRange, IsNotLeftByElementsWithFramesOfTheirOwn) {
  for (const int frames : {6, 12}) {
    BentCantilever cantilever = pushed(1.0);
    cantilever.frames = cantilever.elements = frames;
    const BentBeam run(cantilever);
    const ElasticaTip& exact = elastica_tips[2];
    EXPECT_LT(relative(run.value("y"), exact.deflection), 1e-3) << frames;
    EXPECT_LT(relative(1.0 - run.value("x"), exact.shortening), 2e-3) << frames;
    EXPECT_TRUE(run.doubts().empty()) << run.doubts().front().text;
  }
}

/// Pulled by 2 % in its length.
TEST(BendingRange, IsLeftByLargeStretching) {
  BentCantilever cantilever;
  cantilever.force_x = 0.02 * 1.2e11 * 1e-4;  // ε E A
  const std::vector<Doubt> doubts = BentBeam(cantilever).doubts();
  ASSERT_EQ(doubts.size(), 1u);
  EXPECT_THAT(doubts.front().text, HasSubstr("stretched by 2 %"));
  cantilever.force_x *= 0.49;
  EXPECT_TRUE(BentBeam(cantilever).doubts().empty());
  cantilever.force_x *= 0.51 / 0.49;
  EXPECT_EQ(BentBeam(cantilever).doubts().size(), 1u);
}

}  // namespace
}  // namespace pleuel::test::geometric_error_test
