#include <gtest/gtest.h>

#include "tests/scene/bad_edit.hpp"
#include "tests/support/parameter_name.hpp"

namespace pleuel::test::bad_key_test {
namespace {

INSTANTIATE_TEST_SUITE_P(
    Keys, BadProblemFile,
    testing::Values(
        BadEdit{
            "/colour", "1",
            R"(the problem has the unknown key "colour"; known are "$schema", "name", "description", "scene", "effects", "simulation", "sensitivity", "constants", "variables", "responses", "objective", "constraints", "optimizer", "pareto", "accuracy" and "uncertainty")"},
        BadEdit{
            "/scene/bodies/crank/section/heigth", "1",
            R"(/scene/bodies/crank/section has the unknown key "heigth"; did you mean "height"?)"},
        BadEdit{
            "/scene/bodies/slider/elements", "1",
            R"(/scene/bodies/slider has the unknown key "elements"; known are "type", "velocity", "at" and "mass")"},
        BadEdit{
            "/objective/scale", "2",
            R"(/objective has the unknown key "scale"; known are "minimize", "maximize" and "over_cases")"},
        BadEdit{"/scene", "remove", R"(the problem is missing the key "scene")"},
        BadEdit{"/simulation", "remove", R"(the problem is missing the key "simulation")"},
        BadEdit{"/scene/bodies", "remove", R"(/scene is missing the key "bodies")"},
        BadEdit{"/scene/gravity", R"([0, {"variable": "width"}, 0])",
                R"(/scene/gravity cannot be bound to a design variable)"},
        BadEdit{"/scene/materials/steel/density", "remove",
                R"(/scene/materials/steel is missing the key "density")"},
        BadEdit{"/scene/bodies/crank/section", "remove",
                R"(/scene/bodies/crank is missing the key "section")"},
        BadEdit{"/scene/bodies/crank", R"({"tpye": "beam"})",
                R"(/scene/bodies/crank is missing the key "type"; is "tpye" a misspelling?)"},
        BadEdit{
            "/scene/bodies/crank/section", R"({"type": "circle", "diamter": 0.01})",
            R"(/scene/bodies/crank/section has the unknown key "diamter"; did you mean "diameter"?)"},
        BadEdit{
            "/effects/torsion", R"("on")",
            R"(/effects has the unknown key "torsion"; known are "spatial_motion", "geometric_stiffening", "rotary_inertia", "elasticity", "axial_elasticity", "torsional_elasticity" and "tolerance")"},
        BadEdit{
            "/robustness", "{}",
            R"(the problem has the unknown key "robustness"; known are "$schema", "name", "description", "scene", "effects", "simulation", "sensitivity", "constants", "variables", "responses", "objective", "constraints", "optimizer", "pareto", "accuracy" and "uncertainty")"},
        BadEdit{"/variables/width/lower", "remove",
                R"(/variables/width is missing the key "lower")"},
        BadEdit{"/scene/joints/bearing/drive/ramp", "remove",
                R"(/scene/joints/bearing/drive is missing the key "ramp")"},
        BadEdit{"/variables/", R"({"start": 1, "lower": 0, "upper": 2})",
                "/variables has a member without a name"},
        BadEdit{"/responses/a~1b", R"({"type": "stress", "body": "rod", "overtime": "max"})",
                R"(/responses/a~1b has the unknown key "overtime"; did you mean "over_time"?)"}),
    named_by(&BadEdit::pointer));

INSTANTIATE_TEST_SUITE_P(
    Names, BadProblemFile,
    testing::Values(
        BadEdit{
            "/scene/bodies/crank/material", R"("stel")",
            R"(/scene/bodies/crank/material names the unknown material "stel"; did you mean "steel"?)"},
        BadEdit{
            "/scene/bodies/crank/section/width", R"({"variable": "widht"})",
            R"(/scene/bodies/crank/section/width/variable names the unknown variable "widht"; did you mean "width"?)"},
        BadEdit{"/scene/bodies/crank/section/width", R"({"factor": 2})",
                R"(/scene/bodies/crank/section/width is missing the key "variable")"},
        BadEdit{"/scene/bodies/crank/section/width", R"({"variable": "width", "factor": 0})",
                "/scene/bodies/crank/section/width/factor must not be zero, got 0"},
        BadEdit{
            "/scene/bodies/crank/section/width", R"({"variable": "load"})",
            R"(/scene/bodies/slider/mass uses the variable "load" as a mass [kg], but /scene/bodies/crank/section/width uses it as a length [m])"},
        BadEdit{"/scene/bodies/crank/section/width", R"({"variable": "diameter", "factor": "2"})",
                R"(/scene/bodies/crank/section/width/factor must be a number, got "2")"},
        BadEdit{"/scene/joints/pin/bodies/1", R"("rdo")",
                R"(/scene/joints/pin/bodies/1 names the unknown body "rdo"; did you mean "rod"?)"},
        BadEdit{"/scene/joints/pin/bodies", R"(["rod", "rod"])",
                R"(/scene/joints/pin/bodies must name two bodies, got "rod" twice)"},
        BadEdit{"/scene/joints/pin/bodies", R"(["rod"])",
                R"(/scene/joints/pin/bodies must be a list of 2 values, got ["rod"])"},
        BadEdit{"/scene/bodies/ground", R"({"type": "point-mass", "at": [0, 0, 0], "mass": 1})",
                "/scene/bodies/ground has the name that is kept for the ground"},
        BadEdit{"/responses/stress/body", R"("rodd")",
                R"(/responses/stress/body names the unknown body "rodd"; did you mean "rod"?)"},
        BadEdit{"/responses/stress/body", R"("slider")",
                R"(/responses/stress/body must name a beam, but "slider" is none)"},
        BadEdit{
            "/responses/impulse/joint", R"("baering")",
            R"(/responses/impulse/joint names the unknown joint "baering"; did you mean "bearing"?)"},
        BadEdit{"/responses/impulse/joint", R"("pin")",
                R"(/responses/impulse/joint names the joint "pin", which has no drive)"},
        BadEdit{
            "/objective/minimize", R"("wieght")",
            R"(/objective/minimize names the unknown response "wieght"; did you mean "weight"?)"},
        BadEdit{"/objective", "remove", "/pareto needs an objective, and the problem has none"},
        BadEdit{
            "/constraints/strength/response", R"("strss")",
            R"(/constraints/strength/response names the unknown response "strss"; did you mean "stress"?)"},
        BadEdit{
            "/constraints/slender/linear/hight", "1",
            R"(/constraints/slender/linear/hight names the unknown variable "hight"; known are "width", "diameter" and "load")"},
        BadEdit{
            "/pareto/constraint", R"("stifness")",
            R"(/pareto/constraint names the unknown constraint "stifness"; did you mean "stiffness"?)"},
        BadEdit{
            "/pareto/constraint", R"("effort")",
            R"(/pareto/constraint must name a constraint with one limit, but "effort" has two)"},
        BadEdit{"/variables/spare", R"({"start": 1, "lower": 0, "upper": 2})",
                "/variables/spare is not used: no number of the scene, no formula and no linear "
                "constraint names it"},
        BadEdit{
            "/variables", "remove",
            R"(/scene/bodies/crank/section/width/variable names the unknown variable "width"; there are none)",
            3},
        BadEdit{"/responses/weight/bodies", R"(["rod", "crank", "rod"])",
                R"(/responses/weight/bodies/2 names the body "rod" a second time)"},
        BadEdit{"/responses/weight/bodies", "[]",
                "/responses/weight/bodies must name at least one body"},
        BadEdit{"/responses/weight/body", R"("rod")",
                R"(/responses/weight has both "body" and "bodies")"}),
    named_by(&BadEdit::pointer));

}  // namespace
}  // namespace pleuel::test::bad_key_test
