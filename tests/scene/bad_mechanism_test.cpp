#include <ostream>
#include <string>

#include <gtest/gtest.h>

#include "tests/scene/good_problem.hpp"

namespace pleuel::test {
namespace {

/// An edit of the good mechanism and what the reader must say of it, after the name of the file.
struct BadMechanism {
  std::string pointer;
  std::string value;  ///< JSON, or "remove"
  std::string message;
};

void PrintTo(const BadMechanism& bad, std::ostream* stream) {
  *stream << bad.pointer << " = " << bad.value;
}

class BadMechanismFile : public testing::TestWithParam<BadMechanism> {};

TEST_P(BadMechanismFile, IsRefusedWithPlaceValueAndRule) {
  const BadMechanism& bad = GetParam();
  EXPECT_EQ(complaint(edited(good_mechanism(), bad.pointer, bad.value)),
            "bad.json: " + bad.message);
}

TEST(GoodMechanismFile, IsNotRefused) {
  EXPECT_EQ(complaint(good_mechanism()), "");
}

INSTANTIATE_TEST_SUITE_P(
    Bodies, BadMechanismFile,
    testing::Values(
        BadMechanism{
            "/scene/bodies/arm/frame", R"("mean-axes")",
            R"(/scene/bodies/arm/frame must be "tangent", "tangent-end", "chord" or "mean-axis", got "mean-axes"; did you mean "mean-axis"?)"},
        BadMechanism{"/scene/bodies/strut/rigid", R"("yes")",
                     R"(/scene/bodies/strut/rigid must be true or false, got "yes")"},
        BadMechanism{"/scene/bodies/strut/damping", "{}",
                     "/scene/bodies/strut/damping is not for a rigid beam"},
        BadMechanism{"/scene/bodies/strut/reduction", R"({"modes": 2})",
                     "/scene/bodies/strut/reduction is not for a rigid beam"},
        BadMechanism{"/scene/bodies/arm/reduction", "{}",
                     R"(/scene/bodies/arm/reduction needs "modes" or "frequency")"},
        BadMechanism{"/scene/bodies/arm/reduction/frequency", "100",
                     R"(/scene/bodies/arm/reduction has both "modes" and "frequency")"},
        BadMechanism{
            "/scene/bodies/arm/reduction/modes", "-1",
            "/scene/bodies/arm/reduction/modes must be a whole number from 0 to 1000, got -1"},
        BadMechanism{
            "/scene/bodies/arm/reduction/modes", "1.5",
            "/scene/bodies/arm/reduction/modes must be a whole number from 0 to 1000, got 1.5"},
        BadMechanism{
            "/scene/bodies/arm/reduction/mode", "1",
            R"(/scene/bodies/arm/reduction has the unknown key "mode"; did you mean "modes"?)"},
        BadMechanism{"/scene/bodies/rod/reduction/frequency", "0",
                     "/scene/bodies/rod/reduction/frequency must be positive [Hz], got 0"},
        BadMechanism{
            "/scene/bodies/rod/reduction/frequency", R"("2 rad/s")",
            R"(/scene/bodies/rod/reduction/frequency must be a frequency [Hz], got "2 rad/s": "rad/s" measures something else)"},
        BadMechanism{
            "/scene/bodies/rod/reduction/frequency", R"({"variable": "speed"})",
            R"(/scene/bodies/rod/reduction/frequency must be a frequency [Hz]: a number in SI units or a text with unit, got {"variable":"speed"})"},
        BadMechanism{"/scene/bodies/arm/reduction", "remove",
                     R"(/scene/bodies/arm/damping/modal is for beams with a "reduction" only)"},
        BadMechanism{"/scene/bodies/arm/damping/mass", "0",
                     R"(/scene/bodies/arm/damping has both "modal" and "mass")"},
        BadMechanism{"/scene/bodies/arm/damping/stiffness", "0",
                     R"(/scene/bodies/arm/damping has both "modal" and "stiffness")"},
        BadMechanism{"/scene/bodies/arm/damping/modal", "1",
                     "/scene/bodies/arm/damping/modal must be at least 0 and less than 1, got 1"},
        BadMechanism{
            "/scene/bodies/arm/damping/modal", "-0.1",
            "/scene/bodies/arm/damping/modal must be at least 0 and less than 1, got -0.1"},
        BadMechanism{
            "/scene/bodies/ball/angular_velocity", "[0, 0, 1]",
            "/scene/bodies/ball/angular_velocity is not for a point mass, which does not turn"},
        BadMechanism{
            "/scene/bodies/block/velocity/1", R"("1 m")",
            R"(/scene/bodies/block/velocity/1 must be a speed [m/s], got "1 m": "m" measures something else)"},
        BadMechanism{"/scene/bodies/block/velocity", "3",
                     "/scene/bodies/block/velocity must be a list of 3 values, got 3"},
        BadMechanism{
            "/scene/bodies/block/angular_velocity/0", R"("1 Hz")",
            R"(/scene/bodies/block/angular_velocity/0 must be an angular speed [rad/s], got "1 Hz": "Hz" names no angle; write rad/s, deg/s or rpm)"}));

INSTANTIATE_TEST_SUITE_P(
    Joints, BadMechanismFile,
    testing::Values(
        BadMechanism{"/scene/joints/shoulder/axis", "remove",
                     R"(/scene/joints/shoulder is missing the key "axis")"},
        BadMechanism{"/scene/joints/floor/axis", "remove",
                     R"(/scene/joints/floor is missing the key "axis")"},
        BadMechanism{"/scene/joints/elbow/axis", "remove",
                     R"(/scene/joints/elbow is missing the key "axis")"},
        BadMechanism{"/scene/joints/elbow/second_axis", "remove",
                     R"(/scene/joints/elbow is missing the key "second_axis")"},
        BadMechanism{
            "/scene/joints/elbow/second_axis", "[0, 1, 1e-8]",
            R"(/scene/joints/elbow/second_axis must be normal to "axis", got [0,1,1e-08])"},
        BadMechanism{"/scene/joints/elbow/second_axis", "[0, 0, 0]",
                     "/scene/joints/elbow/second_axis must not be zero, got [0,0,0]"},
        BadMechanism{"/scene/joints/floor/second_axis", "[1, 0, 0]",
                     "/scene/joints/floor/second_axis is for universal joints only"},
        BadMechanism{"/scene/joints/wrist/axis", "[1, 0, 0]",
                     "/scene/joints/wrist/axis is not for a spherical joint, which has no axis"},
        BadMechanism{"/scene/joints/tie/axis", "[1, 0, 0]",
                     "/scene/joints/tie/axis is not for a distance joint, which has no axis"},
        BadMechanism{"/scene/joints/tie/to", "remove",
                     R"(/scene/joints/tie is missing the key "to")"},
        BadMechanism{"/scene/joints/wrist/to", "[1, 0, 0]",
                     "/scene/joints/wrist/to is for distance joints only"},
        BadMechanism{"/scene/joints/tie/to", "[1.25, 0, 0]",
                     R"(/scene/joints/tie/to must not be the same point as "at", got [1.25,0,0])"},
        BadMechanism{
            "/scene/joints/tie/to/0", R"("1")",
            R"(/scene/joints/tie/to/0 must be a length [m], got "1": a number in quotes needs its unit)"},
        BadMechanism{
            "/scene/joints/tie/at", "[1.25, 0.1, 0]",
            R"(/scene/joints/tie/at must be on the axis of the beam "rod", the nearest point is (1.25, 0, 0) [m], got (1.25, 0.1, 0))"},
        BadMechanism{
            "/scene/joints/wrist/at/0", "2.1",
            R"(/scene/joints/wrist/at must be on the axis of the beam "rod", the nearest point is (2, 0, 0) [m], got (2.1, 0, 0))"}));

INSTANTIATE_TEST_SUITE_P(
    Drives, BadMechanismFile,
    testing::Values(
        BadMechanism{
            "/scene/joints/wrist/drive", R"({"type": "constant-speed", "speed": 1})",
            R"(/scene/joints/wrist/drive needs a joint of the type "revolute", "prismatic", "point-on-line", "cylindrical", "universal", "planar" or "distance", but "wrist" is of the type "spherical")"},
        BadMechanism{"/scene/joints/shoulder/drive/coordinate", "remove",
                     R"(/scene/joints/shoulder/drive is missing the key "coordinate")"},
        BadMechanism{
            "/scene/joints/shoulder/drive/coordinate", R"("turn")",
            R"(/scene/joints/shoulder/drive/coordinate must be "angle" or "displacement", got "turn")"},
        BadMechanism{
            "/scene/joints/elbow/drive/coordinate", R"("displacement")",
            R"(/scene/joints/elbow/drive/coordinate must be "angle" for a joint of the type "universal", got "displacement")"},
        BadMechanism{
            "/scene/joints/line/drive/coordinate", R"("angle")",
            R"(/scene/joints/line/drive/coordinate must be "displacement" for a joint of the type "point-on-line", got "angle")"},
        BadMechanism{
            "/scene/joints/shoulder/drive/coordinate", R"("displacement")",
            R"(/scene/joints/shoulder/drive/coefficients/1 must be a speed [m/s], got "60 rpm": "rpm" measures something else)"},
        BadMechanism{
            "/scene/joints/line/drive/speed", R"("20 rad/s")",
            R"(/scene/joints/line/drive/speed must be a speed [m/s], got "20 rad/s": "rad/s" measures something else)"},
        BadMechanism{"/scene/joints/line/drive", "3",
                     "/scene/joints/line/drive must be an object {…}, got 3"},
        BadMechanism{
            "/scene/joints/line/drive/type", R"("sine")",
            R"(/scene/joints/line/drive/type must be "constant-speed", "ramp-to-speed", "constant", "polynomial", "harmonic" or "table", got "sine")"},
        BadMechanism{
            "/scene/joints/line/drive/sped", "1",
            R"(/scene/joints/line/drive has the unknown key "sped"; did you mean "speed"?)"},
        BadMechanism{
            "/scene/joints/shoulder/drive/coefficients", "[]",
            "/scene/joints/shoulder/drive/coefficients must have from 1 to 11 coefficients, got 0"},
        BadMechanism{"/scene/joints/shoulder/drive/coefficients",
                     "[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11]",
                     "/scene/joints/shoulder/drive/coefficients must have from 1 to 11 "
                     "coefficients, got 12"},
        BadMechanism{
            "/scene/joints/shoulder/drive/coefficients/2", R"("1 rad/s")",
            R"(/scene/joints/shoulder/drive/coefficients/2 must be a coefficient of t^2 [rad/s^2], got "1 rad/s": "rad/s" measures something else)"},
        BadMechanism{"/scene/joints/elbow/drive/frequency", "remove",
                     R"(/scene/joints/elbow/drive is missing the key "frequency")"},
        BadMechanism{"/scene/joints/elbow/drive/frequency", "0",
                     "/scene/joints/elbow/drive/frequency must be positive [rad/s], got 0"},
        BadMechanism{
            "/scene/joints/elbow/drive/frequency", R"("10 Hz")",
            R"(/scene/joints/elbow/drive/frequency must be an angular speed [rad/s], got "10 Hz": "Hz" names no angle; write rad/s, deg/s or rpm)"},
        BadMechanism{
            "/scene/joints/elbow/drive/phase", R"("1 s")",
            R"(/scene/joints/elbow/drive/phase must be an angle [rad], got "1 s": "s" measures something else)"},
        BadMechanism{"/scene/joints/tie/drive/times", "[0]",
                     "/scene/joints/tie/drive/times must have at least two times, got [0]"},
        BadMechanism{
            "/scene/joints/tie/drive/times", "[0, 0.1, 0.1]",
            "/scene/joints/tie/drive/times/2 must be later than the time before it, got 0.1"},
        BadMechanism{"/scene/joints/tie/drive/values", "[0, 1]",
                     "/scene/joints/tie/drive/values must be a list of 3 values, got [0,1]"},
        BadMechanism{
            "/scene/joints/tie/drive/values/1", R"("1 deg")",
            R"(/scene/joints/tie/drive/values/1 must be a length [m], got "1 deg": "deg" measures something else)"},
        BadMechanism{
            "/scene/joints/floor/bodies/1", R"("ball")",
            R"(/scene/joints/floor/drive needs two bodies that can turn, but "ball" is a point mass)"},
        BadMechanism{
            "/scene/joints/second_shoulder",
            R"({"type": "revolute", "bodies": ["arm", "ground"], "at": [0.5, 0, 0], "axis": [0, 0, -1], "drive": {"type": "constant-speed", "speed": 1}})",
            R"(/scene/joints/second_shoulder/drive prescribes the same motion as the drive of the joint "shoulder")"}));

INSTANTIATE_TEST_SUITE_P(
    Loads, BadMechanismFile,
    testing::Values(
        BadMechanism{
            "/scene/loads/push/type", R"("weight")",
            R"(/scene/loads/push/type must be "force", "torque", "spring" or "joint", got "weight")"},
        BadMechanism{"/scene/loads/push", "7", "/scene/loads/push must be an object {…}, got 7"},
        BadMechanism{"/scene/loads", "[]", "/scene/loads must be an object {…}, got []"},
        BadMechanism{
            "/scene/loads/push/place", "[0, 0, 0]",
            R"(/scene/loads/push has the unknown key "place"; known are "type", "body", "at", "direction", "value" and "follows")"},
        BadMechanism{"/scene/loads/push/body", R"("ground")",
                     R"(/scene/loads/push/body must name a body that can move, got "ground")"},
        BadMechanism{"/scene/loads/push/body", R"("arn")",
                     R"(/scene/loads/push/body names the unknown body "arn"; did you mean "arm"?)"},
        BadMechanism{"/scene/loads/push/at", "remove",
                     R"(/scene/loads/push is missing the key "at")"},
        BadMechanism{
            "/scene/loads/push/at", "[0.37, 0, 0.1]",
            R"(/scene/loads/push/at must be on the axis of the beam "arm", the nearest point is (0.37, 0, 0) [m], got (0.37, 0, 0.1))"},
        BadMechanism{
            "/scene/loads/pull/at", "[4, 1, 0]",
            R"(/scene/loads/pull/at must be where the point mass "ball" is, (4, 0, 0) [m], got (4, 1, 0))"},
        BadMechanism{
            "/scene/loads/push/at/0", R"({"variable": "speed", "factor": 0.37})",
            R"(/scene/loads/push/at/0 uses the variable "speed" as a length [m], but /scene/bodies/ball/velocity/0 uses it as a speed [m/s])"},
        BadMechanism{"/scene/loads/push/direction", "[0, 0, 0]",
                     "/scene/loads/push/direction must not be zero, got [0,0,0]"},
        BadMechanism{"/scene/loads/push/direction/0", R"("1 m")",
                     R"(/scene/loads/push/direction/0 must be a number, got "1 m")"},
        BadMechanism{
            "/scene/loads/push/value", R"("2 kg")",
            R"(/scene/loads/push/value must be a force [N], got "2 kg": "kg" measures something else)"},
        BadMechanism{
            "/scene/loads/push/value", "null",
            R"(/scene/loads/push/value must be a force [N]: a number in SI units, a text with unit or {"variable": name}, got null)"},
        BadMechanism{"/scene/loads/push/value", "{}",
                     R"(/scene/loads/push/value is missing the key "type")"},
        BadMechanism{
            "/scene/loads/push/value", R"({"type": "constant-speed", "speed": 1})",
            R"(/scene/loads/push/value/type must be "constant", "polynomial", "harmonic" or "table", got "constant-speed")"},
        BadMechanism{
            "/scene/loads/push/value", R"({"type": "constant", "value": 1, "coordinate": "angle"})",
            R"(/scene/loads/push/value has the unknown key "coordinate"; known are "type" and "value")"},
        BadMechanism{"/scene/loads/push/value", R"({"type": "constant"})",
                     R"(/scene/loads/push/value is missing the key "value")"},
        BadMechanism{
            "/scene/loads/push/value", R"({"variable": "fource"})",
            R"(/scene/loads/push/value/variable names the unknown variable "fource"; did you mean "force"?)"},
        BadMechanism{"/scene/loads/push/follows", "1",
                     "/scene/loads/push/follows must be true or false, got 1"},
        BadMechanism{
            "/scene/loads/twist/body", R"("ball")",
            R"(/scene/loads/twist/body must name a body that can turn, but "ball" is a point mass)"},
        BadMechanism{
            "/scene/loads/twist/value", R"("3 N")",
            R"(/scene/loads/twist/value must be a torque [N m], got "3 N": "N" measures something else)"}));

INSTANTIATE_TEST_SUITE_P(
    ForceElements, BadMechanismFile,
    testing::Values(
        BadMechanism{"/scene/loads/strap/bodies", R"(["ground", "ground"])",
                     R"(/scene/loads/strap/bodies must name two bodies, got "ground" twice)"},
        BadMechanism{
            "/scene/loads/strap/bodies/1", R"("bal")",
            R"(/scene/loads/strap/bodies/1 names the unknown body "bal"; did you mean "ball"?)"},
        BadMechanism{"/scene/loads/strap/at", "[[4, 0, 0]]",
                     "/scene/loads/strap/at must be a list of 2 values, got [[4,0,0]]"},
        BadMechanism{"/scene/loads/strap/at", "[[4, 0, 0], [4, 0, 0]]",
                     "/scene/loads/strap/at must be two different points, got [[4,0,0],[4,0,0]]"},
        BadMechanism{
            "/scene/loads/strap/at/1/0", "4.5",
            R"(/scene/loads/strap/at/1 must be where the point mass "ball" is, (4, 0, 0) [m], got (4.5, 0, 0))"},
        BadMechanism{
            "/scene/loads/cord/at/0/1", "1",
            R"(/scene/loads/cord/at/0 must be on the axis of the beam "arm", the nearest point is (0.123, 0, 0) [m], got (0.123, 1, 0))"},
        BadMechanism{"/scene/loads/strap/stiffness", "remove",
                     R"(/scene/loads/strap is missing the key "stiffness")"},
        BadMechanism{"/scene/loads/strap/stiffness", "-1",
                     "/scene/loads/strap/stiffness must not be negative [N/m], got -1"},
        BadMechanism{
            "/scene/loads/strap/damping", R"("1 N m s")",
            R"(/scene/loads/strap/damping must be a damping constant [N s/m], got "1 N m s": "N m s" measures something else)"},
        BadMechanism{"/scene/loads/strap/free_length", R"("-1 mm")",
                     R"(/scene/loads/strap/free_length must not be negative [m], got "-1 mm")"},
        BadMechanism{
            "/scene/loads/hinge/joint", R"("elbo")",
            R"(/scene/loads/hinge/joint names the unknown joint "elbo"; did you mean "elbow"?)"},
        BadMechanism{
            "/scene/loads/hinge/joint", R"("tie")",
            R"(/scene/loads/hinge/joint needs a joint of the type "revolute", "prismatic", "point-on-line", "cylindrical", "universal" or "planar", but "tie" is of the type "distance")"},
        BadMechanism{
            "/scene/loads/hinge/joint", R"("wrist")",
            R"(/scene/loads/hinge/joint needs a joint of the type "revolute", "prismatic", "point-on-line", "cylindrical", "universal" or "planar", but "wrist" is of the type "spherical")"},
        BadMechanism{
            "/scene/loads/hinge", R"({"type": "joint", "joint": "elbow"})",
            R"(/scene/loads/hinge does nothing; it needs "stiffness", "damping" or "motor")"},
        BadMechanism{
            "/scene/loads/hinge/rest", "0.1",
            R"(/scene/loads/hinge/rest is the rest position of a spring, and needs "stiffness")"},
        BadMechanism{
            "/scene/loads/hinge/coordinate", R"("displacement")",
            R"(/scene/loads/hinge/coordinate must be "angle" for a joint of the type "universal", got "displacement")"},
        BadMechanism{"/scene/loads/stopper/coordinate", "remove",
                     R"(/scene/loads/stopper is missing the key "coordinate")"},
        BadMechanism{
            "/scene/loads/hinge/motor", "1",
            R"(/scene/loads/hinge/motor would have no effect: the joint "elbow" is driven)"},
        BadMechanism{
            "/scene/loads/hinge/damping", R"("1 N s/m")",
            R"(/scene/loads/hinge/damping must be a torsional damping constant [N m s/rad], got "1 N s/m": "N s/m" measures something else)"},
        BadMechanism{
            "/scene/loads/bush/motor", R"("1 N m")",
            R"(/scene/loads/bush/motor must be a force [N], got "1 N m": "N m" measures something else)"},
        BadMechanism{"/scene/loads/stopper/stiffness", "-1",
                     "/scene/loads/stopper/stiffness must not be negative [N/m], got -1"}));

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

INSTANTIATE_TEST_SUITE_P(
    Responses, BadMechanismFile,
    testing::Values(
        BadMechanism{
            "/responses/speed/type", R"("velocty")",
            R"(/responses/speed/type must be "mass", "stress", "deflection", "position", "velocity", "acceleration", "drive-torque", "drive-force", "drive-power", "reaction-force", "reaction-moment", "frequency", "buckling", "kinetic-energy", "elastic-energy", "energy-balance" or "constraint-drift", got "velocty"; did you mean "velocity"?)"},
        BadMechanism{"/responses/speed/at", "remove",
                     R"(/responses/speed is missing the key "at")"},
        BadMechanism{
            "/responses/speed/direction", R"("norm")",
            R"(/responses/speed/direction must be "x", "y", "z" or "magnitude", got "norm")"},
        BadMechanism{"/responses/speed/type", R"("position")",
                     R"(/responses/speed/direction must be "x", "y" or "z", got "magnitude")"},
        BadMechanism{"/responses/jolt/at", "1",
                     R"(/responses/jolt/at is for beams only, but "block" is none)"},
        BadMechanism{"/responses/energy/joint", R"("wrist")",
                     R"(/responses/energy/joint names the joint "wrist", which has no drive)"},
        BadMechanism{
            "/responses/effort/joint", R"("tie")",
            R"(/responses/effort/joint names the joint "tie", whose drive has a drive-force)"},
        BadMechanism{
            "/responses/thrust/joint", R"("elbow")",
            R"(/responses/thrust/joint names the joint "elbow", whose drive has a drive-torque)"},
        BadMechanism{
            "/responses/bearing/joint", R"("pivt")",
            R"(/responses/bearing/joint names the unknown joint "pivt"; did you mean "pivot"?)"},
        BadMechanism{"/responses/bearing/direction", "remove",
                     R"(/responses/bearing is missing the key "direction")"},
        BadMechanism{"/responses/tone/mode", "0",
                     "/responses/tone/mode must be a whole number from 1 to 1000, got 0"},
        BadMechanism{"/responses/tone/body", R"("strut")",
                     R"(/responses/tone/body must name an elastic beam, but "strut" is rigid)"},
        BadMechanism{"/responses/tone/body", R"("block")",
                     R"(/responses/tone/body must name a beam, but "block" is none)"},
        BadMechanism{
            "/responses/tone/over_time", R"("max")",
            "/responses/tone/over_time is not for a frequency, which does not change in time"},
        BadMechanism{
            "/constraints/resonance/lower", R"("100 Hz")",
            R"(/constraints/resonance/lower must be an angular speed [rad/s], got "100 Hz": "Hz" names no angle; write rad/s, deg/s or rpm)"},
        BadMechanism{"/responses/stability/over_time", "remove",
                     R"(/responses/stability is missing the key "over_time")"},
        BadMechanism{
            "/responses/stability/body", R"("strut")",
            R"(/responses/stability/body must name an elastic beam, but "strut" is rigid)"},
        BadMechanism{"/responses/axial/body", R"("strut")",
                     R"(/responses/axial/body must name an elastic beam, but "strut" is rigid)"},
        BadMechanism{
            "/responses/axial/part", R"("tension")",
            R"(/responses/axial/part must be "von-mises", "normal", "axial", "bending", "shear" or "utilization", got "tension")"},
        BadMechanism{"/responses/shear/at", "0.5",
                     R"(/responses/shear has both "segment" and "at")"},
        BadMechanism{
            "/responses/swing/body", R"("blok")",
            R"(/responses/swing/body names the unknown body "blok"; did you mean "block"?)"},
        BadMechanism{"/responses/spring/body", R"("strut")",
                     R"(/responses/spring/body must name an elastic beam, but "strut" is rigid)"},
        BadMechanism{"/responses/motion/over_time", "remove",
                     R"(/responses/motion is missing the key "over_time")"},
        BadMechanism{"/responses/missing/over_time", R"("max")",
                     "/responses/missing/over_time is not for an energy-balance, which compares "
                     "two times"},
        BadMechanism{"/responses/drift/level", R"("speed")",
                     R"(/responses/drift/level must be "position" or "velocity", got "speed")"},
        BadMechanism{"/responses/normal/at", "1.1",
                     "/responses/normal/at must be a place along the beam from 0 to 1, got 1.1"},
        BadMechanism{
            "/responses/use/body", R"("rod")",
            R"(/responses/use/part needs the strength of the material "glass", which has none)"},
        BadMechanism{
            "/constraints/strength/upper", R"("80 MPa")",
            R"(/constraints/strength/upper must be a number without unit, got "80 MPa": "MPa" measures something else)"},
        BadMechanism{
            "/objective/scale", R"("2 W")",
            R"(/objective/scale must be an energy [J], got "2 W": "W" measures something else)"}));

INSTANTIATE_TEST_SUITE_P(
    Windows, BadMechanismFile,
    testing::Values(
        BadMechanism{"/responses/jolt/from", "-0.01",
                     "/responses/jolt/from must not be negative [s], got -0.01"},
        BadMechanism{
            "/responses/jolt/from", "0.1",
            "/responses/jolt/from must be before the end of the simulation, 0.1 [s], got 0.1"},
        BadMechanism{
            "/responses/jolt/to", R"("101 ms")",
            R"(/responses/jolt/to must not be after the end of the simulation, 0.1 [s], got "101 ms")"},
        BadMechanism{"/responses/jolt/to", "0.02",
                     R"(/responses/jolt/to must be later than "from", got 0.02)"},
        BadMechanism{"/responses/effort/to", "0",
                     "/responses/effort/to must be positive [s], got 0"},
        BadMechanism{
            "/responses/jolt/from", R"("1 m")",
            R"(/responses/jolt/from must be a time [s], got "1 m": "m" measures something else)"},
        BadMechanism{"/simulation/end_time", "0.05",
                     "/responses/jolt/to must not be after the end of the simulation, 0.05 [s], "
                     "got 0.1"}));

INSTANTIATE_TEST_SUITE_P(
    Settings, BadMechanismFile,
    testing::Values(
        BadMechanism{"/effects/elasticity", "1",
                     R"(/effects/elasticity must be "auto", "on" or "off", got 1)"},
        BadMechanism{
            "/effects/rotary_inertia", R"("offf")",
            R"(/effects/rotary_inertia must be "auto", "on" or "off", got "offf"; did you mean "off"?)"},
        BadMechanism{"/effects/tolerance", "1",
                     "/effects/tolerance must be at least 0 and less than 1, got 1"},
        BadMechanism{"/effects/tolerance", "-1e-3",
                     "/effects/tolerance must be at least 0 and less than 1, got -0.001"},
        BadMechanism{"/effects/tolerance", R"("1 %")",
                     R"(/effects/tolerance must be a number, got "1 %")"},
        BadMechanism{
            "/simulation/initial_state", R"("static")",
            R"(/simulation/initial_state must be "consistent" or "quasi-static", got "static")"}));

}  // namespace
}  // namespace pleuel::test
