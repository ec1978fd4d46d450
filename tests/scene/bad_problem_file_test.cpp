#include <ostream>
#include <sstream>

#include <fmt/format.h>

#include "tests/scene/good_problem.hpp"
#include "tests/support/parameter_name.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test {

void PrintTo(const BadEdit& bad, std::ostream* stream) {
  *stream << bad.pointer << " = " << bad.value;
}

std::vector<BadEdit> bad_edits(const std::string& table) {
  std::istringstream lines(table);
  std::vector<BadEdit> edits;
  for (std::string line; std::getline(lines, line);) {
    if (line.empty()) continue;
    std::vector<std::string> cells;
    for (std::size_t begin = 0, end = 0; end != std::string::npos; begin = end + 3) {
      end = line.find(" | ", begin);
      cells.push_back(line.substr(begin, end - begin));
    }
    BadEdit edit{cells.at(0), cells.at(1), cells.at(2)};
    const std::string above = edit.pointer.substr(0, edit.pointer.rfind('/'));
    if (edit.message.starts_with('~')) edit.message.replace(0, 1, edit.pointer);
    if (edit.message.starts_with('^')) edit.message.replace(0, 1, above);
    if (cells.size() > 3) edit.mistakes = std::stoi(cells[3]);
    edits.push_back(edit);
  }
  return edits;
}

}  // namespace pleuel::test

