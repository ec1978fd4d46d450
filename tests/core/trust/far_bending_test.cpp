#include "core/base/eager_matrices.hpp"
#include "core/trust/bent_beams.hpp"
#include "core/trust/check_list.hpp"
#include "tests/core/trust/trust_scenes.hpp"
#include "tests/support/at_start.hpp"
#include "tests/support/one_beam.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::far_bending_test {
namespace {

struct BentBeam : StartRun {
  explicit BentBeam(const BentCantilever& cantilever) : StartRun(cantilever.problem()) {}
  explicit BentBeam(const OneBeam& beam) : StartRun(beam.problem()) {}

  /// What more frames are told to change of a response; 0: nothing is told.
  double missing(const std::string& response) const {
    for (const VariantChange& variant : compare_variants(run()).changes) {
      if (variant.name != "more_frames") continue;
      return variant.change(static_cast<int>(response_index(problem, response)));
    }
    return 0.0;
  }
  std::vector<Finding> findings() const { return check_variants(run()); }
};

BentCantilever pushed(double alpha) {
  return {.force_y = alpha * BentCantilever::bending_stiffness};
}

double relative(double found, double exact) {
  return std::abs(found - exact) / std::abs(exact);
}

/// What is missing of deflection and shortening, against the elastica, from one and from two frames.
TEST(MoreFrames, ForetellWhatIsMissingOfTheElastica) {
  for (const int frames : {1, 2}) {
    for (const ElasticaTip& exact : {elastica_tips[0], elastica_tips[1]}) {
      BentCantilever cantilever = pushed(exact.load);
      cantilever.frames = frames;
      const BentBeam run(cantilever);
      const double deflection = exact.deflection - run.value("y"),
                   shortening = 1.0 - exact.shortening - run.value("x");
      EXPECT_NEAR(run.missing("y"), deflection, 0.2 * std::abs(deflection))
          << exact.load << " " << frames;
      EXPECT_NEAR(run.missing("x"), shortening, 0.2 * std::abs(shortening))
          << exact.load << " " << frames;
    }
  }
}

/// In space, and of a beam that twists beside bending in both planes: what sixteen frames change.
TEST(MoreFrames, ForetellWhatManyFramesChangeInSpace) {
  BentCantilever oblique;
  oblique.force_y = 40.0;
  oblique.force_z = 8.0;
  oblique.section = R"({"type": "rectangle", "width": 0.005, "height": 0.02})";
  oblique.frames = 2;
  oblique.elements = 32;
  const BentBeam run(oblique);
  oblique.frames = 32;
  const BentBeam many(oblique);
  for (const char* response : {"y", "z"}) {
    const double expected = many.value(response) - run.value(response);
    EXPECT_NEAR(run.missing(response), expected, 0.3 * std::abs(expected)) << response;
  }
}

/// Nothing is run below a rotation of 0.05 rad, nor told below 1 %; beyond 10 % it is serious.
TEST(MoreFrames, AreToldFromOnePercentAndSeriousFromTen) {
  EXPECT_THAT(compare_variants(BentBeam(pushed(0.08)).run()).changes, IsEmpty());
  EXPECT_THAT(compare_variants(BentBeam(pushed(0.12)).run()).changes, SizeIs(1));
  EXPECT_THAT(BentBeam(pushed(0.12)).findings(), IsEmpty());
  const Finding some = only(BentBeam(pushed(0.5)).findings());
  EXPECT_FALSE(some.is_serious);
  EXPECT_EQ(some.cause, Cause::not_modelled);
  BentCantilever far = pushed(2.0);
  far.stiffening = "off";
  EXPECT_TRUE(BentBeam(far).findings().front().is_serious);
}

/// The mass of the same beam in more bodies differs by round-off.
TEST(MoreFrames, ChangeNothingByRoundOff) {
  BentCantilever cantilever = pushed(1.0);
  cantilever.frames = 3;
  OneBeam beam = cantilever.beam();
  beam.responses += R"(, "mass": {"type": "mass"})";
  const BentBeam run(beam);
  EXPECT_NE(run.missing("y"), 0.0);
  EXPECT_EQ(run.missing("mass"), 0.0);
}

/// As many frames as are asked for leave an error below 1 %, and no finding.
TEST(MoreFrames, AreAsManyAsCure) {
  for (const ElasticaTip& exact : {elastica_tips[1], elastica_tips[2], elastica_tips[3]}) {
    BentCantilever cantilever = pushed(exact.load);
    cantilever.stiffening = "off";  // in one frame it finds no equilibrium that far
    const std::vector<Finding> findings = BentBeam(cantilever).findings();
    ASSERT_FALSE(findings.empty());
    const std::string& text = findings.front().text;
    const std::string key = "/scene/bodies/beam/frames to ";
    ASSERT_THAT(text, HasSubstr(key));
    cantilever.frames = std::stoi(text.substr(text.find(key) + key.size()));
    EXPECT_LE(cantilever.frames, 16);
    cantilever.stiffening = "on";
    const BentBeam cured(cantilever);
    EXPECT_LE(relative(cured.value("y"), exact.deflection), 0.01) << exact.load;
    EXPECT_TRUE(cured.findings().empty()) << cured.findings().front().text;
  }
}

/// One element a frame: the elastica is met, and nothing is said.
TEST(MoreFrames, AreNotToldOfElementsWithFramesOfTheirOwn) {
  for (const int frames : {6, 12}) {
    BentCantilever cantilever = pushed(1.0);
    cantilever.frames = cantilever.elements = frames;
    const BentBeam run(cantilever);
    EXPECT_TRUE(run.findings().empty()) << run.findings().front().text;
  }
}

/// A leaf of 1 m × 20 mm × 5 mm with a force of 8 N across its tip, which bends it by 61 mm, and one
/// along it.
std::vector<Finding> findings_of_leaf(double along, double place, int frames) {
  const OneBeam leaf{
      .name = "leaf",
      .section = rectangle(0.02, 0.005),
      .elements = 8,
      .more = fmt::format(R"("frame": "tangent", "frames": {})", frames),
      .end_loads = {{8.0}, {along, "[1, 0, 0]"}},
      .simulation = at_rest(1e-3, 1e-4),
      .responses = fmt::format(
          R"("pull": {{"type": "section-force", "body": "leaf", "at": {}, "part": "axial",
                                   "over_time": "max"}})",
          place)};
  return findings_of(leaf.problem(), check_variants);
}

