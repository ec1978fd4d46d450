#include "core/base/number_text.hpp"

#include <gtest/gtest.h>

namespace pleuel::test::number_text_test {
namespace {

TEST(NumberText, SharesArePercentsUntilTheyAreHardToRead) {
  EXPECT_EQ(percent(0.4517), "45.2 %");
  EXPECT_EQ(percent(9.99), "999.0 %");
  EXPECT_EQ(percent(2396.99), "2397 times");
  EXPECT_EQ(percent(-12.34), "-12.3 times");
  EXPECT_EQ(percent(3.1e9), "3.10e+09 times");
}

TEST(NumberText, WhatIsRoundedToNothingHasNoSign) {
  EXPECT_EQ(percent(-1e-9), "0.0 %");
  EXPECT_EQ(signed_percent(-4e-4), "0.0 %");
  EXPECT_EQ(signed_percent(0.0), "0.0 %");
  EXPECT_EQ(signed_percent(6e-4), "+0.1 %");
  EXPECT_EQ(signed_percent(-0.021), "−2.1 %");
}

TEST(NumberText, NumbersKeepTheirSignificantDigits) {
  EXPECT_EQ(significant(25.13), "25.130");
  EXPECT_EQ(significant(0.2), "0.20000");
  EXPECT_EQ(significant(1.2e-7, 2), "1.2e-07");
  EXPECT_EQ(significant(0.0), "0");
}

TEST(NumberText, HasItsSignWhereThatIsAsked) {
  EXPECT_EQ(signed_significant(25.13), "+25.130");
  EXPECT_EQ(signed_significant(-0.2, 2), "−0.20");
  EXPECT_EQ(signed_significant(0.0), "0");
}

TEST(NumberText, OfRoughPercentsHasTwoDigits) {
  EXPECT_EQ(rough_percent(0.000311), "0.031 %");
  EXPECT_EQ(rough_percent(0.05), "5 %");
  EXPECT_EQ(rough_percent(0.996), "100 %");
  EXPECT_EQ(rough_percent(2.347), "235 %");
}

TEST(NumberText, OfRatiosSaysWhereTheyTellNothing) {
  EXPECT_EQ(times_as_large(1.9666), "1.97 times as large");
  EXPECT_EQ(times_as_large(0.5), "0.5 times as large");
  EXPECT_EQ(times_as_large(1e4), "larger by far");
  EXPECT_EQ(times_as_large(1.0 / 0.0), "larger by far");
  EXPECT_EQ(times_as_large(-3.0), "of the other sign");
}

}  // namespace
}  // namespace pleuel::test::number_text_test
