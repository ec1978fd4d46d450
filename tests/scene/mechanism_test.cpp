#include <set>

#include "core/scene/held_points.hpp"
#include "core/scene/packed_problem.hpp"
#include "core/scene/shown_unit.hpp"
#include "core/scene/visit_numbers.hpp"
#include "tests/scene/good_problem.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::mechanism_test {
namespace {

using std::numbers::pi;
using testing::DoubleEq;
using testing::DoubleNear;

constexpr double rounding = 1e-14;  // relative, of one or two conversions of units

class Mechanism : public testing::Test {
 protected:
  template <class Named>
  static const Named& named(const std::vector<Named>& things, const std::string& name) {
    for (const Named& thing : things) {
      if (thing.name == name) return thing;
    }
    throw std::out_of_range(name);
  }
  const Body& body(const std::string& name) const { return named(problem_.scene.bodies, name); }
  const BeamBody& beam(const std::string& name) const {
    return std::get<BeamBody>(body(name).shape);
  }
  const Joint& joint(const std::string& name) const { return named(problem_.scene.joints, name); }
  template <class Element>
  const Element& load(const std::string& name) const {
    return std::get<Element>(named(problem_.scene.loads, name).element);
  }
  const ResponseSettings& settings(const std::string& name) const {
    return named(problem_.responses, name);
  }
  template <class Kind>
  const Kind& response(const std::string& name) const {
    return std::get<Kind>(settings(name).what);
  }

