#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/trust/lint.hpp"
#include "tests/core/trust/findings_of.hpp"

namespace pleuel::test::lost_places_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

std::vector<Finding> findings_at(const std::string& place) {
  return findings_of(read_scene(fmt::format(R"j({{"scene": {{
    "bodies": {{"bar": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "steel", "elements": 4,
      "section": {{"type": "circle", "diameter": "40 mm"}}}}}},
    "joints": {{"clamp": {{"type": "fixed", "bodies": ["ground", "bar"], "at": [0, 0, 0]}}}},
    "loads": {{"push": {{"type": "force", "body": "bar", "at": ["{}", 0, 0], "direction": [0, -1, 0], "value": 1}}}}}},
  "simulation": {{"end_time": "2 ms", "step": "1 ms"}},
  "responses": {{"mass": {{"type": "mass"}}}}}})j",
                                            place)),
                     check_lost_places);
}

/// A thousandth of the element is 0.25 mm; a millionth of the length is rounding.
TEST(LostPlaces, AreToldBetweenRoundingAndAnElement) {
  EXPECT_THAT(findings_at("0 mm"), IsEmpty());
  EXPECT_THAT(findings_at("0.0005 mm"), IsEmpty());
  EXPECT_THAT(findings_at("0.3 mm"), IsEmpty());
  const std::vector<Finding> found = findings_at("0.2 mm");
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_THAT(found[0].text,
              HasSubstr("\"push\" is only 0.0002 m beside an end of the beam \"bar\""));
}

}  // namespace
}  // namespace pleuel::test::lost_places_test
