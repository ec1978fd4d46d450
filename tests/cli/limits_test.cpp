#include <fstream>

#include <gmock/gmock.h>

#include "tests/cli/program.hpp"

/// The table of limits.
namespace pleuel::test::limits_test {
namespace {

/// A beam that is to be three times as high as it is wide: 3 w − h ≤ 0.
ProgramRun simulate_with_width(const std::string& width) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "bar.json") << R"({"scene": {
      "bodies": {"bar": {"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "steel",
                         "elements": 1,
                         "section": {"type": "rectangle", "width": "= w", "height": "= h"}}},
      "joints": {"root": {"type": "fixed", "bodies": ["ground", "bar"], "at": [0, 0, 0]}}},
    "simulation": {"end_time": 0.001, "step": 0.001},
    "variables": {"w": {"start": "100 mm", "lower": "50 mm", "upper": "500 mm"},
                  "h": {"start": "300 mm", "lower": "50 mm", "upper": "500 mm"}},
    "responses": {"m": {"type": "mass"}},
    "constraints": {"slim": {"linear": {"w": 3, "h": -1}, "upper": 0}}})";
  return run_program(folder.path(), {"simulate", "bar.json", "--json", "--set", "w=" + width});
}

/// In floating point three times 0.1 is more than 0.3, by 5.6e-17.
TEST(LimitOfZeroOnVariables, IsKeptWhereItsTermsCancel) {
  for (const auto& [width, is_kept] :
       {std::pair("100 mm", true), std::pair("99.99 mm", true), std::pair("100.0001 mm", false)}) {
    const ProgramRun run = simulate_with_width(width);
    EXPECT_EQ(run.exit_code, is_kept ? 0 : 4) << run.err;
    const nlohmann::json limit = run.document().at("constraints").at("slim");
    EXPECT_EQ(limit.at("kept"), is_kept) << width;
    if (std::string(width) == "100 mm") {
      EXPECT_EQ(limit.at("value"), 0.0);
    }
  }
}

}  // namespace
}  // namespace pleuel::test::limits_test
