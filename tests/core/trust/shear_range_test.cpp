#include "core/base/eager_matrices.hpp"
#include "core/section/section_properties.hpp"
#include "tests/core/trust/trust_scenes.hpp"
#include "tests/support/at_start.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::shear_range_test {
namespace {

using namespace sheared_beam;

/// Timoshenko: P L³/(3EI) + P L/(κGA), and P L³/(48EI) + P L/(4κGA).
TEST(ShearShare, IsThatOfTimoshenkosClosedForm) {
  for (const double size : {0.05, 0.2, 0.5}) {
    for (const bool is_round : {false, true}) {
      const double kappa =
          is_round ? 6.0 * (1.0 + nu) / (7.0 + 6.0 * nu) : 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu);
      // EI/(κGA) with I/A = h²/12 or d²/16
      const double ratio = 2.0 * (1.0 + nu) / kappa * size * size / (is_round ? 16.0 : 12.0);
      const std::string section =
          is_round ? fmt::format(R"({{"type": "circle", "diameter": {}}})", size) : rectangle(size);
      for (const int frames : {1, 2}) {
        LoadedBeam beam{section};
        beam.response = R"({"type": "mass"})";
        beam.frames = frames;
        EXPECT_NEAR(ShearedBeam(beam).share(), 3.0 * ratio, 1e-3 * ratio)
            << size << is_round << frames;
        beam.is_pinned = true;
        for (const std::string frame : {"chord", "tangent", "mean-axis"}) {
          beam.frame = frame;
          EXPECT_NEAR(ShearedBeam(beam).share(), 12.0 * ratio, 0.01 * ratio)
              << size << frame << frames;
        }
      }
    }
  }
}

/// The case of h/L = 0.5 is 16 % too stiff; slender beams are left in peace.
TEST(ShearRange, IsLeftByLoadedBeams) {
  const std::vector<Finding> findings = ShearedBeam(LoadedBeam{rectangle(0.5)}).findings();
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_THAT(findings.front().text, HasSubstr("\"beam\" is stubby"));
  EXPECT_THAT(findings.front().text, HasSubstr("\"asked\" by 16 % (of what it is then)"));
  EXPECT_EQ(findings.front().responses, std::vector<std::string>{"asked"});
  EXPECT_TRUE(findings.front().is_serious);
  EXPECT_TRUE(ShearedBeam(LoadedBeam{rectangle(0.05)}).findings().empty());
}

/// Timoshenko's share of the deflection s/(1 + s), s = 3EI/(κGAL²) = ½ (1 + ν)/κ (h/L)²: 1 % where
/// there is a finding, 10 % where it is serious.
TEST(ShearRange, IsLeftAtOnePercentAndSeriousAtTen) {
  const double unit = 0.5 * (1 + nu) / rectangle_shear_coefficient(nu);
  const auto height_with = [&](double share) { return std::sqrt(share / (1 - share) / unit); };
  const auto findings = [&](double share) {
    return ShearedBeam(LoadedBeam{fmt::format(
                           R"({{"type": "rectangle", "width": 0.05, "height": {:.12g}}})",
                           height_with(share))})
        .findings();
  };
  EXPECT_TRUE(findings(0.0097).empty());
  ASSERT_EQ(findings(0.0103).size(), 1u);
  EXPECT_FALSE(findings(0.0103)[0].is_serious);
  EXPECT_FALSE(findings(0.097)[0].is_serious);
  EXPECT_TRUE(findings(0.103)[0].is_serious);
}

/// Stress of a cantilever does not depend on its stiffness; its frequencies and positions do.
TEST(ShearRange, ConcernsWhatRestsOnStiffness) {
  const auto findings = [](const std::string& response) {
    LoadedBeam beam{rectangle(0.5)};
    beam.response = response;
    return ShearedBeam(beam).findings().size();
  };
  EXPECT_EQ(findings(R"({"type": "stress", "body": "beam", "over_time": "max"})"), 0u);
  EXPECT_EQ(findings(R"({"type": "mass"})"), 0u);
  EXPECT_EQ(findings(R"({"type": "elastic-energy", "body": "beam", "over_time": "max"})"), 1u);
  EXPECT_EQ(findings(R"({"type": "elastic-energy", "over_time": "max"})"), 1u);
}

