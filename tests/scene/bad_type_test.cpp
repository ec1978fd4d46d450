#include <gtest/gtest.h>

#include "tests/scene/bad_edit.hpp"
#include "tests/support/parameter_name.hpp"

namespace pleuel::test::bad_type_test {
namespace {

INSTANTIATE_TEST_SUITE_P(
    Types, BadProblemFile,
    testing::Values(
        BadEdit{"/scene/bodies", "[]", "/scene/bodies must be an object {…}, got []"},
        BadEdit{"/scene/bodies", "{}", "/scene/bodies has no body"},
        BadEdit{"/scene/bodies/crank", "3", "/scene/bodies/crank must be an object {…}, got 3"},
        BadEdit{
            "/scene/bodies/crank/type", R"("baem")",
            R"(/scene/bodies/crank/type must be "beam", "rigid", "point-mass" or "invariants", got "baem"; did you mean "beam"?)"},
        BadEdit{
            "/scene/bodies/crank/type", "7",
            R"(/scene/bodies/crank/type must be "beam", "rigid", "point-mass" or "invariants", got 7)"},
        BadEdit{"/scene/bodies/crank/from", "[0, 0]",
                "/scene/bodies/crank/from must be a list of 3 values, got [0,0]"},
        BadEdit{
            "/scene/bodies/crank/from/1", "null",
            R"(/scene/bodies/crank/from/1 must be a length [m]: a number in SI units, a text with unit, a formula "= …" or {"variable": name}, got null)"},
        BadEdit{
            "/scene/bodies/crank/from/1", "[1]",
            R"(/scene/bodies/crank/from/1 must be a length [m]: a number in SI units, a text with unit, a formula "= …" or {"variable": name}, got [1])"},
        BadEdit{"/scene/bodies/crank/elements", R"("4")",
                R"(/scene/bodies/crank/elements must be a whole number from 1 to 10000, got "4")"},
        BadEdit{"/scene/bodies/crank/elements", "2.5",
                "/scene/bodies/crank/elements must be a whole number from 1 to 10000, got 2.5"},
        BadEdit{"/name", R"("")", R"(/name must be a text in quotes, not empty, got "")"},
        BadEdit{"/name", "7", "/name must be a text in quotes, not empty, got 7"},
        BadEdit{"/simulation/end_time", "true",
                "/simulation/end_time must be a time [s]: a number in SI units, a text with "
                "unit or a formula, got true"},
        BadEdit{
            "/simulation/end_time", R"({"variable": "width"})",
            R"(/simulation/end_time must be a time [s]: a number in SI units, a text with unit or a formula, got {"variable":"width"})"},
        BadEdit{
            "/simulation/scheme", R"("euler")",
            R"(/simulation/scheme must be "generalized-alpha", "newmark" or "implicit-euler", got "euler")"},
        BadEdit{
            "/simulation/formulation", R"("index-2")",
            R"(/simulation/formulation must be "index-3", "stabilized-index-2" or "index-1", got "index-2"; did you mean "index-3"?)"},
        BadEdit{
            "/simulation/local_error", "1e-6",
            R"(/simulation/local_error is for the formulations "stabilized-index-2" and "index-1" only)"},
        BadEdit{"/simulation/smallest_step", "\"1 us\"",
                R"(/simulation/smallest_step is for a simulation with "local_error" only)"},
        BadEdit{"/simulation/baumgarte", "\"100 1/s\"",
                R"(/simulation/baumgarte is for the formulation "index-1" only)"},
        BadEdit{"/simulation/projection", "true",
                R"(/simulation/projection is for the formulation "index-1" only)"},
        BadEdit{"/effects/spatial_motion", "true",
                R"(/effects/spatial_motion must be "auto", "on" or "off", got true)"},
        BadEdit{"/accuracy/steps", "1e-4", "/accuracy/steps must be a list […], got 0.0001"},
        BadEdit{"/accuracy/elements", "[]", "/accuracy/elements must have at least one number"},
        BadEdit{
            "/scene/joints/bearing/type", R"("revolut")",
            R"(/scene/joints/bearing/type must be "revolute", "prismatic", "fixed", "point-on-line", "cylindrical", "universal", "spherical", "planar", "distance" or "point-on-plane", got "revolut"; did you mean "revolute"?)"},
        BadEdit{
            "/scene/bodies/rod/frame", R"("cord")",
            R"(/scene/bodies/rod/frame must be "tangent", "tangent-end", "chord" or "mean-axis", got "cord"; did you mean "chord"?)"}),
    named_by(&BadEdit::pointer));

INSTANTIATE_TEST_SUITE_P(
    Units, BadProblemFile,
    testing::Values(
        BadEdit{
            "/scene/bodies/crank/to/0", R"("120 kg")",
            R"(/scene/bodies/crank/to/0 must be a length [m], got "120 kg": "kg" measures something else)"},
        BadEdit{
            "/scene/bodies/crank/to/0", R"("120 mmm")",
            R"(/scene/bodies/crank/to/0 must be a length [m], got "120 mmm": "mmm" is not a known unit; did you mean "mm"?)"},
        BadEdit{
            "/scene/bodies/crank/to/0", R"("120")",
            R"(/scene/bodies/crank/to/0 must be a length [m], got "120": a number in quotes needs its unit)"},
        BadEdit{
            "/scene/bodies/crank/to/0", R"("long")",
            R"(/scene/bodies/crank/to/0 must be a length [m], got "long": it does not begin with a number)"},
        BadEdit{
            "/scene/bodies/crank/to/0", R"("nan m")",
            R"(/scene/bodies/crank/to/0 must be a length [m], got "nan m": it does not begin with a number)"},
        BadEdit{
            "/scene/bodies/crank/to/0", R"("1e400 m")",
            R"(/scene/bodies/crank/to/0 must be a length [m], got "1e400 m": it is out of the range of numbers)"},
        BadEdit{
            "/scene/materials/steel/young", R"("210 GN")",
            R"(/scene/materials/steel/young must be a stress [Pa], got "210 GN": "GN" measures something else)"},
        BadEdit{
            "/scene/materials/steel/poisson", R"("0.3 m")",
            R"(/scene/materials/steel/poisson must be a number without unit, got "0.3 m": "m" measures something else)"},
        BadEdit{
            "/scene/joints/bearing/drive/speed", R"("25 Hz")",
            R"(/scene/joints/bearing/drive/speed must be an angular speed [rad/s], got "25 Hz": "Hz" names no angle; write rad/s, deg/s or rpm)"},
        BadEdit{
            "/scene/bodies/crank/damping/stiffness", R"("1 1/s")",
            R"(/scene/bodies/crank/damping/stiffness must be a time [s], got "1 1/s": "1/s" measures something else)"},
        BadEdit{
            "/constraints/strength/upper", R"("0.2 mm")",
            R"(/constraints/strength/upper must be a stress [Pa], got "0.2 mm": "mm" measures something else)"},
        BadEdit{
            "/constraints/effort/upper", R"("1 N m")",
            R"(/constraints/effort/upper must be a torque times a time [N m s], got "1 N m": "N m" measures something else)"},
        BadEdit{
            "/constraints/slender/upper", R"("1 kg")",
            R"(/constraints/slender/upper must be a length [m], got "1 kg": "kg" measures something else)"},
        BadEdit{"/pareto/from", R"("1 MPa")",
                R"(/pareto/from must be a length [m], got "1 MPa": "MPa" measures something else)"},
        BadEdit{
            "/variables/width/start", R"("20 kg")",
            R"(/variables/width/start must be a length [m], got "20 kg": "kg" measures something else)"},
        BadEdit{
            "/variables/load/lower", R"("1 mm")",
            R"(/variables/load/lower must be a mass [kg], got "1 mm": "mm" measures something else)"}),
    named_by(&BadEdit::pointer));

}  // namespace
}  // namespace pleuel::test::bad_type_test
