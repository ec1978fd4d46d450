#include "core/response/peak_place.hpp"

#include <gtest/gtest.h>

#include "core/response/analysis.hpp"
#include "tests/picture/picture_problems.hpp"

namespace pleuel::test::peak_place_test {
namespace {

/// Four elements of equal lengths: node k is at k/4, wherever frames divide the beam.
TEST(PeakPlace, CountsElementsThroughAllFrames) {
  for (const char* more : {R"("frame": "tangent")", R"("frames": 2)"}) {
    const ProblemFile problem = turning_arm(more);
    const auto analysis = analyze(problem, start_design(problem));
    const auto share = [&](const std::string& place) {
      return share_of_place(analysis->model, "arm", place);
    };
    EXPECT_EQ(share("node 0, y = 0.01 m, z = 0.005 m"), 0.0) << more;
    EXPECT_DOUBLE_EQ(*share("node 2.5, y = 0.01 m, z = 0.005 m"), 0.625) << more;
    EXPECT_DOUBLE_EQ(*share("node 4"), 1.0) << more;
    EXPECT_EQ(share("at 0.25 of the length, y"), 0.25) << more;
  }
}

TEST(PeakPlace, IsUnknownOfOtherWordsAndOtherBodies) {
  const ProblemFile problem = turning_arm(R"("frame": "tangent")");
  const auto analysis = analyze(problem, start_design(problem));
  EXPECT_EQ(share_of_place(analysis->model, "arm", "drive"), std::nullopt);
  EXPECT_EQ(share_of_place(analysis->model, "arm", "node of"), std::nullopt);
  EXPECT_EQ(share_of_place(analysis->model, "ball", "node 1"), std::nullopt);
}

/// A cantilever that is turned bends most at its root: the peak that the words say.
TEST(PeakPlace, IsWhereTheSignalSaysThatThePeakIs) {
  const ProblemFile problem = turning_arm(R"("frame": "tangent")");
  const auto analysis = analyze(problem, start_design(problem));
  const Reduction& bending = analysis->reductions[0];
  const std::string place =
      analysis->responses[0].history()->signal->describe(bending.samples.front().channel);
  EXPECT_EQ(share_of_place(analysis->model, "arm", place), 0.0) << place;
}

}  // namespace
}  // namespace pleuel::test::peak_place_test