/// What a frequency of the plate loses where it has shear, over what it is then.
double lost_by_shear(const std::string& keys) {
  LoadedBeam beam{rectangle(0.5)};
  beam.response = R"({"type": "frequency")" + keys + "}";
  const double without = values_of(*ShearedBeam(beam).analysis)(0);
  beam.more = R"(, "shear": true)";
  return without / values_of(*ShearedBeam(beam).analysis)(0) - 1.0;
}

/// The lowest mode bends the plate of 50 by 500 mm its thin way, in which it is slender; along y it is
/// stubby. So it is for the mechanism, which is this beam at a clamp.
TEST(ShearRange, OfAFrequencyIsThatOfItsMode) {
  for (const std::string owner : {R"(, "body": "beam")", ""}) {
    const auto texts = [&](const std::string& direction) {
      LoadedBeam beam{rectangle(0.5)};
      beam.response = R"({"type": "frequency")" + owner + direction + "}";
      std::vector<std::string> found;
      for (const Finding& finding : ShearedBeam(beam).findings()) found.push_back(finding.text);
      return found;
    };
    EXPECT_TRUE(texts("").empty());
    EXPECT_TRUE(texts(R"(, "direction": "z")").empty());
    ASSERT_EQ(texts(R"(, "direction": "y")").size(), 1u);
    const double lost = lost_by_shear(owner + R"(, "direction": "y")");
    EXPECT_NEAR(told_percent(texts(R"(, "direction": "y")")[0]), 100.0 * lost, 0.6);
    EXPECT_GT(lost, 0.1);
  }
}

/// A square of 150 mm and 250 mm, clamped at both ends: without shear its torsion is the lowest mode,
/// with it bending has passed that. Told is what becomes of the lowest frequency.
TEST(ShearRange, OfAFrequencyCountsModesThatPassOthers) {
  const auto [problem, x, analysis] = AtStart(problem_from(R"({"scene": {
      "materials": {"s": {"young": 210e9, "poisson": 0.3, "density": 7850}},
      "bodies": {"b": {"type": "beam", "from": [0, 0, 0], "to": [0.5, 0, 0], "material": "s",
        "section": {"type": "rectangle", "width": 0.25, "height": 0.15}, "elements": 8, "frame": "chord"}},
      "joints": {"a": {"type": "fixed", "bodies": ["ground", "b"], "at": [0, 0, 0]},
                 "e": {"type": "fixed", "bodies": ["ground", "b"], "at": [0.5, 0, 0]}},
      "loads": {"Q": {"type": "force", "body": "b", "at": [0.25, 0, 0], "direction": [0, 1, 0], "value": 1000}}},
    "simulation": {"end_time": 2e-6, "step": 1e-6, "initial_state": "quasi-static"},
    "responses": {"f": {"type": "frequency"}}})"));
  ProblemFile sheared = problem;
  std::get<BeamBody>(sheared.scene.bodies[0].shape).has_shear = true;
  const double with_shear = values_of(*analyze(sheared, x))(0);
  const double lost = values_of(*analysis)(0) / with_shear - 1.0;
  ASSERT_GT(lost, 0.1);
  const std::vector<Finding> found = check_variants({problem, x, *analysis, Monitors{}});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(found[0].is_serious);
  EXPECT_NEAR(told_percent(found[0].text), 100.0 * lost, 0.6);
}

