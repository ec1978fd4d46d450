#include <gtest/gtest.h>

#include "tests/scene/bad_edit.hpp"
#include "tests/support/parameter_name.hpp"

namespace pleuel::test::bad_response_test {
namespace {

INSTANTIATE_TEST_SUITE_P(
    Responses, BadMechanismFile,
    testing::Values(
        BadEdit{
            "/responses/speed/type", R"("velocty")",
            R"(/responses/speed/type must be "mass", "stress", "deflection", "position", "velocity", "acceleration", "drive-torque", "drive-force", "drive-power", "reaction-force", "reaction-moment", "frequency", "buckling", "kinetic-energy", "elastic-energy", "energy-balance", "constraint-drift", "expression", "section-force", "angular-velocity", "joint-position", "joint-velocity", "spring-length", "spring-force", "motor-power", "damper-power", "angle", "angular-acceleration", "fatigue", "shear-stress", "fatigue-damage", "lateral-buckling", "jerk", "angular-jerk", "joint-acceleration", "damping-ratio", "growth-rate" or "transmission-angle", got "velocty"; did you mean "velocity"?)"},
        BadEdit{
            "/responses/time", R"({"type": "mass"})",
            R"(/responses/time has a name that files of histories need for their own columns: "time" and "…:error")"},
        BadEdit{
            "/responses/speed:error", R"({"type": "mass"})",
            R"(/responses/speed:error has a name that files of histories need for their own columns: "time" and "…:error")"},
        BadEdit{"/responses/speed/at", "remove", R"(/responses/speed is missing the key "at")"},
        BadEdit{"/responses/speed/direction", R"("norm")",
                R"(/responses/speed/direction must be "x", "y", "z" or "magnitude", got "norm")"},
        BadEdit{"/responses/speed/type", R"("position")",
                R"(/responses/speed/direction must be "x", "y" or "z", got "magnitude")"},
        BadEdit{"/responses/jolt/at", "1",
                R"(/responses/jolt/at is for beams only, but "block" is none)"},
        BadEdit{"/responses/energy/joint", R"("wrist")",
                R"(/responses/energy/joint names the joint "wrist", which has no drive)"},
        BadEdit{"/responses/effort/joint", R"("tie")",
                R"(/responses/effort/joint names the joint "tie", whose drive has a drive-force)"},
        BadEdit{
            "/responses/thrust/joint", R"("elbow")",
            R"(/responses/thrust/joint names the joint "elbow", whose drive has a drive-torque)"},
        BadEdit{
            "/responses/bearing/joint", R"("pivt")",
            R"(/responses/bearing/joint names the unknown joint "pivt"; did you mean "pivot"?)"},
        BadEdit{"/responses/bearing/direction", "remove",
                R"(/responses/bearing is missing the key "direction")"},
        BadEdit{"/responses/tone/mode", "0",
                "/responses/tone/mode must be a whole number from 1 to 1000, got 0"},
        BadEdit{"/responses/tone/body", R"("strut")",
                R"(/responses/tone/body must name an elastic beam, but "strut" is rigid)"},
        BadEdit{"/responses/tone/body", R"("block")",
                R"(/responses/tone/body must name a beam, but "block" is none)"},
        BadEdit{"/responses/tone/over_time", R"("max")",
                "/responses/tone/over_time is not for a frequency, which does not change in time"},
        BadEdit{
            "/constraints/resonance/lower", R"("100 1/s")",
            R"(/constraints/resonance/lower must be a frequency [rad/s], got "100 1/s": "1/s" names no angle; write rad/s, deg/s or rpm)"},
        BadEdit{"/responses/stability/over_time", "remove",
                R"(/responses/stability is missing the key "over_time")"},
        BadEdit{"/responses/stability/body", R"("strut")",
                R"(/responses/stability/body must name an elastic beam, but "strut" is rigid)"},
        BadEdit{"/responses/axial/body", R"("strut")",
                R"(/responses/axial/body must name an elastic beam, but "strut" is rigid)"},
        BadEdit{
            "/responses/axial/part", R"("tension")",
            R"(/responses/axial/part must be "von-mises", "normal", "axial", "bending", "shear" or "utilization", got "tension")"},
        BadEdit{"/responses/shear/at", "0.5", R"(/responses/shear has both "segment" and "at")"},
        BadEdit{"/responses/swing/body", R"("blok")",
                R"(/responses/swing/body names the unknown body "blok"; did you mean "block"?)"},
        BadEdit{"/responses/spring/body", R"("strut")",
                R"(/responses/spring/body must name an elastic beam, but "strut" is rigid)"},
        BadEdit{"/responses/motion/over_time", "remove",
                R"(/responses/motion is missing the key "over_time")"},
        BadEdit{"/responses/missing/over_time", R"("max")",
                "/responses/missing/over_time is not for an energy-balance, which compares "
                "two times"},
        BadEdit{"/responses/drift/level", R"("speed")",
                R"(/responses/drift/level must be "position" or "velocity", got "speed")"},
        BadEdit{"/responses/normal/at", "1.1",
                "/responses/normal/at must be a place along the beam from 0 to 1, got 1.1"},
        BadEdit{"/responses/normal/at", R"("0.2 m")",
                R"(/responses/normal/at must be a place along the beam from 0 to 1, got "0.2 m")"},
        BadEdit{
            "/responses/life", R"({"type": "fatigue", "body": "arm", "criterion": "goodmann"})",
            R"(/responses/life/criterion must be "goodman", "gerber" or "soderberg", got "goodmann"; did you mean "goodman"?)"},
        BadEdit{
            "/responses/life", R"({"type": "fatigue", "body": "arm", "criterion": "gerber"})",
            R"(/responses/life/criterion needs the "endurance_limit" of the material "steel", which has none: give it in /scene/materials)"},
        BadEdit{
            "/responses/life",
            R"({"type": "fatigue", "body": "arm", "criterion": "gerber", "over_time": "max"})",
            "/responses/life/over_time is not for a fatigue, which looks at the largest and the "
            "smallest stress of cycles"},
        BadEdit{"/responses/life", R"({"type": "fatigue", "body": "strut", "criterion": "gerber"})",
                R"(/responses/life/body must name an elastic beam, but "strut" is rigid)"},
        BadEdit{
            "/responses/life",
            R"({"type": "fatigue-damage", "body": "arm", "criterion": "goodman"})",
            R"(/responses/life/criterion needs the "fatigue_strength" of the material "steel", which has none: give it in /scene/materials)"},
        BadEdit{"/responses/tau",
                R"({"type": "shear-stress", "body": "arm", "at": 2, "over_time": "max"})",
                "/responses/tau/at must be a place along the beam from 0 to 1, got 2"},
        BadEdit{"/responses/sideways",
                R"({"type": "lateral-buckling", "body": "strut", "over_time": "max"})",
                R"(/responses/sideways/body must name an elastic beam, but "strut" is rigid)"},
        BadEdit{"/responses/force",
                R"({"type": "section-force", "body": "arm", "at": 0.5, "part": "axial",
                "side": "left", "over_time": "max"})",
                R"(/responses/force/side must be "before" or "behind", got "left")"},
        BadEdit{
            "/responses/bow",
            R"({"type": "deflection", "body": "arm", "at": 0.5, "chord": ["a", "b"],
                "against": "chord", "over_time": "max"})",
            R"(/responses/bow/chord is for imported bodies with "against": "chord"; that of a beam is through its ends)"},
        BadEdit{"/scene/materials/steel/endurance_limit", R"("100 N")",
                "/scene/materials/steel/endurance_limit must be a stress [Pa], got \"100 N\": "
                "\"N\" measures something else"},
        BadEdit{"/scene/materials/steel/fatigue_exponent", "-8",
                "/scene/materials/steel/fatigue_exponent must be positive, got -8"},
        BadEdit{
            "/scene/materials/steel/fatigue_exponent", "0.1",
            "/scene/materials/steel/fatigue_exponent must be at least 1 (k of Basquin's line, 5 "
            "to 15 for metals; its slope b is -1/k), got 0.1"},
        BadEdit{
            "/scene/materials/steel/ultimate_strength", R"("100 MPa")",
            R"(/scene/materials/steel/strength must not be more than the "ultimate_strength", got "250 MPa")"},
        BadEdit{
            "/responses/use/body", R"("rod")",
            R"(/responses/use/part needs the strength of the material "glass", which has none)"},
        BadEdit{
            "/constraints/strength/upper", R"("80 MPa")",
            R"(/constraints/strength/upper must be a number without unit, got "80 MPa": "MPa" measures something else)"}),
    named_by(&BadEdit::pointer));

INSTANTIATE_TEST_SUITE_P(
    Windows, BadMechanismFile,
    testing::Values(
        BadEdit{"/responses/jolt/from", "-0.01",
                "/responses/jolt/from must not be negative [s], got -0.01"},
        BadEdit{"/responses/jolt/from", "0.1",
                "/responses/jolt/from must be before the end of the simulation, 0.1 [s], got 0.1"},
        BadEdit{
            "/responses/jolt/to", R"("101 ms")",
            R"(/responses/jolt/to must not be after the end of the simulation, 0.1 [s], got "101 ms")"},
        BadEdit{"/responses/jolt/to", "0.02",
                R"(/responses/jolt/to must be later than "from", got 0.02)"},
        BadEdit{"/responses/effort/to", "0", "/responses/effort/to must be positive [s], got 0"},
        BadEdit{
            "/responses/jolt/from", R"("1 m")",
            R"(/responses/jolt/from must be a time [s], got "1 m": "m" measures something else)"},
        BadEdit{"/simulation/end_time", "0.05",
                "/responses/jolt/to must not be after the end of the simulation, 0.05 [s], "
                "got 0.1",
                3}),
    named_by(&BadEdit::pointer));

}  // namespace
}  // namespace pleuel::test::bad_response_test