  ProblemFile problem_ = read(good_mechanism());
};

TEST_F(Mechanism, HasBeamsInEveryFrame) {
  EXPECT_EQ(beam("arm").frame, ReferenceCondition::tangent);
  EXPECT_EQ(beam("rod").frame, ReferenceCondition::mean_axis);
  EXPECT_EQ(beam("tail").frame, ReferenceCondition::tangent_end);
}

TEST_F(Mechanism, HasReducedDampedAndRigidBeams) {
  EXPECT_EQ(beam("arm").reduction->modes, 4);
  EXPECT_FALSE(beam("arm").reduction->frequency.has_value());
  EXPECT_DOUBLE_EQ(beam("arm").damping.modal.constant, 0.02);
  EXPECT_DOUBLE_EQ(*beam("rod").reduction->frequency, 4000.0 * pi);  // 2 kHz in rad/s
  EXPECT_FALSE(beam("rod").reduction->modes.has_value());
  EXPECT_FALSE(beam("tail").reduction.has_value());
  EXPECT_TRUE(beam("strut").is_rigid);
  EXPECT_FALSE(beam("arm").is_rigid);
}

TEST_F(Mechanism, TakesAPlainFrequencyOfAReductionInHertz) {
  const Json plain = edited(good_mechanism(), "/scene/bodies/rod/reduction/frequency", "2000");
  const ProblemFile problem = read(plain);
  const auto& rod = std::get<BeamBody>(named(problem.scene.bodies, "rod").shape);
  EXPECT_DOUBLE_EQ(*rod.reduction->frequency, 4000.0 * pi);
}

TEST_F(Mechanism, HasInitialVelocities) {
  EXPECT_EQ(body("rod").velocity[0].constant, 1.0);
  EXPECT_DOUBLE_EQ(body("rod").angular_velocity[2].constant, pi);  // 30 rpm
  EXPECT_EQ(body("block").velocity[1].constant, -2.0);
  EXPECT_DOUBLE_EQ(body("block").angular_velocity[0].constant, 0.5 * pi);
  EXPECT_EQ(body("ball").velocity[0].variable, 0);
  EXPECT_EQ(body("arm").velocity[0].constant, 0.0);
}

TEST_F(Mechanism, HasEveryOtherJoint) {
  EXPECT_EQ(joint("shoulder").type, JointType::cylindrical);
  EXPECT_EQ(joint("elbow").type, JointType::universal);
  EXPECT_THAT(joint("elbow").axis, ElementsAre(0.0, 0.0, 1.0));
  EXPECT_THAT(joint("elbow").second_axis, ElementsAre(0.0, 5.0, 0.0));
  EXPECT_EQ(joint("wrist").type, JointType::spherical);
  EXPECT_EQ(joint("floor").type, JointType::planar);
  EXPECT_EQ(joint("tie").type, JointType::distance);
  EXPECT_EQ(joint("tie").at[0].constant, 1.25);
  EXPECT_EQ(joint("tie").to[1].constant, 1.0);
  EXPECT_EQ(joint("rail").type, JointType::prismatic);
}

TEST_F(Mechanism, HasDrivesThatAreFunctionsOfTime) {
  const auto& polynomial = std::get<PolynomialFunction>(joint("shoulder").drive->motion);
  ASSERT_EQ(polynomial.coefficients.size(), 3U);
  EXPECT_DOUBLE_EQ(polynomial.coefficients[1].constant, 2.0 * pi);
  EXPECT_DOUBLE_EQ(polynomial.coefficients[2].constant, pi);
  const auto& harmonic = std::get<HarmonicFunction>(joint("elbow").drive->motion);
  EXPECT_DOUBLE_EQ(harmonic.amplitude.constant, pi / 18.0);
  EXPECT_DOUBLE_EQ(harmonic.frequency.constant, 20.0 * pi);
  EXPECT_DOUBLE_EQ(harmonic.phase.constant, 0.5 * pi);
  EXPECT_EQ(harmonic.offset.variable, 1);
  const auto& table = std::get<TableFunction>(joint("tie").drive->motion);
  EXPECT_THAT(table.times, ElementsAre(0.0, DoubleEq(0.05), 0.1));
  EXPECT_DOUBLE_EQ(table.values[1].constant, 1e-3);
  const auto& ramp = std::get<RampToSpeedDrive>(joint("line").drive->motion);
  EXPECT_DOUBLE_EQ(ramp.speed.constant, 0.02);
  EXPECT_EQ(std::get<ConstantFunction>(joint("floor").drive->motion).value.constant, 0.0);
}

TEST_F(Mechanism, HasDrivesOfTheCoordinateThatTheJointHas) {
  EXPECT_EQ(joint("shoulder").drive->coordinate, DrivenCoordinate::angle);
  EXPECT_EQ(joint("elbow").drive->coordinate, DrivenCoordinate::angle);
  EXPECT_EQ(joint("floor").drive->coordinate, DrivenCoordinate::angle);
  EXPECT_EQ(joint("tie").drive->coordinate, DrivenCoordinate::displacement);
  EXPECT_EQ(joint("line").drive->coordinate, DrivenCoordinate::displacement);
}

TEST_F(Mechanism, HasForcesAndTorques) {
  const auto& push = load<PointLoad>("push");
  EXPECT_TRUE(push.is_force());
  EXPECT_EQ(push.body, "arm");
  EXPECT_EQ(push.at[0].constant, 0.37);
  EXPECT_THAT(push.direction,
              ElementsAre(0.0, DoubleNear(0.6, rounding), DoubleNear(0.8, rounding)));
  EXPECT_EQ(std::get<ConstantFunction>(push.value).value.constant, 2000.0);
  EXPECT_TRUE(push.follows_body);
  const auto& pull = std::get<ConstantFunction>(load<PointLoad>("pull").value);
  EXPECT_EQ(pull.value.variable, 2);
  EXPECT_EQ(pull.value.factor, 2.0);
  const auto& gust = load<PointLoad>("gust");
  EXPECT_FALSE(gust.follows_body);
  EXPECT_EQ(std::get<PolynomialFunction>(gust.value).coefficients[1].constant, 2.0);
  const auto& twist = load<PointLoad>("twist");
  EXPECT_FALSE(twist.is_force());
  EXPECT_THAT(twist.direction, ElementsAre(-1.0, 0.0, 0.0));
  EXPECT_EQ(std::get<HarmonicFunction>(twist.value).amplitude.constant, 3.0);
  EXPECT_EQ(std::get<HarmonicFunction>(twist.value).phase.constant, 0.0);
}

TEST_F(Mechanism, HasEachPlaceOfAJointOrLoadOnce) {
  const auto keys_of = [](const auto& holder) {
    std::vector<std::string> keys;
    visit_held_places(holder, [&](const Point&, const PointKey& key) { keys.push_back(key.key); });
    return keys;
  };
  EXPECT_THAT(keys_of(joint("shoulder")), ElementsAre("at"));
  EXPECT_THAT(keys_of(joint("tie")), ElementsAre("at", "to"));
  const std::vector<Load>& loads = problem_.scene.loads;
  EXPECT_THAT(keys_of(named(loads, "push")), ElementsAre("at"));
  EXPECT_THAT(keys_of(named(loads, "strap")), ElementsAre("at", "at"));
  EXPECT_THAT(keys_of(named(loads, "hinge")), IsEmpty());
  EXPECT_FALSE(has_forces(named(loads, "twist")));
  EXPECT_TRUE(has_forces(named(loads, "strap")));
}

TEST_F(Mechanism, HasSprings) {
  const auto& strap = load<SpringDamper>("strap");
  EXPECT_THAT(strap.bodies, ElementsAre("ground", "ball"));
  EXPECT_EQ(strap.at[0][0].constant, 5.0);
  EXPECT_EQ(strap.at[1][0].constant, 4.0);
  EXPECT_DOUBLE_EQ(strap.stiffness.constant, 2000.0);
  EXPECT_EQ(strap.damping.constant, 3.0);
  EXPECT_DOUBLE_EQ(strap.free_length->constant, 0.9);
  EXPECT_FALSE(load<SpringDamper>("cord").free_length.has_value());
}

TEST_F(Mechanism, HasForcesInJoints) {
  const auto& stopper = load<JointForce>("stopper");
  EXPECT_EQ(stopper.joint, "shoulder");
  EXPECT_EQ(stopper.coordinate, DrivenCoordinate::displacement);
  EXPECT_DOUBLE_EQ(stopper.stiffness.constant, 2000.0);
  EXPECT_EQ(stopper.damping.constant, 4.0);
  EXPECT_DOUBLE_EQ(stopper.rest.constant, 0.005);
  EXPECT_EQ(std::get<TableFunction>(*stopper.motor).values[1].constant, 2.0);
  const auto& hinge = load<JointForce>("hinge");
  EXPECT_EQ(hinge.coordinate, DrivenCoordinate::angle);
  EXPECT_DOUBLE_EQ(hinge.damping.constant, 0.1);
  EXPECT_FALSE(hinge.motor.has_value());
  const auto& bush = load<JointForce>("bush");
  EXPECT_EQ(bush.coordinate, DrivenCoordinate::displacement);
  EXPECT_EQ(std::get<ConstantFunction>(*bush.motor).value.constant, 7.0);
}

TEST_F(Mechanism, HasResponsesOfMotion) {
  const auto &speed = response<PointMotionResponse>("speed"),
             &jolt = response<PointMotionResponse>("jolt");
  EXPECT_EQ(speed.derivative, TimeDerivative::first);
  EXPECT_EQ(speed.component.direction, magnitude_direction);
  EXPECT_EQ(speed.point.at, 0.5);
  EXPECT_EQ(jolt.derivative, TimeDerivative::second);
  EXPECT_EQ(jolt.component.direction, 1);
  // Counted from 0 here, from 1 in a file.
  EXPECT_EQ(response<ModeResponse>("tone"), (ModeResponse{"arm", {.number = 1}}));
  EXPECT_EQ(response<ModeResponse>("mechanism_tone"), ModeResponse());
}

TEST_F(Mechanism, HasResponsesOfForcesAndStress) {
  EXPECT_EQ(response<DriveResponse>("energy"), (DriveResponse{"shoulder", DriveNumber::power}));
  EXPECT_EQ(response<ReactionResponse>("bearing").kind, ReactionKind::force);
  EXPECT_EQ(response<ReactionResponse>("bearing").direction, magnitude_direction);
  EXPECT_EQ(response<ReactionResponse>("clamp").kind, ReactionKind::moment);
  EXPECT_EQ(response<ReactionResponse>("clamp").direction, 2);
  EXPECT_TRUE(settings("stability").is<BucklingResponse>());
  EXPECT_EQ(response<StressResponse>("normal").part, StressPart::normal);
  EXPECT_EQ(response<StressResponse>("normal").where.station, 0.25);
  EXPECT_EQ(response<StressResponse>("axial").part, StressPart::axial);
  EXPECT_EQ(response<StressResponse>("bending").part, StressPart::bending);
  EXPECT_EQ(response<StressResponse>("shear").part, StressPart::shear);
  EXPECT_EQ(response<StressResponse>("shear").where.segment, 1);
  EXPECT_EQ(response<StressResponse>("use").part, StressPart::utilization);
  EXPECT_EQ(response<StressResponse>("strain").part, StressPart::von_mises);
}

TEST_F(Mechanism, HasResponsesOfEnergyAndErrors) {
  EXPECT_EQ(response<EnergyResponse>("motion"), EnergyResponse());
  EXPECT_EQ(response<EnergyResponse>("swing").body, "block");
  EXPECT_EQ(response<EnergyResponse>("spring"), (EnergyResponse{"arm", EnergyKind::elastic}));
  EXPECT_TRUE(settings("missing").is<EnergyBalanceResponse>());
  EXPECT_EQ(settings("missing").to, 0.05);
  EXPECT_EQ(response<DriftResponse>("drift").level, DriftLevel::position);
  EXPECT_EQ(response<DriftResponse>("speed_drift").level, DriftLevel::velocity);
}

TEST_F(Mechanism, HasResponsesInWindowsOfTime) {
  EXPECT_DOUBLE_EQ(*settings("jolt").from, 0.02);
  EXPECT_EQ(settings("jolt").to, 0.1);
  EXPECT_FALSE(settings("effort").from.has_value());
  EXPECT_EQ(settings("effort").to, 0.05);
  EXPECT_EQ(settings("bearing").from, 0.05);
  EXPECT_FALSE(settings("speed").to.has_value());
}

TEST_F(Mechanism, HasLimitsInTheUnitsOfItsResponses) {
  EXPECT_EQ(quantity_of(settings("energy")).unit, "J");
  EXPECT_DOUBLE_EQ(*problem_.constraints[0].lower, 20.0 * pi);
  EXPECT_DOUBLE_EQ(*problem_.constraints[1].upper, 0.8);
  EXPECT_EQ(quantity_of(settings("thrust")).unit, "N");
  EXPECT_EQ(quantity_of(settings("jolt")).unit, "m/s^2");
  EXPECT_EQ(quantity_of(settings("clamp")).unit, "N m");
  EXPECT_EQ(quantity_of(settings("motion")).unit, "J");
  EXPECT_EQ(quantity_of(settings("swing")).unit, "J s");
  EXPECT_EQ(quantity_of(settings("missing")).unit, "J");
  EXPECT_EQ(quantity_of(settings("drift")).unit, "1");
}

TEST_F(Mechanism, HasEffectsAndInitialState) {
  const EffectSettings& effects = problem_.effects;
  EXPECT_EQ(effects.spatial_motion, EffectChoice::on);
  EXPECT_EQ(effects.geometric_stiffening, EffectChoice::off);
  EXPECT_EQ(effects.rotary_inertia, EffectChoice::off);
  EXPECT_EQ(effects.elasticity, EffectChoice::on);
  EXPECT_EQ(effects.axial_elasticity, EffectChoice::off);
  EXPECT_EQ(effects.torsional_elasticity, EffectChoice::on);
  EXPECT_EQ(effects.tolerance, 1e-3);
  EXPECT_TRUE(problem_.simulation.quasi_static_start);
  EXPECT_FALSE(read(good_json()).simulation.quasi_static_start);
}

TEST_F(Mechanism, StartsBent) {
  Json document = good_mechanism();
  document["simulation"]["initial_state"] = "consistent";
  document["scene"]["bodies"]["arm"]["initial_deflections"] = Json::parse(
      R"([{"at": [0.5, 0, 0], "direction": [0, 3, 4], "displacement": "2 mm"},
          {"at": [1, 0, 0], "direction": [0, 1, 0], "rate": {"variable": "speed"}}])");
  const std::vector<InitialDeflection> deflections =
      read(document).scene.bodies[0].initial_deflections;
  ASSERT_EQ(deflections.size(), 2U);
  EXPECT_EQ(deflections[0].at[0].constant, 0.5);
  EXPECT_DOUBLE_EQ(deflections[0].direction[2], 0.8);
  EXPECT_DOUBLE_EQ(deflections[0].displacement.constant, 2e-3);
  EXPECT_TRUE(deflections[1].rate.is_bound());
  const std::string bytes = packed(read(document));
  EXPECT_EQ(packed(unpacked<ProblemFile>(bytes)), bytes);
}