/// Nodes at the ends of a frame do not leave its chord: that it bends, its curvature says.
TEST(ShearRange, IsSeenWithOneElementAFrame) {
  LoadedBeam beam{rectangle(0.4), true, "chord"};
  beam.response =
      R"({"type": "deflection", "body": "beam", "at": 0.5, "against": "chord", "over_time": "max"})";
  beam.frames = 4;
  const double share = ShearedBeam(beam).share();
  beam.elements = 4;
  EXPECT_NEAR(ShearedBeam(beam).share(), share, 0.05 * share);
  EXPECT_EQ(ShearedBeam(beam).findings().size(), 1u);
}

/// Shear lowers Euler's load P to P/(1 + s), s = P/(κGA) (Timoshenko & Gere, Theory of Elastic
/// Stability, art. 2.17): π² EI/(κGAL²), with I/A = d²/16 of a circle. The share of the load that
/// it buckles at rises by s, and is s/(1 + s) of what it is with shear too small.
TEST(ShearRange, OfBucklingIsThatOfEulersLoad) {
  LoadedBeam beam{R"({"type": "circle", "diameter": 0.5})"};
  beam.direction = "[-1, 0, 0]";
  beam.response = R"({"type": "buckling", "body": "beam", "over_time": "max"})";
  const std::vector<Finding> findings = ShearedBeam(beam).findings();
  ASSERT_EQ(findings.size(), 1u);
  const double kappa = 6 * (1 + nu) / (7 + 6 * nu);
  const double share = std::numbers::pi * std::numbers::pi * 2 * (1 + nu) / kappa * 0.25 / 16;
  EXPECT_THAT(findings[0].text, HasSubstr(fmt::format(" {:.2g} %", 100 * share / (1 + share))));
}

/// A plate of 50 by 500 mm buckles about its weak axis, about which it is slender.
TEST(ShearRange, OfBucklingIsThatOfThePlaneThatBucklesFirst) {
  LoadedBeam beam{rectangle(0.5)};
  beam.direction = "[-1, 0, 0]";
  beam.response = R"({"type": "buckling", "body": "beam", "over_time": "max"})";
  EXPECT_TRUE(ShearedBeam(beam).findings().empty());
  beam.section = R"({"type": "rectangle", "width": 0.4, "height": 0.5})";
  const std::vector<Finding> findings = ShearedBeam(beam).findings();
  ASSERT_EQ(findings.size(), 1u);
  const double share = std::numbers::pi * std::numbers::pi * 2 * (1 + nu) * 0.16 / 12 /
                       rectangle_shear_coefficient(nu);
  EXPECT_THAT(findings[0].text, HasSubstr(fmt::format(" {:.2g} %", 100 * share / (1 + share))));
}

/// A slider-crank of stubby members in space: its three revolute joints hold the loop three times
/// against motion across, where nothing pulls. Its torque is that of its inertia.
TEST(ShearRange, DoesNotConcernTheForcesOfAPlanarLoopInSpace) {
  const auto [problem, x, analysis] = AtStart(sample_problem(
      "slider_crank", {"/effects/spatial_motion=on", "/simulation/step=0.2 ms",
                       "/simulation/end_time=60 ms", "/simulation/resolution_check=false"}));
  const std::vector<Finding> found = check_variants({problem, x, *analysis, Monitors{}});
  ASSERT_FALSE(found.empty());
  for (const Finding& finding : found) {
    EXPECT_THAT(finding.responses, Not(testing::Contains("torque_peak"))) << finding.text;
    EXPECT_THAT(finding.text, Not(HasSubstr("stress"))) << finding.text;
  }
}

