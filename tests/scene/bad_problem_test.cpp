#include <ostream>
#include <string>

#include <gtest/gtest.h>

#include "tests/scene/good_problem.hpp"

namespace pleuel::test {
namespace {

/// An edit of the good problem and what the reader must say of it, after the name of the file.
struct BadProblem {
  std::string pointer;
  std::string value;  ///< JSON, or "remove"
  std::string message;
};

void PrintTo(const BadProblem& bad, std::ostream* stream) {
  *stream << bad.pointer << " = " << bad.value;
}

class BadProblemFile : public testing::TestWithParam<BadProblem> {};

TEST_P(BadProblemFile, IsRefusedWithPlaceValueAndRule) {
  const BadProblem& bad = GetParam();
  EXPECT_EQ(complaint(edited(bad.pointer, bad.value)), "bad.json: " + bad.message);
}

TEST(GoodProblemFile, IsNotRefused) {
  EXPECT_EQ(complaint(good_json()), "");
}

INSTANTIATE_TEST_SUITE_P(
    Keys, BadProblemFile,
    testing::Values(
        BadProblem{
            "/colour", "1",
            R"(the problem has the unknown key "colour"; known are "$schema", "name", "description", "scene", "effects", "simulation", "sensitivity", "variables", "responses", "objective", "constraints", "optimizer", "pareto", "accuracy" and "uncertainty")"},
        BadProblem{
            "/scene/bodies/crank/section/heigth", "1",
            R"(/scene/bodies/crank/section has the unknown key "heigth"; did you mean "height"?)"},
        BadProblem{
            "/scene/bodies/slider/elements", "1",
            R"(/scene/bodies/slider has the unknown key "elements"; known are "type", "at", "mass" and "velocity")"},
        BadProblem{"/scene", "remove", R"(the problem is missing the key "scene")"},
        BadProblem{"/simulation", "remove", R"(the problem is missing the key "simulation")"},
        BadProblem{"/scene/bodies", "remove", R"(/scene is missing the key "bodies")"},
        BadProblem{"/scene/gravity", R"([0, {"variable": "width"}, 0])",
                   R"(/scene/gravity cannot be bound to a design variable)"},
        BadProblem{"/scene/materials/steel/density", "remove",
                   R"(/scene/materials/steel is missing the key "density")"},
        BadProblem{"/scene/bodies/crank/section", "remove",
                   R"(/scene/bodies/crank is missing the key "section")"},
        BadProblem{"/scene/bodies/crank", R"({"tpye": "beam"})",
                   R"(/scene/bodies/crank is missing the key "type"; is "tpye" a misspelling?)"},
        BadProblem{
            "/scene/bodies/crank/section", R"({"type": "circle", "diamter": 0.01})",
            R"(/scene/bodies/crank/section has the unknown key "diamter"; did you mean "diameter"?)"},
        BadProblem{
            "/effects/torsion", R"("on")",
            R"(/effects has the unknown key "torsion"; known are "spatial_motion", "geometric_stiffening", "rotary_inertia", "elasticity", "axial_elasticity", "torsional_elasticity" and "tolerance")"},
        BadProblem{
            "/robustness", "{}",
            R"(the problem has the unknown key "robustness"; known are "$schema", "name", "description", "scene", "effects", "simulation", "sensitivity", "variables", "responses", "objective", "constraints", "optimizer", "pareto", "accuracy" and "uncertainty")"},
        BadProblem{"/variables/width/lower", "remove",
                   R"(/variables/width is missing the key "lower")"},
        BadProblem{"/scene/joints/bearing/drive/ramp", "remove",
                   R"(/scene/joints/bearing/drive is missing the key "ramp")"},
        BadProblem{"/variables/", R"({"start": 1, "lower": 0, "upper": 2})",
                   "/variables has a member without a name"},
        BadProblem{
            "/responses/a~1b", R"({"type": "stress", "body": "rod", "overtime": "max"})",
            R"(/responses/a~1b has the unknown key "overtime"; did you mean "over_time"?)"}));

INSTANTIATE_TEST_SUITE_P(
    Types, BadProblemFile,
    testing::Values(
        BadProblem{"/scene/bodies", "[]", "/scene/bodies must be an object {…}, got []"},
        BadProblem{"/scene/bodies", "{}", "/scene/bodies has no body"},
        BadProblem{"/scene/bodies/crank", "3", "/scene/bodies/crank must be an object {…}, got 3"},
        BadProblem{
            "/scene/bodies/crank/type", R"("baem")",
            R"(/scene/bodies/crank/type must be "beam", "rigid", "point-mass" or "invariants", got "baem"; did you mean "beam"?)"},
        BadProblem{
            "/scene/bodies/crank/type", "7",
            R"(/scene/bodies/crank/type must be "beam", "rigid", "point-mass" or "invariants", got 7)"},
        BadProblem{"/scene/bodies/crank/from", "[0, 0]",
                   "/scene/bodies/crank/from must be a list of 3 values, got [0,0]"},
        BadProblem{
            "/scene/bodies/crank/from/1", "null",
            R"(/scene/bodies/crank/from/1 must be a length [m]: a number in SI units, a text with unit or {"variable": name}, got null)"},
        BadProblem{
            "/scene/bodies/crank/from/1", "[1]",
            R"(/scene/bodies/crank/from/1 must be a length [m]: a number in SI units, a text with unit or {"variable": name}, got [1])"},
        BadProblem{
            "/scene/bodies/crank/elements", R"("4")",
            R"(/scene/bodies/crank/elements must be a whole number from 1 to 10000, got "4")"},
        BadProblem{"/scene/bodies/crank/elements", "2.5",
                   "/scene/bodies/crank/elements must be a whole number from 1 to 10000, got 2.5"},
        BadProblem{"/name", R"("")", R"(/name must be a text in quotes, not empty, got "")"},
        BadProblem{"/name", "7", "/name must be a text in quotes, not empty, got 7"},
        BadProblem{"/simulation/end_time", "true",
                   "/simulation/end_time must be a time [s]: a number in SI units or a text with "
                   "unit, got true"},
        BadProblem{
            "/simulation/end_time", R"({"variable": "width"})",
            R"(/simulation/end_time must be a time [s]: a number in SI units or a text with unit, got {"variable":"width"})"},
        BadProblem{
            "/simulation/scheme", R"("euler")",
            R"(/simulation/scheme must be "generalized-alpha", "newmark" or "implicit-euler", got "euler")"},
        BadProblem{
            "/simulation/formulation", R"("index-2")",
            R"(/simulation/formulation must be "index-3", "stabilized-index-2" or "index-1", got "index-2"; did you mean "index-3"?)"},
        BadProblem{
            "/simulation/local_error", "1e-6",
            R"(/simulation/local_error is for the formulations "stabilized-index-2" and "index-1" only)"},
        BadProblem{"/simulation/smallest_step", "\"1 us\"",
                   R"(/simulation/smallest_step is for a simulation with "local_error" only)"},
        BadProblem{"/simulation/baumgarte", "\"100 1/s\"",
                   R"(/simulation/baumgarte is for the formulation "index-1" only)"},
        BadProblem{"/simulation/projection", "true",
                   R"(/simulation/projection is for the formulation "index-1" only)"},
        BadProblem{"/effects/spatial_motion", "true",
                   R"(/effects/spatial_motion must be "auto", "on" or "off", got true)"},
        BadProblem{"/accuracy/steps", "1e-4", "/accuracy/steps must be a list […], got 0.0001"},
        BadProblem{"/accuracy/elements", "[]", "/accuracy/elements must have at least one number"},
        BadProblem{
            "/scene/joints/bearing/type", R"("revolut")",
            R"(/scene/joints/bearing/type must be "revolute", "prismatic", "fixed", "point-on-line", "cylindrical", "universal", "spherical", "planar" or "distance", got "revolut"; did you mean "revolute"?)"},
        BadProblem{
            "/scene/bodies/rod/frame", R"("cord")",
            R"(/scene/bodies/rod/frame must be "tangent", "tangent-end", "chord" or "mean-axis", got "cord"; did you mean "chord"?)"}));

INSTANTIATE_TEST_SUITE_P(
    Units, BadProblemFile,
    testing::Values(
        BadProblem{
            "/scene/bodies/crank/to/0", R"("120 kg")",
            R"(/scene/bodies/crank/to/0 must be a length [m], got "120 kg": "kg" measures something else)"},
        BadProblem{
            "/scene/bodies/crank/to/0", R"("120 mmm")",
            R"(/scene/bodies/crank/to/0 must be a length [m], got "120 mmm": "mmm" is not a known unit)"},
        BadProblem{
            "/scene/bodies/crank/to/0", R"("120")",
            R"(/scene/bodies/crank/to/0 must be a length [m], got "120": a number in quotes needs its unit)"},
        BadProblem{
            "/scene/bodies/crank/to/0", R"("long")",
            R"(/scene/bodies/crank/to/0 must be a length [m], got "long": it does not begin with a number)"},
        BadProblem{
            "/scene/bodies/crank/to/0", R"("nan m")",
            R"(/scene/bodies/crank/to/0 must be a length [m], got "nan m": it does not begin with a number)"},
        BadProblem{
            "/scene/bodies/crank/to/0", R"("1e400 m")",
            R"(/scene/bodies/crank/to/0 must be a length [m], got "1e400 m": it is out of the range of numbers)"},
        BadProblem{
            "/scene/materials/steel/young", R"("210 GN")",
            R"(/scene/materials/steel/young must be a stress [Pa], got "210 GN": "GN" measures something else)"},
        BadProblem{
            "/scene/materials/steel/poisson", R"("0.3 m")",
            R"(/scene/materials/steel/poisson must be a number without unit, got "0.3 m": "m" measures something else)"},
        BadProblem{
            "/scene/joints/bearing/drive/speed", R"("25 Hz")",
            R"(/scene/joints/bearing/drive/speed must be an angular speed [rad/s], got "25 Hz": "Hz" names no angle; write rad/s, deg/s or rpm)"},
        BadProblem{
            "/scene/bodies/crank/damping/stiffness", R"("1 1/s")",
            R"(/scene/bodies/crank/damping/stiffness must be a time [s], got "1 1/s": "1/s" measures something else)"},
        BadProblem{
            "/constraints/strength/upper", R"("0.2 mm")",
            R"(/constraints/strength/upper must be a stress [Pa], got "0.2 mm": "mm" measures something else)"},
        BadProblem{
            "/constraints/effort/upper", R"("1 N m")",
            R"(/constraints/effort/upper must be a torque times a time [N m s], got "1 N m": "N m" measures something else)"},
        BadProblem{
            "/constraints/slender/upper", R"("1 kg")",
            R"(/constraints/slender/upper must be a length [m], got "1 kg": "kg" measures something else)"},
        BadProblem{
            "/pareto/from", R"("1 MPa")",
            R"(/pareto/from must be a length [m], got "1 MPa": "MPa" measures something else)"},
        BadProblem{
            "/variables/width/start", R"("20 kg")",
            R"(/variables/width/start must be a length [m], got "20 kg": "kg" measures something else)"},
        BadProblem{
            "/variables/load/lower", R"("1 mm")",
            R"(/variables/load/lower must be a mass [kg], got "1 mm": "mm" measures something else)"},
        BadProblem{
            "/objective/scale", R"("1 m")",
            R"(/objective/scale must be a mass [kg], got "1 m": "m" measures something else)"}));

INSTANTIATE_TEST_SUITE_P(
    Names, BadProblemFile,
    testing::Values(
        BadProblem{
            "/scene/bodies/crank/material", R"("stel")",
            R"(/scene/bodies/crank/material names the unknown material "stel"; did you mean "steel"?)"},
        BadProblem{
            "/scene/bodies/crank/section/width", R"({"variable": "widht"})",
            R"(/scene/bodies/crank/section/width/variable names the unknown variable "widht"; did you mean "width"?)"},
        BadProblem{"/scene/bodies/crank/section/width", R"({"factor": 2})",
                   R"(/scene/bodies/crank/section/width is missing the key "variable")"},
        BadProblem{"/scene/bodies/crank/section/width", R"({"variable": "width", "factor": 0})",
                   "/scene/bodies/crank/section/width/factor must not be zero, got 0"},
        BadProblem{
            "/scene/bodies/crank/section/width", R"({"variable": "load"})",
            R"(/scene/bodies/slider/mass uses the variable "load" as a mass [kg], but /scene/bodies/crank/section/width uses it as a length [m])"},
        BadProblem{"/scene/bodies/crank/section/width",
                   R"({"variable": "diameter", "factor": "2"})",
                   R"(/scene/bodies/crank/section/width/factor must be a number, got "2")"},
        BadProblem{
            "/scene/joints/pin/bodies/1", R"("rdo")",
            R"(/scene/joints/pin/bodies/1 names the unknown body "rdo"; did you mean "rod"?)"},
        BadProblem{"/scene/joints/pin/bodies", R"(["rod", "rod"])",
                   R"(/scene/joints/pin/bodies must name two bodies, got "rod" twice)"},
        BadProblem{"/scene/joints/pin/bodies", R"(["rod"])",
                   R"(/scene/joints/pin/bodies must be a list of 2 values, got ["rod"])"},
        BadProblem{"/scene/bodies/ground", R"({"type": "point-mass", "at": [0, 0, 0], "mass": 1})",
                   "/scene/bodies/ground has the name that is kept for the ground"},
        BadProblem{"/responses/stress/body", R"("rodd")",
                   R"(/responses/stress/body names the unknown body "rodd"; did you mean "rod"?)"},
        BadProblem{"/responses/stress/body", R"("slider")",
                   R"(/responses/stress/body must name a beam, but "slider" is none)"},
        BadProblem{
            "/responses/impulse/joint", R"("baering")",
            R"(/responses/impulse/joint names the unknown joint "baering"; did you mean "bearing"?)"},
        BadProblem{"/responses/impulse/joint", R"("pin")",
                   R"(/responses/impulse/joint names the joint "pin", which has no drive)"},
        BadProblem{
            "/objective/minimize", R"("wieght")",
            R"(/objective/minimize names the unknown response "wieght"; did you mean "weight"?)"},
        BadProblem{"/objective", "remove", "/pareto needs an objective, and the problem has none"},
        BadProblem{
            "/constraints/strength/response", R"("strss")",
            R"(/constraints/strength/response names the unknown response "strss"; did you mean "stress"?)"},
        BadProblem{
            "/constraints/slender/linear/hight", "1",
            R"(/constraints/slender/linear/hight names the unknown variable "hight"; known are "width", "diameter" and "load")"},
        BadProblem{
            "/pareto/constraint", R"("stifness")",
            R"(/pareto/constraint names the unknown constraint "stifness"; did you mean "stiffness"?)"},
        BadProblem{
            "/pareto/constraint", R"("effort")",
            R"(/pareto/constraint must name a constraint with one limit, but "effort" has two)"},
        BadProblem{"/variables/spare", R"({"start": 1, "lower": 0, "upper": 2})",
                   "/variables/spare is not used: no number of the scene and no linear constraint "
                   "names it"},
        BadProblem{
            "/variables", "remove",
            R"(/scene/bodies/crank/section/width/variable names the unknown variable "width"; there are none)"},
        BadProblem{"/responses/weight/bodies", R"(["rod", "crank", "rod"])",
                   R"(/responses/weight/bodies/2 names the body "rod" a second time)"},
        BadProblem{"/responses/weight/bodies", "[]",
                   "/responses/weight/bodies must name at least one body"},
        BadProblem{"/responses/weight/body", R"("rod")",
                   R"(/responses/weight has both "body" and "bodies")"}));

INSTANTIATE_TEST_SUITE_P(
    Values, BadProblemFile,
    testing::Values(
        BadProblem{"/scene/bodies/slider/mass", "-0.3",
                   "/scene/bodies/slider/mass must be positive [kg], got -0.3"},
        BadProblem{"/scene/bodies/slider/mass", R"("-300 g")",
                   R"(/scene/bodies/slider/mass must be positive [kg], got "-300 g")"},
        BadProblem{"/scene/bodies/slider/mass", "0",
                   "/scene/bodies/slider/mass must be positive [kg], got 0"},
        BadProblem{"/scene/bodies/rod/segments/1/section/diameter", "0",
                   "/scene/bodies/rod/segments/1/section/diameter must be positive [m], got 0"},
        BadProblem{
            "/variables/width", R"({"start": 0.02, "lower": "-1 mm", "upper": 0.06})",
            R"(/scene/bodies/crank/section/width must be positive [m], got -0.001 with the variable "width" at its lower bound)"},
        BadProblem{
            "/scene/bodies/crank/section/width", R"({"variable": "width", "factor": -1})",
            R"(/scene/bodies/crank/section/width must be positive [m], got -0.02 with the variable "width" at its start value)"},
        BadProblem{
            "/scene/materials/steel/poisson", "0.5",
            "/scene/materials/steel/poisson must be greater than -1 and less than 0.5, got 0.5"},
        BadProblem{
            "/scene/materials/steel/poisson", "-1",
            "/scene/materials/steel/poisson must be greater than -1 and less than 0.5, got -1"},
        BadProblem{"/scene/materials/steel/young", "0",
                   "/scene/materials/steel/young must be positive [Pa], got 0"},
        BadProblem{"/scene/bodies/crank/damping/mass", "-1",
                   "/scene/bodies/crank/damping/mass must not be negative [1/s], got -1"},
        BadProblem{"/scene/bodies/crank/elements", "0",
                   "/scene/bodies/crank/elements must be a whole number from 1 to 10000, got 0"},
        BadProblem{
            "/scene/bodies/crank/elements", "10001",
            "/scene/bodies/crank/elements must be a whole number from 1 to 10000, got 10001"},
        BadProblem{
            "/scene/bodies/crank/elements", "1e300",
            "/scene/bodies/crank/elements must be a whole number from 1 to 10000, got 1e+300"},
        BadProblem{"/simulation/end_time", "0", "/simulation/end_time must be positive [s], got 0"},
        BadProblem{"/simulation/step", R"("-1 ms")",
                   R"(/simulation/step must be positive [s], got "-1 ms")"},
        BadProblem{"/simulation/step", R"("1 s")",
                   R"(/simulation/step must not be longer than the simulation, got "1 s")"},
        BadProblem{"/simulation/step", "1e-300",
                   "/simulation/step must not make more than 1e+09 steps, got 1e-300"},
        BadProblem{"/simulation/spectral_radius", "1.01",
                   "/simulation/spectral_radius must be from 0 to 1, got 1.01"},
        BadProblem{"/simulation/newton_tolerance", "0",
                   "/simulation/newton_tolerance must be greater than 0 and less than 1, got 0"},
        BadProblem{
            "/simulation/max_newton_iterations", "0",
            "/simulation/max_newton_iterations must be a whole number from 1 to 1000000, got 0"},
        BadProblem{"/variables/width/lower", R"("7 cm")",
                   R"(/variables/width/lower must not be above the upper bound, got "7 cm")"},
        BadProblem{"/variables/width/start", R"("1 mm")",
                   R"(/variables/width/start must not be below the lower bound, got "1 mm")"},
        BadProblem{"/variables/width/start", R"("1 m")",
                   R"(/variables/width/start must not be above the upper bound, got "1 m")"},
        BadProblem{"/constraints/effort/lower", "2",
                   "/constraints/effort/lower must not be above the upper limit, got 2"},
        BadProblem{"/constraints/strength/upper", "remove",
                   R"(/constraints/strength has no limit; it needs "upper", "lower" or both)"},
        BadProblem{"/constraints/slender/response", R"("bow")",
                   R"(/constraints/slender has both "response" and "linear")"},
        BadProblem{"/constraints/slender/linear", "{}",
                   "/constraints/slender/linear must have at least one variable"},
        BadProblem{"/constraints/slender/linear/width", "0",
                   "/constraints/slender/linear/width must not be zero, got 0"},
        BadProblem{
            "/constraints/slender/linear/load", "1",
            R"(/constraints/slender/linear/load uses the variable "load" as a length [m], but /scene/bodies/slider/mass uses it as a mass [kg])"},
        BadProblem{"/responses/bow/at", "1.5",
                   "/responses/bow/at must be a place along the beam from 0 to 1, got 1.5"},
        BadProblem{"/responses/stress/segment", "2",
                   "/responses/stress/segment must be a whole number from 0 to 1, got 2"},
        BadProblem{"/responses/stress/over_time", "remove",
                   R"(/responses/stress is missing the key "over_time")"},
        BadProblem{
            "/responses/bow/over_time", R"("maxabs")",
            R"(/responses/bow/over_time must be "max", "min", "max-abs", "rms", "mean", "integral" or "final", got "maxabs"; did you mean "max-abs"?)"},
        BadProblem{"/responses/weight/over_time", R"("max")",
                   "/responses/weight/over_time is not for a mass, which does not change in time"},
        BadProblem{"/responses/bow/direction", R"("x")",
                   R"(/responses/bow/direction must be "y" or "z", got "x")"},
        BadProblem{
            "/responses/bow/against", R"("cord")",
            R"(/responses/bow/against must be "frame", "chord" or "rigid-mechanism", got "cord"; did you mean "chord"?)"},
        BadProblem{"/responses/bow",
                   R"({"type": "deflection", "body": "rod", "at": 0.5, "over_time": "max",
                       "against": "rigid-mechanism"})",
                   R"(/responses/bow is missing the key "direction")"},
        BadProblem{"/responses/place/direction", "remove",
                   R"(/responses/place is missing the key "direction")"},
        BadProblem{
            "/responses/place",
            R"({"type": "position", "body": "slider", "at": 1, "direction": "x", "over_time": "final"})",
            R"(/responses/place/at is for beams only, but "slider" is none)"},
        BadProblem{"/responses/place/at", "remove", R"(/responses/place is missing the key "at")"},
        BadProblem{
            "/sensitivity/method", "\"central\"",
            R"(/sensitivity/method must be "auto", "direct", "adjoint", "forward-difference" or "central-difference", got "central")"},
        BadProblem{
            "/sensitivity/invariant_derivatives", "\"dual\"",
            R"(/sensitivity/invariant_derivatives must be "exact", "complex-step", "central" or "forward", got "dual")"},
        BadProblem{
            "/sensitivity", R"({"invariant_step": 1e-6})",
            R"(/sensitivity/invariant_step is for the invariant derivatives "central" and "forward" only)"},
        BadProblem{
            "/sensitivity/memory", "\"512 kg\"",
            R"(/sensitivity/memory must be an amount of memory [B], got "512 kg": "kg" measures something else)"},
        BadProblem{"/sensitivity/memory", "0", "/sensitivity/memory must be positive [B], got 0"},
        BadProblem{"/sensitivity/difference_step", "0",
                   "/sensitivity/difference_step must be greater than 0 and less than 1, got 0"},
        BadProblem{"/optimizer/tolerance", "1",
                   "/optimizer/tolerance must be greater than 0 and less than 1, got 1"},
        BadProblem{"/optimizer/max_iterations", "0",
                   "/optimizer/max_iterations must be a whole number from 1 to 1000000, got 0"},
        BadProblem{"/pareto/to", R"("0.1 mm")",
                   R"(/pareto/to must differ from "from", got "0.1 mm")"},
        BadProblem{"/pareto/points", "1",
                   "/pareto/points must be a whole number from 2 to 10000, got 1"},
        BadProblem{"/accuracy/error", "0",
                   "/accuracy/error must be greater than 0 and less than 1, got 0"},
        BadProblem{"/accuracy/steps/1", "0", "/accuracy/steps/1 must be positive [s], got 0"},
        BadProblem{
            "/constraints/strength/deviations", "3",
            R"(/constraints/strength/deviations needs the block "uncertainty", which says what scatters)"},
        BadProblem{"/constraints/strength/deviations", "-3",
                   "/constraints/strength/deviations must be positive, got -3"},
        BadProblem{"/constraints/effort/deviations", "3",
                   "/constraints/effort/deviations is for one limit; this constraint has two"},
        BadProblem{"/uncertainty", R"({"parameters": {}})",
                   "/uncertainty/parameters must have at least one parameter"},
        BadProblem{
            "/uncertainty", R"({"parameters": {"wdth": {"deviation": "0.1 mm"}}})",
            R"(/uncertainty/parameters/wdth names the unknown variable "wdth"; did you mean "width"?)"},
        BadProblem{"/uncertainty",
                   R"({"parameters": {"width": {"deviation": "1 mm", "interval": "1 mm"}}})",
                   "/uncertainty/parameters/width must have either a deviation or an interval"},
        BadProblem{"/uncertainty", R"({"parameters": {"width": {"deviation": 0}}})",
                   "/uncertainty/parameters/width/deviation must be positive [m], got 0"},
        BadProblem{
            "/uncertainty", R"({"parameters": {"width": {"deviation": "3.5 mm"}}})",
            "/uncertainty/parameters/width leads to -0.001 for /scene/bodies/crank/section/width, "
            "which must be positive [m]"},
        BadProblem{"/uncertainty",
                   R"({"parameters": {"width": {"deviation": "1 mm"}}, "samples": 1})",
                   "/uncertainty/samples must be a whole number from 2 to 10000000, got 1"},
        BadProblem{"/scene/joints/guide/axis", "[0, 0, 0]",
                   "/scene/joints/guide/axis must not be zero, got [0,0,0]"},
        BadProblem{"/scene/joints/guide/axis", "remove",
                   R"(/scene/joints/guide is missing the key "axis")"},
        BadProblem{"/scene/joints/hub/axis", "[0, 0, 1]",
                   "/scene/joints/hub/axis is not for a fixed joint, which has no axis"},
        BadProblem{"/scene/joints/bearing/drive/ramp", "0",
                   "/scene/joints/bearing/drive/ramp must be positive [s], got 0"}));

