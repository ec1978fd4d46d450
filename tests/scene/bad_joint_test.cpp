#include <gtest/gtest.h>

#include "tests/scene/bad_edit.hpp"
#include "tests/support/parameter_name.hpp"

namespace pleuel::test::bad_joint_test {
namespace {

INSTANTIATE_TEST_SUITE_P(
    Joints, BadMechanismFile,
    testing::Values(
        BadEdit{"/scene/joints/shoulder/axis", "remove",
                R"(/scene/joints/shoulder is missing the key "axis")"},
        BadEdit{"/scene/joints/floor/axis", "remove",
                R"(/scene/joints/floor is missing the key "axis")"},
        BadEdit{"/scene/joints/elbow/axis", "remove",
                R"(/scene/joints/elbow is missing the key "axis")"},
        BadEdit{"/scene/joints/elbow/second_axis", "remove",
                R"(/scene/joints/elbow is missing the key "second_axis")"},
        BadEdit{"/scene/joints/elbow/second_axis", "[0, 1, 1e-8]",
                R"(/scene/joints/elbow/second_axis must be normal to "axis", got [0,1,1e-08])"},
        BadEdit{"/scene/joints/elbow/second_axis", "[0, 0, 0]",
                "/scene/joints/elbow/second_axis must not be zero, got [0,0,0]"},
        BadEdit{"/scene/joints/floor/second_axis", "[1, 0, 0]",
                "/scene/joints/floor/second_axis is for universal joints only"},
        BadEdit{"/scene/joints/wrist/axis", "[1, 0, 0]",
                "/scene/joints/wrist/axis is not for a spherical joint, which has no axis"},
        BadEdit{"/scene/joints/tie/axis", "[1, 0, 0]",
                "/scene/joints/tie/axis is not for a distance joint, which has no axis"},
        BadEdit{"/scene/joints/tie/to", "remove", R"(/scene/joints/tie is missing the key "to")"},
        BadEdit{"/scene/joints/wrist/to", "[1, 0, 0]",
                "/scene/joints/wrist/to is for distance joints only"},
        BadEdit{"/scene/joints/tie/to", "[1.25, 0, 0]",
                R"(/scene/joints/tie/to must not be the same point as "at", got [1.25,0,0])"},
        BadEdit{
            "/scene/joints/tie/to/0", R"("1")",
            R"(/scene/joints/tie/to/0 must be a length [m], got "1": a number in quotes needs its unit)"},
        BadEdit{
            "/scene/joints/tie/at", "[1.25, 0.1, 0]",
            R"(/scene/joints/tie/at must be on the axis of the beam "rod", the nearest point is (1.25, 0, 0) [m], got (1.25, 0.1, 0))"},
        BadEdit{
            "/scene/joints/wrist/at/0", "2.1",
            R"(/scene/joints/wrist/at must be on the axis of the beam "rod", the nearest point is (2, 0, 0) [m], got (2.1, 0, 0))"}),
    named_by(&BadEdit::pointer));

INSTANTIATE_TEST_SUITE_P(
    Drives, BadMechanismFile,
    testing::Values(
        BadEdit{
            "/scene/joints/wrist/drive", R"({"type": "constant-speed", "speed": 1})",
            R"(/scene/joints/wrist/drive needs a joint of the type "revolute", "prismatic", "point-on-line", "cylindrical", "universal", "planar" or "distance", but "wrist" is of the type "spherical")"},
        BadEdit{"/scene/joints/shoulder/drive/coordinate", "remove",
                R"(/scene/joints/shoulder/drive is missing the key "coordinate")"},
        BadEdit{
            "/scene/joints/shoulder/drive/coordinate", R"("turn")",
            R"(/scene/joints/shoulder/drive/coordinate must be "angle" or "displacement", got "turn")"},
        BadEdit{
            "/scene/joints/elbow/drive/coordinate", R"("displacement")",
            R"(/scene/joints/elbow/drive/coordinate must be "angle" for a joint of the type "universal", got "displacement")"},
        BadEdit{
            "/scene/joints/line/drive/coordinate", R"("angle")",
            R"(/scene/joints/line/drive/coordinate must be "displacement" for a joint of the type "point-on-line", got "angle")"},
        BadEdit{
            "/scene/joints/shoulder/drive/coordinate", R"("displacement")",
            R"(/scene/joints/shoulder/drive/coefficients/1 must be a speed [m/s], got "60 rpm": "rpm" measures something else)"},
        BadEdit{
            "/scene/joints/line/drive/speed", R"("20 rad/s")",
            R"(/scene/joints/line/drive/speed must be a speed [m/s], got "20 rad/s": "rad/s" measures something else)"},
        BadEdit{"/scene/joints/line/drive", "3",
                "/scene/joints/line/drive must be an object {…}, got 3"},
        BadEdit{
            "/scene/joints/line/drive/type", R"("sine")",
            R"(/scene/joints/line/drive/type must be "constant-speed", "ramp-to-speed", "constant", "polynomial", "harmonic", "table", "step", "ramp", "trapezoid" or "expression", got "sine")"},
        BadEdit{"/scene/joints/line/drive/sped", "1",
                R"(/scene/joints/line/drive has the unknown key "sped"; did you mean "speed"?)"},
        BadEdit{
            "/scene/joints/shoulder/drive/coefficients", "[]",
            "/scene/joints/shoulder/drive/coefficients must have from 1 to 11 coefficients, got 0"},
        BadEdit{"/scene/joints/shoulder/drive/coefficients",
                "[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11]",
                "/scene/joints/shoulder/drive/coefficients must have from 1 to 11 "
                "coefficients, got 12"},
        BadEdit{
            "/scene/joints/shoulder/drive/coefficients/2", R"("1 rad/s")",
            R"(/scene/joints/shoulder/drive/coefficients/2 must be a coefficient of t^2 [rad/s^2], got "1 rad/s": "rad/s" measures something else)"},
        BadEdit{"/scene/joints/elbow/drive/frequency", "remove",
                R"(/scene/joints/elbow/drive is missing the key "frequency")"},
        BadEdit{"/scene/joints/elbow/drive/frequency", "0",
                "/scene/joints/elbow/drive/frequency must be positive [rad/s], got 0"},
        BadEdit{
            "/scene/joints/elbow/drive/frequency", R"("10 1/s")",
            R"(/scene/joints/elbow/drive/frequency must be a frequency [rad/s], got "10 1/s": "1/s" names no angle; write rad/s, deg/s or rpm)"},
        BadEdit{
            "/scene/joints/elbow/drive/phase", R"("1 s")",
            R"(/scene/joints/elbow/drive/phase must be an angle [rad], got "1 s": "s" measures something else)"},
        BadEdit{"/scene/joints/tie/drive/times", "[0]",
                "/scene/joints/tie/drive/times must have at least two times, got [0]"},
        BadEdit{"/scene/joints/tie/drive/times", "[0, 0.1, 0.1]",
                "/scene/joints/tie/drive/times/2 must be later than the time before it, got 0.1"},
        BadEdit{"/scene/joints/tie/drive/values", "[0, 1]",
                "/scene/joints/tie/drive/values must be a list of 3 values, got [0,1]"},
        BadEdit{
            "/scene/joints/tie/drive/values/1", R"("1 deg")",
            R"(/scene/joints/tie/drive/values/1 must be a length [m], got "1 deg": "deg" measures something else)"},
        BadEdit{
            "/scene/joints/floor/bodies/1", R"("ball")",
            R"(/scene/joints/floor/drive needs two bodies that can turn, but "ball" is a point mass)"},
        BadEdit{
            "/scene/joints/second_shoulder",
            R"({"type": "revolute", "bodies": ["arm", "ground"], "at": [0.5, 0, 0], "axis": [0, 0, -1], "drive": {"type": "constant-speed", "speed": 1}})",
            R"(/scene/joints/second_shoulder/drive prescribes the same motion as the drive of the joint "shoulder")"}),
    named_by(&BadEdit::pointer));

}  // namespace
}  // namespace pleuel::test::bad_joint_test