/// In its middle the section is turned by ¾ · P L²/(2 EI) = 0.07 rad, which makes 0.55 N of 8 N an axial
/// force where there is none else; 1 N of 100 N is none.
TEST(MoreFrames, AreToldOfAxialForcesInTurnedSections) {
  const Finding found = only(findings_of_leaf(0.0, 0.5, 1));
  EXPECT_TRUE(found.is_serious);
  EXPECT_THAT(found.responses, ElementsAre("pull"));
  EXPECT_THAT(findings_of_leaf(100.0, 0.5, 1), IsEmpty());
  EXPECT_THAT(findings_of_leaf(0.0, 0.5, 8), IsEmpty());
}

/// Pulled by 2 % in its length.
TEST(LinearElasticity, IsLeftByLargeStretching) {
  BentCantilever cantilever;
  cantilever.force_x = 0.02 * 1.2e11 * 1e-4;  // ε E A
  const auto findings = [&] { return check_linear_elasticity(BentBeam(cantilever).run()); };
  ASSERT_THAT(findings(), SizeIs(1));
  EXPECT_THAT(findings()[0].text, HasSubstr("stretched by 2 %"));
  cantilever.force_x *= 0.49;
  EXPECT_THAT(findings(), IsEmpty());
}

/// A beam with damping of modes cannot be divided: 0.45 θ² at θ = 0.24 rad are 2.7 %.
TEST(LinearElasticity, IsLeftByFarBendingThatCannotBeDivided) {
  BentCantilever cantilever = pushed(0.5);
  cantilever.more = R"(, "reduction": {"modes": 4}, "damping": {"modal": 0.01})";
  const BentBeam run(cantilever);
  EXPECT_THAT(find_far_bending(run.run()), IsEmpty());
  const Finding finding = only(check_linear_elasticity(run.run()));
  EXPECT_TRUE(finding.is_serious);
  EXPECT_THAT(finding.text, HasSubstr("which is off by some 2.8 %"));
}

