/// What signals say of where their channels are.

#include <set>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/core/response/response_samples.hpp"
#include "tests/support/sample_name.hpp"

namespace pleuel::test::signal_description_test {
namespace {

using namespace response_samples;

class DescriptionOfASignal : public testing::TestWithParam<int> {
 protected:
  SampleScene sample_ = sample_with_strength(GetParam());
  Model model_ = sample_.build();
};

TEST_P(DescriptionOfASignal, TellsItsChannelsApart) {
  for (const Response& response : make_responses(all_histories(model_), model_)) {
    const Signal& signal = *response.history()->signal;
    std::set<std::string> descriptions;
    for (int channel = 0; channel < signal.channels(); ++channel) {
      descriptions.insert(signal.describe(channel));
    }
    EXPECT_EQ(descriptions.size(), static_cast<std::size_t>(signal.channels())) << response.name;
    EXPECT_FALSE(descriptions.contains("")) << response.name;
  }
}

/// The rows of the constraints are in the order of the joints.
TEST_P(DescriptionOfASignal, OfDriftNamesTheJointOfEachEquation) {
  if (model_.mechanism.system->multipliers() == 0) GTEST_SKIP() << "no constraints";
  ResponseSettings settings;
  settings.type = ResponseType::constraint_drift;
  const std::vector<Response> responses = make_responses({settings}, model_);
  const Signal& drift = *responses.front().history()->signal;
  int channel = 0;
  for (const JointModel& joint : model_.joints) {
    for (int i = 1; i <= joint.equations(); ++i) {
      EXPECT_EQ(drift.describe(channel++), fmt::format("joint {}, equation {}", joint.name, i));
    }
  }
  EXPECT_EQ(channel, drift.channels());
}

INSTANTIATE_TEST_SUITE_P(Samples, DescriptionOfASignal, testing::Range(0, sample_count),
                         sample_name);

}  // namespace
}  // namespace pleuel::test::signal_description_test
