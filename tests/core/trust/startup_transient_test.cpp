/// Peaks that the start decides.

#include "core/trust/startup_transient.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/core/trust/findings_of.hpp"

namespace pleuel::test::startup_transient_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// A cantilever of 1 m whose tip is pushed: its first period is 62 ms.
ProblemFile pushed_cantilever(const std::string& push,
                              const std::vector<std::string>& changes = {}) {
  return read_scene(
      fmt::format(
          R"({{"scene": {{"bodies": {{"beam": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0],
              "material": "steel", "section": {{"type": "rectangle", "width": 0.03, "height": 0.02}},
              "elements": 4, "frame": "tangent"}}}},
              "joints": {{"clamp": {{"type": "fixed", "bodies": ["ground", "beam"], "at": [0, 0, 0]}}}},
              "loads": {{"push": {{"type": "force", "body": "beam", "at": [1, 0, 0],
                                   "direction": [0, -1, 0], "value": {}}}}}}},
              "effects": {{"geometric_stiffening": "off"}},
              "simulation": {{"end_time": 0.2, "step": 0.0002}},
              "responses": {{
                "tip": {{"type": "deflection", "body": "beam", "at": 1, "over_time": "max-abs"}},
                "pull": {{"type": "section-force", "body": "beam", "part": "axial",
                          "at": 0.5, "over_time": "max-abs"}},
                "end": {{"type": "deflection", "body": "beam", "at": 1, "over_time": "final"}}}}}})",
          push),
      changes);
}

std::vector<Finding> findings(const ProblemFile& problem) {
  return findings_of(problem, check_startup_transient);
}

/// Without damping a load that is there at once deflects twice as far as at rest (the second and
/// further modes, 3 % of the deflection, take their share at other times).
TEST(SuddenStart, OfAConstantLoadIsToldByHowMuch) {
  const std::vector<Finding> found = findings(pushed_cantilever("20"));
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_FALSE(found[0].is_serious);
  EXPECT_THAT(found[0].responses, ElementsAre("tip"));
  EXPECT_THAT(found[0].text, HasSubstr("the start decides \"tip\": "));
  EXPECT_THAT(found[0].text, HasSubstr("it would be 0.50"));
}

/// Laws that begin with a jump say so themselves; such that begin at zero shake nothing.
TEST(SuddenStart, IsNotToldOfLawsThatJumpOrBeginAtZero) {
  EXPECT_THAT(
      findings(pushed_cantilever(R"({"type": "step", "from": 0, "to": 20, "time": 0, "rise": 0})")),
      IsEmpty());
  EXPECT_THAT(findings(pushed_cantilever(
                  R"({"type": "table", "times": [0, 0.1, 1], "values": [0, 20, 20]})")),
              IsEmpty());
}

TEST(SuddenStart, IsNoneFromEquilibriumOrWithDeflectionsThatAreGiven) {
  EXPECT_THAT(findings(pushed_cantilever("20", {"/simulation/initial_state=\"quasi-static\""})),
              IsEmpty());
  EXPECT_THAT(
      findings(pushed_cantilever("20", {R"(/scene/bodies/beam/initial_deflections=[{"at": [1, 0, 0],
                         "direction": [0, 1, 0], "displacement": 0.001}])"})),
      IsEmpty());
}

/// No comparison run where the file asks for none.
TEST(SuddenStart, IsNotLookedForWithoutChecks) {
  EXPECT_THAT(findings(pushed_cantilever("20", {"/simulation/resolution_check=false"})), IsEmpty());
}

/// What has come to rest before the window begins is not of the start.
TEST(SuddenStart, ThatHasDiedOutIsNotTold) {
  const std::vector<std::string> damped = {R"(/scene/bodies/beam/damping={"mass": 80})",
                                           "/responses/tip/from=0.15"};
  EXPECT_THAT(findings(pushed_cantilever("20", damped)), IsEmpty());
  EXPECT_THAT(findings(pushed_cantilever("20", {damped[0]})), SizeIs(1));
}

/// A crank that turns at full speed from the first instant, with and without a run-up.
TEST(SuddenStart, OfADriveIsToldAndNotOfARunUp) {
  const auto crank = [](const std::string& drive) {
    return read_scene(fmt::format(
        R"({{"scene": {{"bodies": {{"arm": {{"type": "beam", "from": [0, 0, 0], "to": [0.5, 0, 0],
            "material": "steel", "section": {{"type": "rectangle", "width": 0.01, "height": 0.004}},
            "elements": 4}}, "block": {{"type": "point-mass", "at": [0.5, 0, 0], "mass": 0.1}}}},
            "joints": {{"shaft": {{"type": "revolute", "bodies": ["ground", "arm"], "at": [0, 0, 0],
                                   "drive": {}}},
                        "end": {{"type": "fixed", "bodies": ["arm", "block"], "at": [0.5, 0, 0]}}}}}},
            "simulation": {{"end_time": 0.4, "step": 0.0005}},
            "responses": {{"bend": {{"type": "stress", "body": "arm", "over_time": "max"}}}}}})",
        drive));
  };
  EXPECT_THAT(findings(crank(R"({"type": "constant-speed", "speed": 60})")), SizeIs(1));
  EXPECT_THAT(findings(crank(R"({"type": "ramp-to-speed", "speed": 60, "ramp": 0.2})")), IsEmpty());
}

}  // namespace
}  // namespace pleuel::test::startup_transient_test
