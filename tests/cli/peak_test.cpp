/// Time and place of peaks.

#include <fstream>

#include <gmock/gmock.h>

#include "tests/cli/readback.hpp"

namespace pleuel::test::peak_test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

/// A cantilever of 1 m whose tip is pushed by a bell of force in the middle of 2 s, slowly against
/// its period of 62 ms.
const char* const pushed = R"j({"name": "pushed", "scene": {
    "bodies": {"beam": {"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "steel",
      "section": {"type": "rectangle", "width": "30 mm", "height": "20 mm"}, "elements": 4,
      "frame": "tangent"}},
    "joints": {"clamp": {"type": "fixed", "bodies": ["ground", "beam"], "at": [0, 0, 0]}},
    "loads": {"push": {"type": "force", "body": "beam", "at": [1, 0, 0], "direction": [0, -1, 0],
      "value": {"type": "expression", "value": "= 20 N*exp(-(4*(t/(1 s) - 1))^2)"}}}},
  "simulation": {"end_time": 2, "step": "2 ms"},
  "responses": {
    "root": {"type": "stress", "body": "beam", "over_time": "max"},
    "quarter": {"type": "deflection", "body": "beam", "at": 0.25, "over_time": "max-abs"},
    "end": {"type": "deflection", "body": "beam", "at": 1, "over_time": "final"}}})j";

TEST(Peaks, AreShownWithTimeAndPlace) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "pushed.json") << pushed;
  const ProgramRun run = run_program(folder.path(), {"simulate", "pushed.json", "-o", "run"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json responses =
      json::parse(read_file(folder.path() / "run" / "result.json")).at("responses");
  for (const auto& [name, share] : {std::pair("root", 0.0), std::pair("quarter", 0.25)}) {
    const json& peak = responses.at(name).at("peak");
    EXPECT_NEAR(peak.at("time").get<double>(), 1.0, 0.02) << name;
    EXPECT_DOUBLE_EQ(peak.at("share").get<double>(), share) << name;
    EXPECT_FALSE(peak.at("place").get<std::string>().empty()) << name;
  }
  EXPECT_FALSE(responses.at("end").contains("peak"));
  EXPECT_THAT(run.out, HasSubstr("peak at"));
  EXPECT_THAT(run.out, HasSubstr(" s, 0 of the length\n"));
  EXPECT_THAT(run.out, HasSubstr(" s, 0.25 of the length\n"));
  EXPECT_THAT(run.out + run.err, Not(HasSubstr("the start decides")));
}

}  // namespace
}  // namespace pleuel::test::peak_test