/// A beam clamped at one end whose other end is moved sideways without turning takes
/// 12EI/L³ / (1 + 12EI/(κGAL²)) a metre: forces and stresses are as wrong as its stiffness.
TEST(ShearRange, ConcernsTheForcesOfWhatIsHeldMoreThanItNeeds) {
  const auto findings = [](const std::string& response) {
    const auto [problem, x, analysis] = AtStart(problem_from(
        R"({"scene": {"materials": {"m": {"young": 2.1e11, "poisson": 0.3, "density": 7850}},
            "bodies": {"b": {"type": "beam", "from": [0, 0, 0], "to": [0.2, 0, 0], "material": "m",
              "section": {"type": "rectangle", "width": 0.05, "height": 0.1}, "elements": 4}},
            "joints": {"clamp": {"type": "fixed", "bodies": ["ground", "b"], "at": [0, 0, 0]},
                       "ram": {"type": "prismatic", "bodies": ["ground", "b"], "at": [0.2, 0, 0], "axis": [0, 1, 0],
                               "drive": {"type": "polynomial", "coefficients": [0, 1e-5]}}}},
          "simulation": {"end_time": 1, "step": 0.25}, "responses": {"asked": )" +
        response + "}}"));
    return check_variants({problem, x, *analysis, Monitors{}});
  };
  const double phi = 12 * 2.6 * 0.25 / 12 / rectangle_shear_coefficient(nu);
  for (const char* response : {R"({"type": "stress", "body": "b", "over_time": "max"})",
                               R"({"type": "drive-force", "joint": "ram", "over_time": "max"})",
                               R"({"type": "reaction-moment", "joint": "clamp", "direction": "z",
             "over_time": "max-abs"})"}) {
    const std::vector<Finding> found = findings(response);
    ASSERT_EQ(found.size(), 1u) << response;
    EXPECT_TRUE(found[0].is_serious);
    EXPECT_NEAR(told_percent(found[0].text), 100 * phi, 0.6);
  }
}

/// Timoshenko's tip, P L³/3EI + P L/κGA, of all sections in modes and frames, and no finding of it.
TEST(ShearRange, DoesNotConcernBeamsThatHaveShear) {
  const double kappa = 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu), area = 0.05 * 0.5;
  const double bending = 1.0 / (3 * 2.1e11 * area * 0.25 / 12);
  const double expected = bending + 2.6 / (kappa * 2.1e11 * area);
  for (const auto& [frames, more] :
       {std::pair(1, R"(, "shear": true)"), std::pair(2, R"(, "shear": true)"),
        std::pair(1, R"(, "shear": true, "reduction": {"modes": 2})")}) {
    LoadedBeam beam{rectangle(0.5)};
    beam.frames = frames;
    beam.more = more;
    const ShearedBeam run(beam);
    EXPECT_NEAR(run.analysis->reductions[0].value, expected, 1e-6 * expected) << frames << more;
    EXPECT_TRUE(run.findings().empty()) << frames << more;
  }
  const auto records =
      ShearedBeam(LoadedBeam{.section = rectangle(0.5), .more = R"(, "shear": true)"})
          .analysis->model.effects;
  EXPECT_EQ(std::count_if(records.begin(), records.end(),
                          [](const EffectRecord& one) { return one.name == "shear"; }),
            1);
}

/// What can be done is said.
TEST(ShearRange, SaysWhatHelps) {
  LoadedBeam beam{rectangle(0.5)};
  EXPECT_THAT(ShearedBeam(beam).findings()[0].text,
              HasSubstr("by 16 % (of what it is then). Do not trust that: set "
                        "/scene/bodies/beam/shear to true."));
  beam.section = R"({"type": "general", "area": 0.025, "inertia_y": 5e-6, "inertia_z": 5e-4,
                     "torsion": 2e-5, "points": [{"y": 0.25, "z": 0, "shear": 0}]})";
  EXPECT_THAT(ShearedBeam(beam).findings()[0].text,
              HasSubstr("true, and give the section of \"beam\" \"shear_area_y\" and"));
}