TEST_F(Mechanism, StartsBentOnlyWhereNothingElseSaysHow) {
  const auto complaint_with = [](const char* body, const char* deflection,
                                 const char* state = R"("consistent")") {
    Json document = good_mechanism();
    document["simulation"]["initial_state"] = Json::parse(state);
    document["scene"]["bodies"][body]["initial_deflections"] = Json::parse(deflection);
    return complaint(document);
  };
  const char* good = R"([{"at": [1, 0, 0], "direction": [0, 1, 0], "displacement": 1e-3}])";
  EXPECT_EQ(complaint_with("arm", good), "");
  EXPECT_THAT(complaint_with("arm", good, R"("quasi-static")"),
              HasSubstr("/scene/bodies/arm/initial_deflections cannot be given where "
                        "/simulation/initial_state is \"quasi-static\""));
  EXPECT_THAT(complaint_with("arm", good, R"("periodic")"), HasSubstr("is \"periodic\""));
  EXPECT_THAT(complaint_with("strut", good), HasSubstr("is not for a rigid beam"));
  EXPECT_THAT(complaint_with("ball", good), HasSubstr("unknown key \"initial_deflections\""));
  EXPECT_THAT(complaint_with("arm", R"([{"at": [1, 0, 0], "direction": [0, 1, 0]}])"),
              HasSubstr("/0 needs \"displacement\" or \"rate\""));
  EXPECT_THAT(
      complaint_with("arm", R"([{"at": [1, 1, 0], "direction": [0, 1, 0], "rate": 1}])"),
      HasSubstr("/scene/bodies/arm/initial_deflections/0/at must be on the axis of the beam"));
}

