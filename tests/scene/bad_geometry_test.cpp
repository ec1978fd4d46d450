#include <gtest/gtest.h>

#include "tests/scene/bad_edit.hpp"
#include "tests/support/parameter_name.hpp"

namespace pleuel::test::bad_geometry_test {
namespace {

INSTANTIATE_TEST_SUITE_P(
    Scenes, BadProblemFile,
    testing::Values(
        BadEdit{"/scene/bodies/crank/to", "[0, 0, 0]",
                R"(/scene/bodies/crank has zero length: "from" and "to" are the same point)"},
        BadEdit{"/scene/bodies/rod/reference", "[2, 0, 0]",
                "/scene/bodies/rod/reference must not be parallel to the beam, got [2,0,0]"},
        BadEdit{"/scene/bodies/rod/reference", "[0, 0, 0]",
                "/scene/bodies/rod/reference must not be zero, got [0,0,0]"},
        BadEdit{"/scene/bodies/rod/segments", "[]",
                "/scene/bodies/rod/segments must have at least one segment"},
        BadEdit{"/scene/bodies/rod/segments/0/length_fraction", "0.2",
                "/scene/bodies/rod/segments must have length fractions with the sum 1, got the "
                "sum 0.95"},
        BadEdit{
            "/scene/bodies/rod/segments/0/length_fraction", "remove",
            R"(/scene/bodies/rod/segments must have a "length_fraction" in all segments or in none)"},
        BadEdit{"/scene/bodies/rod/section", R"({"type": "circle", "diameter": 1})",
                R"(/scene/bodies/rod has both "segments" and "section")"},
        BadEdit{"/scene/bodies/rod/segments/0/section/thickness", R"("16 mm")",
                "/scene/bodies/rod/segments/0/section/thickness must not exceed the radius "
                "0.015 [m] of the tube, got 0.016"},
        BadEdit{"/scene/bodies/wheel/inertia", "[0, 0, 0, 0, 0, 0]",
                "/scene/bodies/wheel/inertia must not be all zero (a body without inertia is a "
                "point-mass), got [0,0,0,0,0,0]"},
        BadEdit{"/scene/bodies/wheel/inertia", "[1, 1, 1, 2, 0, 0]",
                "/scene/bodies/wheel/inertia must have no negative principal moment (xx, yy, "
                "zz, xy, xz, yz), got [1,1,1,2,0,0]"},
        BadEdit{"/scene/bodies/wheel/inertia", "[1e-2, 1e-6, 1e-6, 0, 0, 0]",
                "/scene/bodies/wheel/inertia must have no principal moment above the sum of the "
                "other two (0.01 > 1e-06 + 1e-06 kg m^2), got [0.01,1e-06,1e-06,0,0,0]"},
        // [1.5 ± 1, 2.6]: the principal moments are 0.5, 2.5 and 2.6, which is allowed; 3.1 is not.
        BadEdit{"/scene/bodies/wheel/inertia", "[1.5, 1.5, 3.1, 1, 0, 0]",
                "/scene/bodies/wheel/inertia must have no principal moment above the sum of the "
                "other two (3.1 > 0.5 + 2.5 kg m^2), got [1.5,1.5,3.1,1,0,0]"},
        BadEdit{"/scene/bodies/wheel/inertia/0", "-1",
                "/scene/bodies/wheel/inertia/0 must not be negative [kg m^2], got -1"},
        BadEdit{
            "/scene/joints/hub/drive", R"({"type": "constant-speed", "speed": 1})",
            R"(/scene/joints/hub/drive needs a joint of the type "revolute", "prismatic", "point-on-line", "cylindrical", "universal", "planar" or "distance", but "hub" is of the type "fixed")"},
        BadEdit{
            "/scene/joints/end/drive", R"({"type": "constant-speed", "speed": 1})",
            R"(/scene/joints/end/drive needs two bodies that can turn, but "slider" is a point mass)"},
        BadEdit{"/scene/joints/hub", "remove",
                "/scene/bodies/wheel is not connected to anything by a joint or a load"},
        BadEdit{
            "/scene/joints/pin/at/0", R"("121 mm")",
            R"(/scene/joints/pin/at must be on the axis of the beam "crank", the nearest point is (0.12, 0, 0) [m], got (0.121, 0, 0))"},
        BadEdit{
            "/scene/joints/pin/at/1", R"("1 mm")",
            R"(/scene/joints/pin/at must be on the axis of the beam "crank", the nearest point is (0.12, 0, 0) [m], got (0.12, 0.001, 0))"},
        BadEdit{
            "/scene/joints/guide/at/0", "0.31",
            R"(/scene/joints/guide/at must be where the point mass "slider" is, (0.3, 0, 0) [m], got (0.31, 0, 0))"},
        BadEdit{
            "/scene/bodies/crank/to/0", R"({"variable": "diameter", "factor": 4})",
            R"(/scene/joints/pin/at must stay at the share 1 of the length of the beam "crank", which is (0.04, 0, 0) [m], got (0.12, 0, 0), with the variable "diameter" at its lower bound)"},
        BadEdit{
            "/variables/width/upper", "1e308",
            R"(/scene/bodies/crank/section/height must be positive [m], got inf with the variable "width" at its upper bound)"}),
    named_by(&BadEdit::pointer));

}  // namespace
}  // namespace pleuel::test::bad_geometry_test