INSTANTIATE_TEST_SUITE_P(
    Scenes, BadProblemFile,
    testing::Values(
        BadProblem{"/scene/bodies/crank/to", "[0, 0, 0]",
                   R"(/scene/bodies/crank has zero length: "from" and "to" are the same point)"},
        BadProblem{"/scene/bodies/rod/reference", "[2, 0, 0]",
                   "/scene/bodies/rod/reference must not be parallel to the beam, got [2,0,0]"},
        BadProblem{"/scene/bodies/rod/reference", "[0, 0, 0]",
                   "/scene/bodies/rod/reference must not be zero, got [0,0,0]"},
        BadProblem{"/scene/bodies/rod/segments", "[]",
                   "/scene/bodies/rod/segments must have at least one segment"},
        BadProblem{"/scene/bodies/rod/segments/0/length_fraction", "0.2",
                   "/scene/bodies/rod/segments must have length fractions with the sum 1, got the "
                   "sum 0.95"},
        BadProblem{
            "/scene/bodies/rod/segments/0/length_fraction", "remove",
            R"(/scene/bodies/rod/segments must have a "length_fraction" in all segments or in none)"},
        BadProblem{"/scene/bodies/rod/section", R"({"type": "circle", "diameter": 1})",
                   R"(/scene/bodies/rod has both "segments" and "section")"},
        BadProblem{"/scene/bodies/rod/segments/0/section/thickness", R"("16 mm")",
                   "/scene/bodies/rod/segments/0/section/thickness must not exceed the radius "
                   "0.015 [m] of the tube, got 0.016"},
        BadProblem{"/scene/bodies/wheel/inertia", "[0, 0, 0, 0, 0, 0]",
                   "/scene/bodies/wheel/inertia must not be all zero (a body without inertia is a "
                   "point-mass), got [0,0,0,0,0,0]"},
        BadProblem{"/scene/bodies/wheel/inertia", "[1, 1, 1, 2, 0, 0]",
                   "/scene/bodies/wheel/inertia must have no negative principal moment (xx, yy, "
                   "zz, xy, xz, yz), got [1,1,1,2,0,0]"},
        BadProblem{"/scene/bodies/wheel/inertia/0", "-1",
                   "/scene/bodies/wheel/inertia/0 must not be negative [kg m^2], got -1"},
        BadProblem{
            "/scene/joints/hub/drive", R"({"type": "constant-speed", "speed": 1})",
            R"(/scene/joints/hub/drive needs a joint of the type "revolute", "prismatic", "point-on-line", "cylindrical", "universal", "planar" or "distance", but "hub" is of the type "fixed")"},
        BadProblem{
            "/scene/joints/end/drive", R"({"type": "constant-speed", "speed": 1})",
            R"(/scene/joints/end/drive needs two bodies that can turn, but "slider" is a point mass)"},
        BadProblem{"/scene/joints/hub", "remove",
                   "/scene/bodies/wheel is not connected to anything by a joint or a load"},
        BadProblem{
            "/scene/joints/pin/at/0", R"("121 mm")",
            R"(/scene/joints/pin/at must be on the axis of the beam "crank", the nearest point is (0.12, 0, 0) [m], got (0.121, 0, 0))"},
        BadProblem{
            "/scene/joints/pin/at/1", R"("1 mm")",
            R"(/scene/joints/pin/at must be on the axis of the beam "crank", the nearest point is (0.12, 0, 0) [m], got (0.12, 0.001, 0))"},
        BadProblem{
            "/scene/joints/guide/at/0", "0.31",
            R"(/scene/joints/guide/at must be where the point mass "slider" is, (0.3, 0, 0) [m], got (0.31, 0, 0))"},
        BadProblem{
            "/scene/bodies/crank/to/0", R"({"variable": "diameter", "factor": 4})",
            R"(/scene/joints/pin/at must stay at the share 1 of the length of the beam "crank", which is (0.04, 0, 0) [m], got (0.12, 0, 0), with the variable "diameter" at its lower bound)"},
        BadProblem{
            "/variables/width/upper", "1e308",
            R"(/scene/bodies/crank/section/height must be positive [m], got inf with the variable "width" at its upper bound)"}));

}  // namespace
}  // namespace pleuel::test