/// A cantilever of 1 m, 39 mm deep, with a force at a tenth of it: the deflection against the line
/// through both ends is that at the force less nine tenths of the line's rise. With φ of the stub
/// of 0.1 m shear moves the force by (h/ℓ)² E/(4κG) = 0.116 of its bending, and what turns the rest
/// does not change: L ℓ²/2 EI F at the far end.
TEST(ShearRange, AgainstTheChordIsThatAgainstTheChord) {
  LoadedBeam beam{rectangle(0.039)};
  beam.load_at = 0.1;
  beam.response =
      R"({"type": "deflection", "body": "beam", "at": 0.9, "against": "chord", "over_time": "min"})";
  // F = EI = 1: w(0.1) = ℓ³/3, slope ℓ²/2, and shear adds γ ℓ from 0.1 on.
  const double l = 0.1, bent = l * l * l / 3.0, slope = 0.5 * l * l;
  const double sheared =
      0.5 * (1 + nu) / rectangle_shear_coefficient(nu) * (0.039 / l) * (0.039 / l) * bent;
  const auto against_chord = [&](double shear) {
    const auto at = [&](double x) { return bent + slope * (x - l) + shear; };
    return at(0.9) - 0.9 * at(1.0);
  };
  const double expected = against_chord(sheared) / against_chord(0.0);
  const std::vector<Finding> found = ShearedBeam(beam).findings();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(told_percent(found[0].text), 100.0 * std::abs(1.0 / expected - 1.0), 0.6);
}

/// What is far below its limit may change as it likes: it is said, and nothing is refused. Nearer
/// to it, and of the same change, it is serious.
TEST(ShearRange, IsSeriousBesideLimitsOnly) {
  const auto with_limit = [](double times) {
    ProblemFile problem = LoadedBeam{rectangle(0.5)}.problem();
    ConstraintSettings limit;
    limit.name = limit.response = "asked";
    limit.upper = times * values_of(*analyze(problem, start_design(problem)))(0);
    problem.constraints.push_back(limit);
    return findings_of(problem, check_variants);
  };
  for (const auto& [times, is_serious] : {std::pair(1.5, true), std::pair(1000.0, false)}) {
    const std::vector<Finding> found = with_limit(times);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].is_serious, is_serious) << times;
    EXPECT_THAT(found[0].text, HasSubstr("by 16 % (of"));
  }
}

/// Beside what is minimized nobody asks for it.
TEST(ShearRange, IsNotSeriousForWhatIsNotAsked) {
  ProblemFile problem = LoadedBeam{rectangle(0.5)}.problem();
  problem.responses.push_back({"mass", MassResponse{}});
  problem.objective = Objective{"mass"};
  EXPECT_FALSE(only(findings_of(problem, check_variants)).is_serious);
  problem.objective = Objective{"asked"};
  EXPECT_TRUE(only(findings_of(problem, check_variants)).is_serious);
}

/// 3 % of a deflection are a fifth of its sixth power.
TEST(ShearRange, IsSeriousForAFormulaThatIsAsked) {
  ProblemFile problem = LoadedBeam{rectangle(0.2)}.problem();
  EXPECT_FALSE(only(findings_of(problem, check_variants)).is_serious);
  Expression power;
  power.arguments = {{ExpressionArgument::Kind::response, 0}};
  power.steps = {
      {Operation::argument, 0.0, 0}, {Operation::constant, 6.0}, {Operation::power, 0.0, 0, 1}};
  problem.responses.push_back(
      {"power", ExpressionResponse{std::make_shared<const Expression>(power)}});
  problem.objective = Objective{"power"};
  EXPECT_TRUE(only(findings_of(problem, check_variants)).is_serious);
}

/// A file without responses asks nothing.
TEST(ShearRange, IsNotAskedWithoutResponses) {
  ProblemFile problem = LoadedBeam{rectangle(0.5)}.problem();
  problem.responses.clear();
  EXPECT_TRUE(findings_of(problem, check_variants).empty());
}

/// A column that stands, and does not bend, has no deflection that shear could change.
TEST(ShearRange, IsNotLeftByWhatDoesNotBend) {
  LoadedBeam beam{rectangle(0.3)};
  beam.direction = "[-1, 0, 0]";
  beam.response =
      R"({"type": "position", "body": "beam", "at": 1, "direction": "y", "over_time": "max-abs"})";
  EXPECT_TRUE(ShearedBeam(beam).findings().empty());
}