namespace pleuel::test::bad_edit_test {
namespace {

void expect_refusal(const Json& document, const BadEdit& bad) {
  const std::string complaint = test::complaint(document), first = "bad.json: " + bad.message;
  if (bad.mistakes == 1) {
    EXPECT_EQ(complaint, first);
  } else {
    EXPECT_TRUE(complaint.starts_with(fmt::format("{} mistakes:\n{}\n", bad.mistakes, first)))
        << complaint;
  }
}

TEST_P(BadProblemFile, IsRefusedWithPlaceValueAndRule) {
  const BadEdit& bad = GetParam();
  expect_refusal(edited(bad.pointer, bad.value), bad);
}

TEST_P(BadMechanismFile, IsRefusedWithPlaceValueAndRule) {
  const BadEdit& bad = GetParam();
  expect_refusal(edited(good_mechanism(), bad.pointer, bad.value), bad);
}

TEST(GoodProblemFile, IsNotRefused) {
  EXPECT_EQ(complaint(good_json()), "");
}

TEST(GoodMechanismFile, IsNotRefused) {
  EXPECT_EQ(complaint(good_mechanism()), "");
}

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
}  // namespace pleuel::test::bad_edit_test

namespace pleuel::test::bad_problem_file_test {
namespace {

INSTANTIATE_TEST_SUITE_P(Keys, BadProblemFile, testing::ValuesIn(bad_edits(R"rows(
/colour | 1 | the problem has the unknown key "colour"; known are "$schema", "name", "description", "scene", "effects", "simulation", "sensitivity", "constants", "variables", "responses", "objective", "constraints", "optimizer", "pareto", "accuracy", "uncertainty" and "cases"
/scene/bodies/crank/section/heigth | 1 | ^ has the unknown key "heigth"; did you mean "height"?
/scene/bodies/slider/elements | 1 | ^ has the unknown key "elements"; known are "type", "velocity", "at" and "mass"
/objective/scale | 2 | ^ has the unknown key "scale"; known are "minimize", "maximize" and "over_cases"
/scene | remove | the problem is missing the key "scene"
/simulation | remove | the problem is missing the key "simulation"
/scene/bodies | remove | ^ is missing the key "bodies"
/scene/gravity | [0, {"variable": "width"}, 0] | ~ cannot be bound to a design variable
/scene/materials/steel/density | remove | ^ is missing the key "density"
/scene/bodies/crank/section | remove | ^ is missing the key "section"
/scene/bodies/crank | {"tpye": "beam"} | ~ is missing the key "type"; is "tpye" a misspelling?
/scene/bodies/crank/section | {"type": "circle", "diamter": 0.01} | ~ has the unknown key "diamter"; did you mean "diameter"?
/effects/torsion | "on" | ^ has the unknown key "torsion"; known are "spatial_motion", "geometric_stiffening", "rotary_inertia", "elasticity", "axial_elasticity", "torsional_elasticity" and "tolerance"
/robustness | {} | the problem has the unknown key "robustness"; known are "$schema", "name", "description", "scene", "effects", "simulation", "sensitivity", "constants", "variables", "responses", "objective", "constraints", "optimizer", "pareto", "accuracy", "uncertainty" and "cases"
/variables/width/lower | remove | ^ is missing the key "lower"
/scene/joints/bearing/drive/ramp | remove | ^ is missing the key "ramp"
/variables/ | {"start": 1, "lower": 0, "upper": 2} | ^ has a member without a name
/responses/a~1b | {"type": "stress", "body": "rod", "overtime": "max"} | ~ has the unknown key "overtime"; did you mean "over_time"?
)rows")),
                         named_by(&BadEdit::pointer));

INSTANTIATE_TEST_SUITE_P(Names, BadProblemFile, testing::ValuesIn(bad_edits(R"rows(
/scene/bodies/crank/material | "stel" | ~ names the unknown material "stel"; did you mean "steel"?
/scene/bodies/crank/section/width | {"variable": "widht"} | ~/variable names the unknown variable "widht"; did you mean "width"?
/scene/bodies/crank/section/width | {"factor": 2} | ~ is missing the key "variable"
/scene/bodies/crank/section/width | {"variable": "width", "factor": 0} | ~/factor must not be zero, got 0
/scene/bodies/crank/section/width | {"variable": "load"} | /scene/bodies/slider/mass uses the variable "load" as a mass [kg], but /scene/bodies/crank/section/width uses it as a length [m]
/scene/bodies/crank/section/width | {"variable": "diameter", "factor": "2"} | ~/factor must be a number, got "2"
/scene/joints/pin/bodies/1 | "rdo" | ~ names the unknown body "rdo"; did you mean "rod"?
/scene/joints/pin/bodies | ["rod", "rod"] | ~ must name two bodies, got "rod" twice
/scene/joints/pin/bodies | ["rod"] | ~ must be a list of 2 values, got ["rod"]
/scene/bodies/ground | {"type": "point-mass", "at": [0, 0, 0], "mass": 1} | ~ has the name that is kept for the ground
/responses/stress/body | "rodd" | ~ names the unknown body "rodd"; did you mean "rod"?
/responses/stress/body | "slider" | ~ must name a beam, but "slider" is none
/responses/impulse/joint | "baering" | ~ names the unknown joint "baering"; did you mean "bearing"?
/responses/impulse/joint | "pin" | ~ names the joint "pin", which has no drive
/objective/minimize | "wieght" | ~ names the unknown response "wieght"; did you mean "weight"?
/objective | remove | /pareto needs an objective, and the problem has none
/constraints/strength/response | "strss" | ~ names the unknown response "strss"; did you mean "stress"?
/constraints/slender/linear/hight | 1 | ~ names the unknown variable "hight"; known are "width", "diameter" and "load"
/pareto/constraint | "stifness" | ~ names the unknown constraint "stifness"; did you mean "stiffness"?
/pareto/constraint | "effort" | ~ must name a constraint with one limit, but "effort" has two
/variables/spare | {"start": 1, "lower": 0, "upper": 2} | ~ is not used: no number of the scene, no formula and no linear constraint names it
/variables | remove | /scene/bodies/crank/section/width/variable names the unknown variable "width"; there are none | 3
/responses/weight/bodies | ["rod", "crank", "rod"] | ~/2 names the body "rod" a second time
/responses/weight/bodies | [] | ~ must name at least one body
/responses/weight/body | "rod" | ^ has both "body" and "bodies"
)rows")),
                         named_by(&BadEdit::pointer));

INSTANTIATE_TEST_SUITE_P(Types, BadProblemFile, testing::ValuesIn(bad_edits(R"rows(
/scene/bodies | [] | ~ must be an object {…}, got []
/scene/bodies | {} | ~ has no body
/scene/bodies/crank | 3 | ~ must be an object {…}, got 3
/scene/bodies/crank/type | "baem" | ~ must be "beam", "rigid", "point-mass" or "invariants", got "baem"; did you mean "beam"?
/scene/bodies/crank/type | 7 | ~ must be "beam", "rigid", "point-mass" or "invariants", got 7
/scene/bodies/crank/from | [0, 0] | ~ must be a list of 3 values, got [0,0]
/scene/bodies/crank/from/1 | null | ~ must be a length [m]: a number in SI units, a text with unit, a formula "= …" or {"variable": name}, got null
/scene/bodies/crank/from/1 | [1] | ~ must be a length [m]: a number in SI units, a text with unit, a formula "= …" or {"variable": name}, got [1]
/scene/bodies/crank/elements | "4" | ~ must be a whole number from 1 to 10000, got "4"
/scene/bodies/crank/elements | 2.5 | ~ must be a whole number from 1 to 10000, got 2.5
/name | "" | ~ must be a text in quotes, not empty, got ""
/name | 7 | ~ must be a text in quotes, not empty, got 7
/simulation/end_time | true | ~ must be a time [s]: a number in SI units, a text with unit or a formula, got true
/simulation/end_time | {"variable": "width"} | ~ must be a time [s]: a number in SI units, a text with unit or a formula, got {"variable":"width"}
/simulation/scheme | "euler" | ~ must be "generalized-alpha", "newmark" or "implicit-euler", got "euler"
/simulation/formulation | "index-2" | ~ must be "index-3", "stabilized-index-2" or "index-1", got "index-2"; did you mean "index-3"?
/simulation/local_error | 1e-6 | ~ is for the formulations "stabilized-index-2" and "index-1" only
/simulation/smallest_step | "1 us" | ~ is for a simulation with "local_error" only
/simulation/baumgarte | "100 1/s" | ~ is for the formulation "index-1" only
/simulation/projection | true | ~ is for the formulation "index-1" only
/effects/spatial_motion | true | ~ must be "auto", "on" or "off", got true
/accuracy/steps | 1e-4 | ~ must be a list […], got 0.0001
/accuracy/elements | [] | ~ must have at least one number
/scene/joints/bearing/type | "revolut" | ~ must be "revolute", "prismatic", "fixed", "point-on-line", "cylindrical", "universal", "spherical", "planar", "distance" or "point-on-plane", got "revolut"; did you mean "revolute"?
/scene/bodies/rod/frame | "cord" | ~ must be "tangent", "tangent-end", "chord" or "mean-axis", got "cord"; did you mean "chord"?
)rows")),
                         named_by(&BadEdit::pointer));

INSTANTIATE_TEST_SUITE_P(Units, BadProblemFile, testing::ValuesIn(bad_edits(R"rows(
/scene/bodies/crank/to/0 | "120 kg" | ~ must be a length [m], got "120 kg": "kg" measures something else
/scene/bodies/crank/to/0 | "120 mmm" | ~ must be a length [m], got "120 mmm": "mmm" is not a known unit; did you mean "mm"?
/scene/bodies/crank/to/0 | "120" | ~ must be a length [m], got "120": a number in quotes needs its unit
/scene/bodies/crank/to/0 | "long" | ~ must be a length [m], got "long": it does not begin with a number
/scene/bodies/crank/to/0 | "nan m" | ~ must be a length [m], got "nan m": it does not begin with a number
/scene/bodies/crank/to/0 | "1e400 m" | ~ must be a length [m], got "1e400 m": it is out of the range of numbers
/scene/materials/steel/young | "210 GN" | ~ must be a stress [Pa], got "210 GN": "GN" measures something else
/scene/materials/steel/poisson | "0.3 m" | ~ must be a number without unit, got "0.3 m": "m" measures something else
/scene/joints/bearing/drive/speed | "25 Hz" | ~ must be an angular speed [rad/s], got "25 Hz": "Hz" names no angle; write rad/s, deg/s or rpm
/scene/bodies/crank/damping/stiffness | "1 1/s" | ~ must be a time [s], got "1 1/s": "1/s" measures something else
/constraints/strength/upper | "0.2 mm" | ~ must be a stress [Pa], got "0.2 mm": "mm" measures something else
/constraints/effort/upper | "1 N m" | ~ must be a torque times a time [N m s], got "1 N m": "N m" measures something else
/constraints/slender/upper | "1 kg" | ~ must be a length [m], got "1 kg": "kg" measures something else
/pareto/from | "1 MPa" | ~ must be a length [m], got "1 MPa": "MPa" measures something else
/variables/width/start | "20 kg" | ~ must be a length [m], got "20 kg": "kg" measures something else
/variables/load/lower | "1 mm" | ~ must be a mass [kg], got "1 mm": "mm" measures something else
)rows")),
                         named_by(&BadEdit::pointer));

INSTANTIATE_TEST_SUITE_P(Values, BadProblemFile, testing::ValuesIn(bad_edits(R"rows(
/scene/bodies/slider/mass | -0.3 | ~ must be positive [kg], got -0.3
/scene/bodies/slider/mass | "-300 g" | ~ must be positive [kg], got "-300 g"
/scene/bodies/slider/mass | 0 | ~ must be positive [kg], got 0
/scene/bodies/rod/segments/1/section/diameter | 0 | ~ must be positive [m], got 0
/variables/width | {"start": 0.02, "lower": "-1 mm", "upper": 0.06} | /scene/bodies/crank/section/width must be positive [m], got -0.001 with the variable "width" at its lower bound
/scene/bodies/crank/section/width | {"variable": "width", "factor": -1} | ~ must be positive [m], got -0.02 with the variable "width" at its start value
/scene/materials/steel/poisson | 0.5 | ~ must be greater than -1 and less than 0.5, got 0.5
/scene/materials/steel/poisson | -1 | ~ must be greater than -1 and less than 0.5, got -1
/scene/materials/steel/young | 0 | ~ must be positive [Pa], got 0
/scene/bodies/crank/damping/mass | -1 | ~ must not be negative [1/s], got -1
/scene/bodies/crank/elements | 0 | ~ must be a whole number from 1 to 10000, got 0
/scene/bodies/crank/elements | 10001 | ~ must be a whole number from 1 to 10000, got 10001
/scene/bodies/crank/elements | 1e300 | ~ must be a whole number from 1 to 10000, got 1e+300
/simulation/end_time | 0 | ~ must be positive [s], got 0
/simulation/step | "-1 ms" | ~ must be positive [s], got "-1 ms"
/simulation/step | "1 s" | ~ must not be longer than the simulation, got "1 s"
/simulation/step | 1e-300 | ~ must not make more than 1e+09 steps, got 1e-300
/simulation/spectral_radius | 1.01 | ~ must be from 0 to 1, got 1.01
/simulation/newton_tolerance | 0 | ~ must be greater than 0 and less than 1, got 0
/simulation/max_newton_iterations | 0 | ~ must be a whole number from 1 to 1000000, got 0
/variables/width/lower | "7 cm" | ~ must not be above the upper bound of 6 cm, got "7 cm"
/variables/width/start | "1 mm" | ~ must not be below the lower bound of 4 mm, got "1 mm"
/variables/width/start | "1 m" | ~ must not be above the upper bound of 6 cm, got "1 m"
/constraints/effort/lower | 2 | ~ must not be above the upper limit, got 2
/constraints/strength/upper | remove | ^ has no limit; it needs "upper", "lower" or both
/constraints/slender/response | "bow" | ^ has both "response" and "linear"
/constraints/slender/linear | {} | ~ must have at least one variable
/constraints/slender/linear/width | 0 | ~ must not be zero, got 0
/constraints/slender/linear/load | 1 | ~ uses the variable "load" as a length [m], but /scene/bodies/slider/mass uses it as a mass [kg]
/responses/bow/at | 1.5 | ~ must be a place along the beam from 0 to 1, got 1.5
/responses/stress/segment | 2 | ~ must be a whole number from 0 to 1, got 2
/responses/stress/over_time | remove | ^ is missing the key "over_time"
/responses/bow/over_time | "maxabs" | ~ must be "max", "min", "max-abs", "rms", "mean", "integral" or "final", got "maxabs"; did you mean "max-abs"?
/responses/weight/over_time | "max" | ~ is not for a mass, which does not change in time
/responses/bow/direction | "w" | ~ must be "y", "z", "x" or "resultant", got "w"
/responses/bow/against | "cord" | ~ must be "frame", "chord" or "rigid-mechanism", got "cord"; did you mean "chord"?
/responses/bow | {"type": "deflection", "body": "rod", "at": 0.5, "over_time": "max", "against": "rigid-mechanism"} | ~ is missing the key "direction"
/responses/place/direction | remove | ^ is missing the key "direction"
/responses/place | {"type": "position", "body": "slider", "at": 1, "direction": "x", "over_time": "final"} | ~/at is for beams only, but "slider" is none
/responses/place/at | remove | ^ is missing the key "at"
/sensitivity/method | "central" | ~ must be "auto", "direct", "adjoint", "forward-difference" or "central-difference", got "central"
/sensitivity/invariant_derivatives | "dual" | ~ must be "exact", "complex-step", "central" or "forward", got "dual"
/sensitivity | {"invariant_step": 1e-6} | ~/invariant_step is for the invariant derivatives "central" and "forward" only
/sensitivity/memory | "512 kg" | ~ must be an amount of memory [B], got "512 kg": "kg" measures something else
/sensitivity/memory | 0 | ~ must be positive [B], got 0
/sensitivity/difference_step | 0 | ~ must be greater than 0 and less than 1, got 0
/optimizer/tolerance | 1 | ~ must be greater than 0 and less than 1, got 1
/optimizer/max_iterations | 0 | ~ must be a whole number from 1 to 1000000, got 0
/pareto/to | "0.1 mm" | ~ must differ from "from", got "0.1 mm"
/pareto/points | 1 | ~ must be a whole number from 2 to 10000, got 1
/pareto/gap | 0 | ~ must be at least 0.001 and less than 1, got 0
/pareto/gap | 5 | ~ must be at least 0.001 and less than 1, got 5
/pareto/most_points | 9 | ~ is for points that "gap" asks for
/pareto | {"constraint": "stiffness", "from": "0.1 mm", "to": "0.4 mm", "points": 5, "gap": 0.1, "most_points": 4} | ~/most_points must be a whole number from 5 to 10000, got 4
/accuracy/target | 0 | ~ must be greater than 0 and less than 1, got 0
/accuracy/steps/1 | 0 | ~ must be positive [s], got 0
/constraints/strength/deviations | 3 | ~ needs the block "uncertainty", which says what scatters
/constraints/strength/deviations | -3 | ~ must be positive, got -3
/constraints/effort/deviations | 3 | ~ is for one limit; this constraint has two
/uncertainty | {"parameters": {}} | ~/parameters must have at least one parameter
/uncertainty | {"parameters": {"wdth": {"deviation": "0.1 mm"}}} | ~/parameters/wdth names the unknown variable "wdth"; did you mean "width"?
/uncertainty | {"parameters": {"width": {"deviation": "1 mm", "interval": "1 mm"}}} | ~/parameters/width must have either a deviation or an interval
/uncertainty | {"parameters": {"width": {"deviation": 0}}} | ~/parameters/width/deviation must be positive [m], got 0
/uncertainty | {"parameters": {"width": {"deviation": "3.5 mm"}}} | ~/parameters/width leads to -0.001 for /scene/bodies/crank/section/width, which must be positive [m]
/uncertainty | {"parameters": {"width": {"deviation": "1 mm"}}, "samples": 1} | ~/samples must be a whole number from 2 to 10000000, got 1
/scene/joints/guide/axis | [0, 0, 0] | ~ must not be zero, got [0,0,0]
/scene/joints/guide/axis | remove | ^ is missing the key "axis"
/scene/joints/hub/axis | [0, 0, 1] | ~ is not for a fixed joint, which has no axis
/scene/joints/bearing/drive/ramp | 0 | ~ must be positive [s], got 0
)rows")),
                         named_by(&BadEdit::pointer));

INSTANTIATE_TEST_SUITE_P(Scenes, BadProblemFile, testing::ValuesIn(bad_edits(R"rows(
/scene/bodies/crank/to | [0, 0, 0] | ^ has zero length: "from" and "to" are the same point
/scene/bodies/rod/reference | [2, 0, 0] | ~ must not be parallel to the beam, got [2,0,0]
/scene/bodies/rod/reference | [0, 0, 0] | ~ must not be zero, got [0,0,0]
/scene/bodies/rod/segments | [] | ~ must have at least one segment
/scene/bodies/rod/segments/0/length_fraction | 0.2 | /scene/bodies/rod/segments must have length fractions with the sum 1, got the sum 0.95
/scene/bodies/rod/segments/0/length_fraction | remove | /scene/bodies/rod/segments must have a "length_fraction" in all segments or in none
/scene/bodies/rod/section | {"type": "circle", "diameter": 1} | ^ has both "segments" and "section"
/scene/bodies/rod/segments/0/section/thickness | "16 mm" | ~ must not exceed the radius 0.015 [m] of the tube, got 0.016
/scene/bodies/wheel/inertia | [0, 0, 0, 0, 0, 0] | ~ must not be all zero (a body without inertia is a point-mass), got [0,0,0,0,0,0]
/scene/bodies/wheel/inertia | [1, 1, 1, 2, 0, 0] | ~ must have no negative principal moment (xx, yy, zz, xy, xz, yz), got [1,1,1,2,0,0]
/scene/bodies/wheel/inertia | [1e-2, 1e-6, 1e-6, 0, 0, 0] | ~ must have no principal moment above the sum of the other two (0.01 > 1e-06 + 1e-06 kg m^2), got [0.01,1e-06,1e-06,0,0,0]
/scene/bodies/wheel/inertia | [1.5, 1.5, 3.1, 1, 0, 0] | ~ must have no principal moment above the sum of the other two (3.1 > 0.5 + 2.5 kg m^2), got [1.5,1.5,3.1,1,0,0]
/scene/bodies/wheel/inertia/0 | -1 | ~ must not be negative [kg m^2], got -1
/scene/joints/hub/drive | {"type": "constant-speed", "speed": 1} | ~ needs a joint of the type "revolute", "prismatic", "point-on-line", "cylindrical", "universal", "planar" or "distance", but "hub" is of the type "fixed"
/scene/joints/end/drive | {"type": "constant-speed", "speed": 1} | ~ needs two bodies that can turn, but "slider" is a point mass
/scene/joints/hub | remove | /scene/bodies/wheel is not connected to anything by a joint or a load
/scene/joints/pin/at/0 | "121 mm" | ^ must be on the axis of the beam "crank", the nearest point is (0.12, 0, 0) [m], got (0.121, 0, 0)
/scene/joints/pin/at/1 | "1 mm" | ^ must be on the axis of the beam "crank", the nearest point is (0.12, 0, 0) [m], got (0.12, 0.001, 0)
/scene/joints/guide/at/0 | 0.31 | ^ must be where the point mass "slider" is, (0.3, 0, 0) [m], got (0.31, 0, 0)
/scene/bodies/crank/to/0 | {"variable": "diameter", "factor": 4} | /scene/joints/pin/at must stay at the share 1 of the length of the beam "crank", which is (0.04, 0, 0) [m], got (0.12, 0, 0), with the variable "diameter" at its lower bound
/variables/width/upper | 1e308 | /scene/bodies/crank/section/height must be positive [m], got inf with the variable "width" at its upper bound
)rows")),
                         named_by(&BadEdit::pointer));

}  // namespace
}  // namespace pleuel::test::bad_problem_file_test
