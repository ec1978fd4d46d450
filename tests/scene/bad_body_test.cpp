#include <gtest/gtest.h>

#include "tests/scene/bad_edit.hpp"
#include "tests/support/parameter_name.hpp"

namespace pleuel::test::bad_body_test {
namespace {

INSTANTIATE_TEST_SUITE_P(
    Bodies, BadMechanismFile,
    testing::Values(
        BadEdit{
            "/scene/bodies/arm/frame", R"("mean-axes")",
            R"(/scene/bodies/arm/frame must be "tangent", "tangent-end", "chord" or "mean-axis", got "mean-axes"; did you mean "mean-axis"?)"},
        BadEdit{"/scene/bodies/strut/rigid", R"("yes")",
                R"(/scene/bodies/strut/rigid must be true or false, got "yes")"},
        BadEdit{"/scene/bodies/strut/damping", "{}",
                "/scene/bodies/strut/damping is not for a rigid beam"},
        BadEdit{"/scene/bodies/strut/reduction", R"({"modes": 2})",
                "/scene/bodies/strut/reduction is not for a rigid beam"},
        BadEdit{"/scene/bodies/strut/shear", "true",
                "/scene/bodies/strut/shear is not for a rigid beam"},
        BadEdit{"/scene/bodies/arm/shear", "1",
                "/scene/bodies/arm/shear must be true or false, got 1"},
        BadEdit{"/scene/bodies/arm/reduction", "{}",
                R"(/scene/bodies/arm/reduction needs "modes" or "frequency")"},
        BadEdit{"/scene/bodies/arm/reduction/frequency", "100",
                R"(/scene/bodies/arm/reduction has both "modes" and "frequency")"},
        BadEdit{"/scene/bodies/arm/reduction/modes", "-1",
                "/scene/bodies/arm/reduction/modes must be a whole number from 0 to 1000, got -1"},
        BadEdit{"/scene/bodies/arm/reduction/modes", "1.5",
                "/scene/bodies/arm/reduction/modes must be a whole number from 0 to 1000, got 1.5"},
        BadEdit{"/scene/bodies/arm/reduction/mode", "1",
                R"(/scene/bodies/arm/reduction has the unknown key "mode"; did you mean "modes"?)"},
        BadEdit{"/scene/bodies/rod/reduction/frequency", "0",
                "/scene/bodies/rod/reduction/frequency must be positive [Hz], got 0"},
        BadEdit{
            "/scene/bodies/rod/reduction/frequency", R"("2 rad")",
            R"(/scene/bodies/rod/reduction/frequency must be a frequency [Hz], got "2 rad": "rad" measures something else)"},
        BadEdit{
            "/scene/bodies/rod/reduction/frequency", R"({"variable": "speed"})",
            R"(/scene/bodies/rod/reduction/frequency must be a frequency [Hz]: a number in SI units, a text with unit or a formula, got {"variable":"speed"})"},
        BadEdit{"/scene/bodies/arm/reduction", "remove",
                R"(/scene/bodies/arm/damping/modal is for beams with a "reduction" only)"},
        BadEdit{"/scene/bodies/arm/damping/mass", "0",
                R"(/scene/bodies/arm/damping has both "modal" and "mass")"},
        BadEdit{"/scene/bodies/arm/damping/stiffness", "0",
                R"(/scene/bodies/arm/damping has both "modal" and "stiffness")"},
        BadEdit{"/scene/bodies/arm/damping/modal", "1",
                "/scene/bodies/arm/damping/modal must be at least 0 and less than 1, got 1"},
        BadEdit{"/scene/bodies/arm/damping/modal", "-0.1",
                "/scene/bodies/arm/damping/modal must be at least 0 and less than 1, got -0.1"},
        BadEdit{"/scene/bodies/ball/angular_velocity", "[0, 0, 1]",
                "/scene/bodies/ball/angular_velocity is not for a point mass, which does not turn"},
        BadEdit{
            "/scene/bodies/block/velocity/1", R"("1 m")",
            R"(/scene/bodies/block/velocity/1 must be a speed [m/s], got "1 m": "m" measures something else)"},
        BadEdit{"/scene/bodies/block/velocity", "3",
                "/scene/bodies/block/velocity must be a list of 3 values, got 3"},
        BadEdit{
            "/scene/bodies/block/angular_velocity/0", R"("1 Hz")",
            R"(/scene/bodies/block/angular_velocity/0 must be an angular speed [rad/s], got "1 Hz": "Hz" names no angle; write rad/s, deg/s or rpm)"}),
    named_by(&BadEdit::pointer));

}  // namespace
}  // namespace pleuel::test::bad_body_test