// Stubby beams beside others and springs: what shear passes on, and what it is measured by.

/// A cantilever of two beams that are welded in its middle, 200 mm long and 80 mm deep, and what a force
/// at its tip moves with shear over that without: (h/L)² E/(4 κ G) = 0.12, half of it in each beam.
TEST(ShearOfSeveralBeams, AddsUp) {
  const auto findings = [](const std::string& shear) {
    return findings_of(read_scene(fmt::format(R"j({{"scene": {{"bodies": {{
        "first": {{"type": "beam", "from": [0, 0, 0], "to": [0.1, 0, 0], "material": "steel", "elements": 2, {0},
                   "section": {{"type": "rectangle", "width": "20 mm", "height": "80 mm"}}}},
        "second": {{"type": "beam", "from": [0.1, 0, 0], "to": [0.2, 0, 0], "material": "steel", "elements": 2, {0},
                    "section": {{"type": "rectangle", "width": "20 mm", "height": "80 mm"}}}}}},
      "joints": {{"wall": {{"type": "fixed", "bodies": ["ground", "first"], "at": [0, 0, 0]}},
                 "weld": {{"type": "fixed", "bodies": ["first", "second"], "at": [0.1, 0, 0]}}}},
      "loads": {{"push": {{"type": "force", "body": "second", "at": [0.2, 0, 0], "direction": [0, -1, 0],
                          "value": {{"type": "ramp", "to": 1000, "end": 0.01}}}}}}}},
      "simulation": {{"end_time": 0.01, "step": 0.001}},
      "responses": {{"tip": {{"type": "position", "body": "second", "at": 1, "direction": "y",
                              "over_time": "min"}}}}}})j",
                                              shear)),
                       check_variants);
  };
  const std::vector<Finding> found = findings(R"("shear": false)");
  ASSERT_EQ(found.size(), 1U);
  EXPECT_TRUE(found[0].is_serious);
  EXPECT_THAT(found[0].text, HasSubstr(R"("second", "first" are stubby)"));
  EXPECT_THAT(found[0].text, HasSubstr(R"("tip" by 11 % (of)"));  // 0.12/(1 + 0.12)
  EXPECT_TRUE(findings(R"("shear": true)").empty());
}