TEST_F(Mechanism, RepeatsItselfAfterAPeriodOrTheWholeTime) {
  const auto period_of = [](const char* state) {
    Json document = good_mechanism();
    document["simulation"]["initial_state"] = Json::parse(state);
    return read(document).simulation.period;
  };
  EXPECT_EQ(period_of(R"("consistent")"), 0.0);
  EXPECT_EQ(period_of(R"("periodic")"), 0.1);
  EXPECT_EQ(period_of(R"({"type": "periodic"})"), 0.1);
  EXPECT_EQ(period_of(R"({"type": "periodic", "period": "25 ms"})"), 0.025);
}

TEST_F(Mechanism, RepeatsItselfOnlyWithoutDriftAndWithEqualSteps) {
  Json document = good_mechanism();
  Json& simulation = document["simulation"];
  simulation["initial_state"] = "periodic";
  simulation["formulation"] = "index-1";
  EXPECT_THAT(complaint(document), HasSubstr("drift apart"));
  simulation["projection"] = true;
  EXPECT_EQ(complaint(document), "");
  simulation["local_error"] = 1e-3;
  EXPECT_THAT(complaint(document), HasSubstr("leave out \"local_error\""));
}

TEST_F(Mechanism, HasEveryBoundNumberVisited) {
  std::set<int> variables;
  visit_numbers(problem_.scene, [&variables](const Number& number) {
    if (number.is_bound()) variables.insert(number.variable);
  });
  EXPECT_THAT(variables, ElementsAre(0, 1, 2));
}

