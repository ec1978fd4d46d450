/// What a scene calls for, and nothing else: the exact list of terms and the number of coordinates.

#include "core/model/effect_estimates.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/sample_scenes.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::term_list_test {
namespace {

std::vector<std::string> terms_of(const Model& model) {
  std::vector<std::string> names;
  for (const auto& term : model.mechanism.system->terms()) names.push_back(term->name());
  return names;
}

Model model_of(ProblemFile problem) {
  Design<double> start;
  for (const DesignVariable& variable : problem.variables) start.push_back(variable.start);
  problem.effects.decisions = EffectDecisions{estimate_effects(problem), {}};
  return build_model(problem.scene, problem.effects, start, start);
}

/// Three of a frame in the plane, two of a point; three a node that is not clamped.
TEST(TermList, OfAPlanarSliderCrankHasNothingOfSpace) {
  const Model model = model_of(sample_problem("slider_crank"));
  EXPECT_THAT(terms_of(model),
              ElementsAre("inertia and elasticity of crank", "geometric stiffening of crank",
                          "inertia and elasticity of rod", "geometric stiffening of rod",
                          "inertia of slider", "joint bearing", "joint crank_pin",
                          "joint slider_pin", "joint guide"));
  EXPECT_EQ(model.mechanism.system->coordinates(), (3 + 3 * 6) + (3 + 3 * 7 - 3) + 2);
  EXPECT_EQ(model.mechanism.system->multipliers(), (2 + 1) + 2 + 2 + 1);  // with the drive
  EXPECT_TRUE(model.mechanism.rotations.empty());
}

TEST(TermList, OfASliderCrankThatIsForcedIntoSpaceHasTheSameTermsOnMoreCoordinates) {
  const Model model = model_of(sample_problem("slider_crank", {"/effects/spatial_motion=on"}));
  EXPECT_EQ(model.mechanism.system->terms().size(), 9U);
  EXPECT_EQ(model.mechanism.system->coordinates(), (6 + 6 * 6) + (6 + 6 * 7 - 6) + 3);
  EXPECT_EQ(model.mechanism.rotations.size(), 2U);  // a point mass has no orientation
}

TEST(TermList, WithoutStiffeningHasNoTermForIt) {
  const Model model =
      model_of(sample_problem("slider_crank", {"/effects/geometric_stiffening=off"}));
  EXPECT_THAT(terms_of(model),
              ElementsAre("inertia and elasticity of crank", "inertia and elasticity of rod",
                          "inertia of slider", "joint bearing", "joint crank_pin",
                          "joint slider_pin", "joint guide"));
}

TEST(TermList, OfAFourBarHasItsLoad) {
  const Model model = model_of(sample_problem("four_bar"));
  EXPECT_THAT(terms_of(model),
              ElementsAre("inertia and elasticity of crank", "geometric stiffening of crank",
                          "inertia and elasticity of coupler", "geometric stiffening of coupler",
                          "inertia and elasticity of rocker", "geometric stiffening of rocker",
                          "joint crank_bearing", "joint crank_pin", "joint rocker_pin",
                          "joint rocker_bearing", "joint force work"));
  EXPECT_EQ(model.mechanism.system->coordinates(), (3 + 9) + (3 + 12) + (3 + 12));
}

/// Nothing of the spatial slider-crank can be left out exactly.
TEST(TermList, OfASpatialMechanismHasAllOfIt) {
  const Model model = model_of(sample_problem("spatial_slider_crank"));
  EXPECT_THAT(terms_of(model),
              ElementsAre("inertia and elasticity of crank", "geometric stiffening of crank",
                          "inertia and elasticity of rod", "geometric stiffening of rod",
                          "inertia of slider", "joint bearing", "joint crank_pin",
                          "joint slider_pin", "joint guide"));
  EXPECT_EQ(model.mechanism.system->coordinates(), (6 + 2 * 6) + (6 + 4 * 6) + 6);
  EXPECT_EQ(model.mechanism.system->multipliers(), 6 + 3 + 4 + 5);
}

/// Only the rod's stress and bow are asked for: the crank may become rigid, the rod may not.
TEST(TermList, FollowsTheToleranceOfTheUser) {
  const Model model = model_of(sample_problem("slider_crank_exudyn", {"/effects/tolerance=0.05"}));
  EXPECT_THAT(terms_of(model),
              ElementsAre("inertia of crank", "inertia and elasticity of rod",
                          "geometric stiffening of rod", "inertia of slider", "joint bearing",
                          "joint crank_pin", "joint slider_pin", "joint guide"));
  EXPECT_EQ(model.body("crank").elastic_size(), 0);
  EXPECT_EQ(model.body("rod").elastic_size(), 3 * 9 - 3);
}

TEST(TermList, SaysWhatEachTermStandsFor) {
  const Model model = model_of(sample_problem("four_bar"));
  const auto& [bodies, stiffening, joints, loads] = model.terms;
  ASSERT_EQ(bodies.size(), 3U);
  ASSERT_EQ(stiffening.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(bodies[i]->name(), "inertia and elasticity of " + model.bodies[i].name);
    const auto& [body, term] = stiffening[i];
    EXPECT_EQ(term->name(), "geometric stiffening of " + model.bodies[body].name);
  }
  ASSERT_EQ(joints.size(), 4U);
  EXPECT_EQ(joints.front()->name(), "joint crank_bearing");
  ASSERT_EQ(loads.size(), 1U);
  EXPECT_EQ(loads.front()->name(), "joint force work");
}

/// Wherever the plane lies, and however many loads there are in it.
TEST(TermList, OfASceneInATiltedPlaneIsThatOfThePlane) {
  SampleScene sample = planar_sample();
  const int planar = sample.build().mechanism.system->coordinates();
  sample.effects.spatial_motion = EffectChoice::on;
  const int spatial = sample.build().mechanism.system->coordinates();
  EXPECT_LT(planar, 0.55 * spatial);
}

}  // namespace
}  // namespace pleuel::test::term_list_test