/// Two cantilevers, a block of 100 mm and a beam, share a load on the bar that ties their tips: the
/// block yields by shear and leaves more to the beam.
TEST(ShearRange, OfABlockIsToldOfWhatStandsBesideIt) {
  const auto problem = [](bool has_shear) {
    return read_scene(fmt::format(R"j({{"scene": {{"bodies": {{
        "block": {{"type": "beam", "from": [0, 0, 0], "to": [0.1, 0, 0], "material": "steel",
                   "elements": 2, "shear": {}, "section": {{"type": "rectangle", "width": 0.01, "height": 0.1}}}},
        "beam": {{"type": "beam", "from": [0, 0.5, 0], "to": [0.5, 0.5, 0], "material": "steel",
                  "elements": 2, "section": {{"type": "rectangle", "width": 0.3, "height": 0.05}}}},
        "bar": {{"type": "rigid", "at": [0.3, 0.25, 0], "mass": 0.001, "inertia": [1e-6, 1e-6, 1e-6, 0, 0, 0]}}}},
      "joints": {{
        "a": {{"type": "fixed", "bodies": ["ground", "block"], "at": [0, 0, 0]}},
        "b": {{"type": "fixed", "bodies": ["ground", "beam"], "at": [0, 0.5, 0]}},
        "to_block": {{"type": "point-on-line", "bodies": ["bar", "block"], "at": [0.1, 0, 0], "axis": [1, 0, 0]}},
        "to_beam": {{"type": "revolute", "bodies": ["bar", "beam"], "at": [0.5, 0.5, 0]}},
        "guide": {{"type": "prismatic", "bodies": ["ground", "bar"], "at": [0.3, 0.25, 0], "axis": [0, 1, 0]}}}},
      "loads": {{"push": {{"type": "force", "body": "bar", "at": [0.3, 0.25, 0],
                           "direction": [0, -1, 0], "value": 1000}}}}}},
      "simulation": {{"end_time": 0.002, "step": 0.001, "initial_state": "quasi-static"}},
      "responses": {{"stress": {{"type": "stress", "body": "beam", "over_time": "max"}},
                     "of_bar": {{"type": "joint-position", "joint": "guide", "over_time": "final"}}}}}})j",
                                  has_shear));
  };
  // Springs side by side: 3EI/L³ of the beam, over (1 + 3EI/(κGAL²)) of the block.
  const double share = 0.5 * (1 + nu) / rectangle_shear_coefficient(nu);
  const double block = 0.01 * 0.001 / 0.001, of_beam = 0.3 * 0.000125 / 0.125;
  const double with = of_beam / (of_beam + block / (1.0 + share)),
               without = of_beam / (of_beam + block);
  const std::vector<Finding> found = findings_of(problem(false), check_variants);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(found[0].is_serious);
  EXPECT_THAT(found[0].responses, ElementsAre("stress", "of_bar"));
  EXPECT_THAT(found[0].text, HasSubstr("\"block\" is stubby"));
  EXPECT_NEAR(told_percent(found[0].text), 100.0 * (1.0 - without / with), 0.6);
  EXPECT_TRUE(findings_of(problem(true), check_variants).empty());
}

/// A spring at the tip of a stubby cantilever, as stiff as that without shear, takes half of the
/// load, and 1/(1 + 1/(1 + s)) of it in truth.
TEST(ShearRange, OfASpringIsThatOfItsLoad) {
  const double share = 0.5 * (1 + nu) / rectangle_shear_coefficient(nu);
  const std::vector<Finding> found = findings_of(read_scene(R"({"scene": {
        "materials": {"m": {"young": 2.1e11, "poisson": 0.3, "density": 7850}},
        "bodies": {"block": {"type": "beam", "from": [0, 0, 0], "to": [0.1, 0, 0], "material": "m",
                   "elements": 2, "section": {"type": "rectangle", "width": 0.01, "height": 0.1}}},
        "joints": {"a": {"type": "fixed", "bodies": ["ground", "block"], "at": [0, 0, 0]}},
        "loads": {"push": {"type": "force", "body": "block", "at": [0.1, 0, 0],
                           "direction": [0, -1, 0], "value": 1000},
                  "spring": {"type": "spring", "bodies": ["block", "ground"],
                             "at": [[0.1, 0, 0], [0.1, -5, 0]], "stiffness": 5.25e8}}},
      "simulation": {"end_time": 0.002, "step": 0.001, "initial_state": "quasi-static"},
      "responses": {"force": {"type": "spring-force", "load": "spring", "over_time": "min"}}})"),
                                                 check_variants);
  ASSERT_EQ(found.size(), 1u);
  const double with = (1.0 + share) / (2.0 + share);
  EXPECT_NEAR(told_percent(found[0].text), 100.0 * (1.0 - 0.5 / with), 0.6);
}

