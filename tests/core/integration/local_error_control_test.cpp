#include <cmath>

#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "core/integration/simulation_options.hpp"

namespace pleuel::test::local_error_control_test {
namespace {

/// Two coordinates with scales of 1 and 10; ten regular steps of 0.1 s, at least an eighth of them.
class ControlOfTheLocalError : public testing::Test {
 protected:
  ControlOfTheLocalError() : control_(mechanism(), options()) {}

  const Mechanism& mechanism() {
    mechanism_.scale = Eigen::Vector2d(1.0, 10.0);
    return mechanism_;
  }
  static SimulationOptions options() {
    SimulationOptions options{1.0, 0.1};
    options.local_error = 1e-3;
    options.smallest_step = 0.0125;
    return options;
  }
  static State with_acceleration(double first, double second) {
    State state(2, 0);
    state.a = Eigen::Vector2d(first, second);
    return state;
  }

  Mechanism mechanism_;
  LocalErrorControl control_;
};

TEST_F(ControlOfTheLocalError, HalvesDownToTheSmallestStep) {
  EXPECT_EQ(control_.parts(), 8);
  EXPECT_EQ(control_.end_of_part(0), 8);
  for (const int end : {4, 2, 1}) {
    ASSERT_TRUE(control_.refine());
    EXPECT_EQ(control_.end_of_part(0), end);
  }
  EXPECT_FALSE(control_.refine());
}

/// A part of four eighths cannot begin at one of them.
TEST_F(ControlOfTheLocalError, BeginsPartsAtMultiplesOfTheirSize) {
  EXPECT_EQ(control_.end_of_part(4), 8);
  EXPECT_EQ(control_.end_of_part(6), 8);
  EXPECT_EQ(control_.end_of_part(7), 8);
  EXPECT_EQ(control_.level(), 3);
}

TEST_F(ControlOfTheLocalError, TakesLargerPartsAfterSmallErrors) {
  control_.set_level(2);
  control_.accept(0.2);
  EXPECT_EQ(control_.level(), 2);
  control_.accept(0.1);
  EXPECT_EQ(control_.level(), 1);
  control_.accept(0.1);
  control_.accept(0.1);
  EXPECT_EQ(control_.level(), 0);
}

/// c h³ q⃛ with q⃛ = (a⁺ − a)/h in each of the parts, relative to scale and allowance.
TEST_F(ControlOfTheLocalError, MeasuresTheErrorOfARegularStep) {
  Scheme scheme = make_scheme(SchemeType::generalized_alpha, 0.05, 0.8);
  const State old = with_acceleration(1.0, 5.0), found = with_acceleration(1.3, 11.0);
  control_.set_level(1);
  // The scheme's local_error is c h³; the second coordinate's 6/10 is twice the first one's 0.3/1.
  const double expected = 2.0 * std::abs(scheme.local_error) * 0.6 / 0.05 / 1e-3;
  EXPECT_NEAR(control_.relative_error(old, found, scheme), expected, 1e-12 * expected);
  EXPECT_EQ(control_.worst_coordinate(old, found, scheme), 1);
}

}  // namespace
}  // namespace pleuel::test::local_error_control_test
