#include <gtest/gtest.h>

#include "tests/scene/bad_edit.hpp"
#include "tests/scene/good_problem.hpp"
#include "tests/support/parameter_name.hpp"

namespace pleuel::test::bad_load_test {
namespace {

INSTANTIATE_TEST_SUITE_P(
    Loads, BadMechanismFile,
    testing::Values(
        BadEdit{
            "/scene/loads/push/type", R"("weight")",
            R"(/scene/loads/push/type must be "force", "torque", "spring" or "joint", got "weight")"},
        BadEdit{"/scene/loads/push", "7", "/scene/loads/push must be an object {…}, got 7"},
        BadEdit{"/scene/loads", "[]", "/scene/loads must be an object {…}, got []"},
        BadEdit{
            "/scene/loads/push/place", "[0, 0, 0]",
            R"(/scene/loads/push has the unknown key "place"; known are "type", "body", "at", "direction", "value", "follows" and "to")"},
        BadEdit{"/scene/loads/push/body", R"("ground")",
                R"(/scene/loads/push/body must name a body that can move, got "ground")"},
        BadEdit{"/scene/loads/push/body", R"("arn")",
                R"(/scene/loads/push/body names the unknown body "arn"; did you mean "arm"?)"},
        BadEdit{"/scene/loads/push/at", "remove", R"(/scene/loads/push is missing the key "at")"},
        BadEdit{
            "/scene/loads/push/at", "[0.37, 0, 0.1]",
            R"(/scene/loads/push/at must be on the axis of the beam "arm", the nearest point is (0.37, 0, 0) [m], got (0.37, 0, 0.1))"},
        BadEdit{
            "/scene/loads/pull/at", "[4, 1, 0]",
            R"(/scene/loads/pull/at must be where the point mass "ball" is, (4, 0, 0) [m], got (4, 1, 0))"},
        BadEdit{
            "/scene/loads/push/at/0", R"({"variable": "speed", "factor": 0.37})",
            R"(/scene/loads/push/at/0 uses the variable "speed" as a length [m], but /scene/bodies/ball/velocity/0 uses it as a speed [m/s])"},
        BadEdit{"/scene/loads/push/direction", "[0, 0, 0]",
                "/scene/loads/push/direction must not be zero, got [0,0,0]"},
        BadEdit{"/scene/loads/push/direction/0", R"("1 m")",
                R"(/scene/loads/push/direction/0 must be a number, got "1 m")"},
        BadEdit{
            "/scene/loads/push/value", R"("2 kg")",
            R"(/scene/loads/push/value must be a force [N], got "2 kg": "kg" measures something else)"},
        BadEdit{
            "/scene/loads/push/value", "null",
            R"(/scene/loads/push/value must be a force [N]: a number in SI units, a text with unit, a formula "= …" or {"variable": name}, got null)"},
        BadEdit{"/scene/loads/push/value", "{}",
                R"(/scene/loads/push/value is missing the key "type")"},
        BadEdit{
            "/scene/loads/push/value", R"({"type": "constant-speed", "speed": 1})",
            R"(/scene/loads/push/value/type must be "constant", "polynomial", "harmonic", "table", "step", "ramp", "half-sine", "trapezoid" or "expression", got "constant-speed")"},
        BadEdit{
            "/scene/loads/push/value", R"({"type": "constant", "value": 1, "coordinate": "angle"})",
            R"(/scene/loads/push/value has the unknown key "coordinate"; known are "type" and "value")"},
        BadEdit{"/scene/loads/push/value", R"({"type": "constant"})",
                R"(/scene/loads/push/value is missing the key "value")"},
        BadEdit{
            "/scene/loads/push/value", R"({"variable": "fource"})",
            R"(/scene/loads/push/value/variable names the unknown variable "fource"; did you mean "force"?)"},
        BadEdit{"/scene/loads/push/follows", "1",
                "/scene/loads/push/follows must be true or false, got 1"},
        BadEdit{
            "/scene/loads/twist/body", R"("ball")",
            R"(/scene/loads/twist/body must name a body that can turn, but "ball" is a point mass)"},
        BadEdit{
            "/scene/loads/twist/value", R"("3 N")",
            R"(/scene/loads/twist/value must be a torque [N m], got "3 N": "N" measures something else)"}),
    named_by(&BadEdit::pointer));

INSTANTIATE_TEST_SUITE_P(
    ForceElements, BadMechanismFile,
    testing::Values(
        BadEdit{"/scene/loads/strap/bodies", R"(["ground", "ground"])",
                R"(/scene/loads/strap/bodies must name two bodies, got "ground" twice)"},
        BadEdit{
            "/scene/loads/strap/bodies/1", R"("bal")",
            R"(/scene/loads/strap/bodies/1 names the unknown body "bal"; did you mean "ball"?)"},
        BadEdit{"/scene/loads/strap/at", "[[4, 0, 0]]",
                "/scene/loads/strap/at must be a list of 2 values, got [[4,0,0]]"},
        BadEdit{"/scene/loads/strap/at", "[[4, 0, 0], [4, 0, 0]]",
                "/scene/loads/strap/at must be two different points, got [[4,0,0],[4,0,0]]"},
        BadEdit{
            "/scene/loads/strap/at/1/0", "4.5",
            R"(/scene/loads/strap/at/1 must be where the point mass "ball" is, (4, 0, 0) [m], got (4.5, 0, 0))"},
        BadEdit{
            "/scene/loads/cord/at/0/1", "1",
            R"(/scene/loads/cord/at/0 must be on the axis of the beam "arm", the nearest point is (0.123, 0, 0) [m], got (0.123, 1, 0))"},
        BadEdit{"/scene/loads/strap/stiffness", "remove",
                R"(/scene/loads/strap needs "stiffness" or "resistance")"},
        BadEdit{"/scene/loads/strap/stiffness", "-1",
                "/scene/loads/strap/stiffness must not be negative [N/m], got -1"},
        BadEdit{
            "/scene/loads/strap/damping", R"("1 N m s")",
            R"(/scene/loads/strap/damping must be a damping constant [N s/m], got "1 N m s": "N m s" measures something else)"},
        BadEdit{"/scene/loads/strap/free_length", R"("-1 mm")",
                R"(/scene/loads/strap/free_length must not be negative [m], got "-1 mm")"},
        BadEdit{
            "/scene/loads/hinge/joint", R"("elbo")",
            R"(/scene/loads/hinge/joint names the unknown joint "elbo"; did you mean "elbow"?)"},
        BadEdit{
            "/scene/loads/hinge/joint", R"("tie")",
            R"(/scene/loads/hinge/joint needs a joint of the type "revolute", "prismatic", "point-on-line", "cylindrical", "universal" or "planar", but "tie" is of the type "distance")"},
        BadEdit{
            "/scene/loads/hinge/joint", R"("wrist")",
            R"(/scene/loads/hinge/joint needs a joint of the type "revolute", "prismatic", "point-on-line", "cylindrical", "universal" or "planar", but "wrist" is of the type "spherical")"},
        BadEdit{"/scene/loads/hinge", R"({"type": "joint", "joint": "elbow"})",
                R"(/scene/loads/hinge needs "stiffness", "damping", "resistance" or "motor")"},
        BadEdit{
            "/scene/loads/hinge/rest", "0.1",
            R"(/scene/loads/hinge/rest is the rest position of a spring, and needs "stiffness" or "resistance")"},
        BadEdit{
            "/scene/loads/hinge/coordinate", R"("displacement")",
            R"(/scene/loads/hinge/coordinate must be "angle" for a joint of the type "universal", got "displacement")"},
        BadEdit{"/scene/loads/stopper/coordinate", "remove",
                R"(/scene/loads/stopper is missing the key "coordinate")"},
        BadEdit{"/scene/loads/hinge/motor", "1",
                R"(/scene/loads/hinge/motor would have no effect: the joint "elbow" is driven)"},
        BadEdit{
            "/scene/loads/hinge/damping", R"("1 N s/m")",
            R"(/scene/loads/hinge/damping must be a torsional damping constant [N m s/rad], got "1 N s/m": "N s/m" measures something else)"},
        BadEdit{
            "/scene/loads/bush/motor", R"("1 N m")",
            R"(/scene/loads/bush/motor must be a force [N], got "1 N m": "N m" measures something else)"},
        BadEdit{"/scene/loads/stopper/stiffness", "-1",
                "/scene/loads/stopper/stiffness must not be negative [N/m], got -1"}),
    named_by(&BadEdit::pointer));

TEST(GoodMechanismFile, MayHoldABodyByLoadsAlone) {
  Json document = edited(good_mechanism(), "/scene/joints/line", "remove");
  EXPECT_EQ(complaint(document), "");
  document["scene"]["loads"]["gust"]["value"] = document["scene"]["loads"]["pull"]["value"];
  document["scene"]["bodies"]["ball"]["velocity"][0] = 1;
  document["variables"].erase("speed");
  document["scene"]["loads"].erase("pull");
  document["scene"]["loads"].erase("strap");
  EXPECT_EQ(complaint(document),
            "bad.json: /scene/bodies/ball is not connected to anything by a joint or a load");
}

}  // namespace
}  // namespace pleuel::test::bad_load_test