/// A deflection along the beam is one of an undivided beam only: 0.45 θ² tells, 2.7 % at 0.24 rad and
/// 0.16 % at 0.06.
TEST(MoreFrames, ThatAResponseDoesNotAllowAreJudgedByRotations) {
  const auto findings = [](double alpha) {
    const ProblemFile problem = pushed(alpha).beam().problem(
        {R"(/responses/m={"type": "deflection", "body": "beam", "at": 1,
                                            "direction": "x", "over_time": "final"})"});
    return findings_of(problem, check_variants);
  };
  const Finding far = only(findings(0.5));
  EXPECT_TRUE(far.is_serious);
  EXPECT_EQ(far.cause, Cause::not_modelled);
  EXPECT_THAT(far.text, HasSubstr("more \"frames\" would help, but the response \"m\""));
  EXPECT_THAT(findings(0.12), IsEmpty());
}

// A wire of 2 mm, clamped at one end, pulled and pushed across at the other.

ProblemFile wire(double pull, double across, int elements, const std::string& type = "stress") {
  return OneBeam{.name = "wire",
                 .section = circle(0.002),
                 .elements = elements,
                 .more = R"("frame": "tangent")",
                 .materials = plain_steel,
                 .end_loads = {{pull, "[1, 0, 0]"}, {across, "[0, -1, 0]"}},
                 .simulation = at_rest(0.01, 0.005),
                 .responses = fmt::format(
                     R"("s": {{"type": "{}", "body": "wire", "over_time": "max"}})", type)}
      .problem();
}

/// N/A + F tanh(kL)/k · c/I with k = √(N/EI) = 78/m: 645 MPa. Elements of 250 mm see 336 MPa of it,
/// and twice as many no more; those of 13 mm, 1/k, are judged by their own refinement.
TEST(TautMembers, AreDoubtedWhereElementsAreLongerThanBendingReaches) {
  const double pi = std::numbers::pi, inertia = pi * 1e-12 / 4, area = pi * 1e-6;
  const double k = std::sqrt(1000.0 / (2.1e11 * inertia));
  const double stress = 1000.0 / area + 20.0 * std::tanh(k) / k * 1e-3 / inertia;
  const auto [coarse, x, analysis] = AtStart(wire(1000.0, 20.0, 4));
  EXPECT_LT(analysis->reductions[0].value, 0.6 * stress);
  const Finding finding = only(findings_of(coarse, check_variants));
  EXPECT_TRUE(finding.is_serious);
  EXPECT_THAT(finding.text, HasSubstr("is taut"));
  EXPECT_THAT(finding.responses, ElementsAre("s"));
  EXPECT_THAT(findings_of(wire(1000.0, 20.0, 80), check_variants), IsEmpty());
}

TEST(TautMembers, AreNotDoubtedWhereBendingDoesNotCount) {
  EXPECT_THAT(findings_of(wire(1000.0, 0.0, 4), check_variants), IsEmpty());
  EXPECT_THAT(findings_of(wire(-0.1, 0.01, 4), check_variants), IsEmpty());
  EXPECT_THAT(findings_of(wire(1000.0, 20.0, 4, "elastic-energy"), check_variants), IsEmpty());
  EXPECT_THAT(findings_of(wire(1000.0, 20.0, 4, R"(stress", "part": "axial)"), check_variants),
              IsEmpty());
}

}  // namespace
}  // namespace pleuel::test::far_bending_test