TEST_F(Mechanism, MayHaveTheLongestPolynomial) {
  const Json longest = edited(good_mechanism(), "/scene/joints/shoulder/drive/coefficients",
                              R"([0, 1, 2, 3, 4, 5, 6, 7, 8, 9, "10 rad/s^10"])");
  const Scene scene = read(longest).scene;
  int numbers = 0;
  visit_numbers(scene.joints[0], [&numbers](const Number&) { ++numbers; });
  EXPECT_EQ(numbers, 6 + 11);  // two points and the coefficients
}

TEST_F(Mechanism, MayHaveNoJoints) {  // a thrown body under a force
  const Json thrown = Json::parse(R"({
    "scene": {"bodies": {"ball": {"type": "point-mass", "at": [0, 0, 0], "mass": 1}},
              "loads": {"wind": {"type": "force", "body": "ball", "at": [0, 0, 0],
                                 "direction": [1, 0, 0], "value": 1}}},
    "simulation": {"end_time": 1, "step": 0.1}})");
  EXPECT_EQ(complaint(thrown), "");
}

TEST_F(Mechanism, MayMoveALoadWithItsBeam) {
  Json document =
      edited(good_mechanism(), "/variables/place", R"({"start": 0.5, "lower": 0.4, "upper": 0.6})");
  // Half way along the arm, whose end moves twice as far.
  document["scene"]["loads"]["push"]["at"][0] = Json::parse(R"({"variable": "place"})");
  const Json end = Json::parse(R"({"variable": "place", "factor": 2})");
  document["scene"]["bodies"]["arm"]["to"][0] = end;
  document["scene"]["bodies"]["rod"]["from"][0] = end;
  document["scene"]["joints"]["elbow"]["at"][0] = end;
  document["scene"]["joints"].erase("wrist");
  document["scene"]["joints"].erase("tie");
  document["responses"].erase("thrust");
  document["scene"]["loads"].erase("cord");
  EXPECT_EQ(complaint(document), "");
  document["scene"]["loads"]["push"]["at"][0] = 0.5;  // another share of the length
  EXPECT_EQ(complaint(document), "");
  document["scene"]["loads"]["push"]["at"][0] = 0.9;  // which is 0.8 long at the lower bound
  EXPECT_EQ(
      complaint(document),
      "bad.json: /scene/loads/push/at must not come nearer to the end of the beam \"arm\" than a "
      "hundredth of its distance at the start, which is 0.1 of the length, got (0.9, 0, 0), "
      "with the variable \"place\" at its lower bound");
}

TEST_F(Mechanism, MayHaveLegsDrivenSideBySide) {  // as in a hexapod
  Json document = good_mechanism();
  Json leg = document["scene"]["joints"]["tie"];
  leg["at"][0] = 1.75;
  document["scene"]["joints"]["second_tie"] = leg;
  EXPECT_EQ(complaint(document), "");
}

}  // namespace
}  // namespace pleuel::test::mechanism_test