/// A cantilever at a height of 0.5 m that a slender one, which has nothing to do with it, out-bends
/// by far: its position is as wrong as how far it sags, 3EI/(κGAL²), and so is the difference to
/// where it is drawn.
TEST(ShearRange, OfAPositionIsThatOfItsOwnMotion) {
  const std::vector<Finding> found = findings_of(read_scene(R"({"scene": {"gravity": [0, 0, 0],
        "materials": {"m": {"young": 2.1e11, "poisson": 0.3, "density": 7850}},
        "bodies": {"block": {"type": "beam", "from": [0, 0.5, 0], "to": [0.1, 0.5, 0], "material": "m",
                   "elements": 2, "section": {"type": "rectangle", "width": 0.01, "height": 0.05}},
                   "reed": {"type": "beam", "from": [1, 0, 0], "to": [2, 0, 0], "material": "m",
                   "elements": 2, "section": {"type": "rectangle", "width": 0.01, "height": 0.01}}},
        "joints": {"a": {"type": "fixed", "bodies": ["ground", "block"], "at": [0, 0.5, 0]},
                   "b": {"type": "fixed", "bodies": ["ground", "reed"], "at": [1, 0, 0]}},
        "loads": {"push": {"type": "force", "body": "block", "at": [0.1, 0.5, 0],
                           "direction": [0, -1, 0], "value": 50000},
                  "bend": {"type": "force", "body": "reed", "at": [2, 0, 0],
                           "direction": [0, -1, 0], "value": 10}}},
      "simulation": {"end_time": 0.002, "step": 0.001, "initial_state": "quasi-static"},
      "responses": {
        "y": {"type": "position", "body": "block", "at": 1, "direction": "y", "over_time": "min"},
        "sag": {"type": "expression", "value": "0.5 m - y"},
        "of_reed": {"type": "position", "body": "reed", "at": 1, "direction": "y", "over_time": "min"}}})"),
                                                 check_variants);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_THAT(found[0].responses, ElementsAre("y", "sag"));
  const double share = 0.5 * (1 + nu) / rectangle_shear_coefficient(nu) * 0.25;
  EXPECT_NEAR(told_percent(found[0].text), 100.0 * share / (1.0 + share), 0.6);
}

/// The damage of one period is small beside 1, and beside nothing else: m powers of the stress. The
/// stress that a spring beside a stubby block leaves to it is 1/(2 + s) of the load, not a half.
TEST(ShearRange, OfASmallDamageIsThatOfTheDamage) {
  const auto damage = [](const std::string& shear) {
    return read_scene(R"({"scene": {"gravity": [0, 0, 0],
        "materials": {"m": {"young": 2.1e11, "poisson": 0.3, "density": 7850,
                            "ultimate_strength": 1e9, "fatigue_strength": 1e9, "fatigue_exponent": 5}},
        "bodies": {"block": {"type": "beam", "from": [0, 0, 0], "to": [0.1, 0, 0], "material": "m",
                   "elements": 2, "section": {"type": "rectangle", "width": 0.01, "height": 0.1}, )" +
                      shear + R"(}},
        "joints": {"a": {"type": "fixed", "bodies": ["ground", "block"], "at": [0, 0, 0]}},
        "loads": {"push": {"type": "force", "body": "block", "at": [0.1, 0, 0], "direction": [0, -1, 0],
                           "value": {"type": "harmonic", "amplitude": 10000, "frequency": 1}},
                  "spring": {"type": "spring", "bodies": ["block", "ground"],
                             "at": [[0.1, 0, 0], [0.1, -5, 0]], "stiffness": 5.25e8}}},
      "simulation": {"end_time": 1, "step": 0.05, "initial_state": "quasi-static"},
      "responses": {"damage": {"type": "fatigue-damage", "body": "block", "criterion": "goodman"}}})");
  };
  const ProblemFile problem = damage(R"("shear": false)");
  const double without = values_of(*analyze(problem, start_design(problem)))(0);
  const ProblemFile other = damage(R"("shear": true)");
  const double with = values_of(*analyze(other, start_design(other)))(0);
  ASSERT_GT(with, 0.0);
  ASSERT_LT(with, 1e-3);
  const std::vector<Finding> found = findings_of(problem, check_variants);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(told_percent(found[0].text), 100.0 * std::abs(without / with - 1.0),
              0.06 * 100.0 * std::abs(without / with - 1.0));
}

}  // namespace
}  // namespace pleuel::test::shear_range_test
