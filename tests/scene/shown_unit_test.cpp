#include "core/scene/shown_unit.hpp"

#include <map>
#include <string>

#include <gtest/gtest.h>

#include "core/scene/problem_reader.hpp"

/// In which units people see responses.
namespace pleuel::test::shown_unit_test {
namespace {

/// A cantilever with limits that are written in different ways.
ProblemFile cantilever(const std::string& constraints) {
  return read_problem_text(R"json({
    "constants": {"most": "2 kN"},
    "scene": {
      "bodies": {"bar": {"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "steel",
        "elements": 2, "section": {"type": "rectangle", "width": 0.02, "height": 0.02}}},
      "joints": {"wall": {"type": "fixed", "bodies": ["ground", "bar"], "at": [0, 0, 0]}}
    },
    "simulation": {"end_time": 0.01, "step": 0.001},
    "responses": {
      "force": {"type": "reaction-force", "joint": "wall", "direction": "y", "over_time": "max"},
      "stress": {"type": "stress", "body": "bar", "over_time": "max"},
      "speed": {"type": "velocity", "body": "bar", "at": 1, "direction": "y", "over_time": "max"},
      "ratio": {"type": "expression", "value": "force/1 kN"},
      "twice": {"type": "expression", "value": "2*force", "unit": "MN"},
      "first": {"type": "frequency"}
    },
    "constraints": )json" + constraints +
                               "}",
                           "bar.json")
      .complete();
}

ShownUnit shown(const ProblemFile& problem, const std::string& response) {
  return unit_of(find_response(problem, response));
}

TEST(UnitOfAResponse, IsThatOfItsFirstLimit) {
  const ProblemFile problem = cantilever(R"json({
    "a": {"response": "force", "upper": "3 kN"}, "b": {"response": "force", "lower": "-5 N"},
    "c": {"response": "speed", "lower": "-20 mm/s", "upper": "1 m/s"},
    "d": {"response": "stress", "upper": "200 N/mm^2"},
    "e": {"response": "first", "lower": "60 rad/s"},
    "f": {"response": "= abs(force)", "upper": "3 kN"},
    "g": {"response": "ratio", "upper": "50 %"}})json");
  const std::map<std::string, std::pair<std::string, double>> expected = {
      {"force", {"kN", 1000.0}}, {"speed", {"m/s", 1.0}},        {"stress", {"N/mm^2", 1e6}},
      {"first", {"rad/s", 1.0}}, {"abs(force)", {"kN", 1000.0}}, {"ratio", {"%", 0.01}}};
  for (const auto& [response, unit] : expected) {
    EXPECT_EQ(shown(problem, response).name, unit.first);
    EXPECT_DOUBLE_EQ(shown(problem, response).factor, unit.second) << response;
  }
  EXPECT_EQ(shown(problem, "force").si, "N");
}

TEST(UnitOfAResponse, IsTheUsualOneWhereNoLimitHasOne) {
  const ProblemFile problem = cantilever(R"json({
    "a": {"response": "force", "upper": "= most"}, "b": {"response": "stress", "upper": 2e8}})json");
  EXPECT_EQ(shown(problem, "force").name, "N");
  EXPECT_EQ(shown(problem, "stress").name, "MPa");
  EXPECT_EQ(shown(problem, "first").name, "Hz");
}

TEST(UnitOfAResponse, IsWhatTheFileSays) {
  const ProblemFile problem =
      cantilever(R"json({"a": {"response": "twice", "upper": "3 kN"}})json");
  EXPECT_EQ(shown(problem, "twice").name, "MN");
}

}  // namespace
}  // namespace pleuel::test::shown_unit_test
