#include <array>
#include <limits>
#include <optional>
#include <variant>

#include "core/base/eager_matrices.hpp"
#include "core/base/number_text.hpp"
#include "core/base/packed.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::texts_test {
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

enum class Colour { red, green };

struct Thing {
  std::string name;
  std::vector<std::optional<double>> numbers;
  Eigen::VectorXd vector;
  Eigen::MatrixXd matrix;
  std::map<std::pair<std::string, int>, Colour> colours;
  bool is_new = false;

  bool operator==(const Thing&) const = default;
};

TEST(Packed, ValuesComeBackBitByBit) {
  const Thing thing{"a\0b\n",
                    {0.1, std::nullopt, -0.0, 5e-324},
                    Eigen::Vector3d(1.0 / 3.0, std::numeric_limits<double>::infinity(), 1e308),
                    Eigen::MatrixXd::Random(2, 5),
                    {{{"rod", 3}, Colour::green}, {{"", 0}, Colour::red}},
                    true};
  const Thing same = unpacked<Thing>(packed(thing));
  EXPECT_EQ(same, thing);
  EXPECT_TRUE(std::signbit(*same.numbers[2]));
}

TEST(Packed, EmptyMatricesKeepTheirShape) {
  const Eigen::MatrixXd wide(0, 4);
  const auto same = unpacked<Eigen::MatrixXd>(packed(wide));
  EXPECT_EQ(same.rows(), 0);
  EXPECT_EQ(same.cols(), 4);
}

TEST(Packed, SizesBeyondTheBytesTakeNoMemory) {
  const std::uint64_t huge = std::uint64_t{1} << 60;
  const std::string size(reinterpret_cast<const char*>(&huge), sizeof huge);
  EXPECT_THROW(unpacked<std::string>(size), std::runtime_error);
  EXPECT_THROW(unpacked<Eigen::MatrixXd>(size + size), std::runtime_error);
  EXPECT_THROW(unpacked<Eigen::MatrixXd>(packed(std::uint64_t{1}) + size), std::runtime_error);
  EXPECT_THROW(unpacked<std::vector<double>>(size), std::runtime_error);
}

TEST(Packed, BytesThatEndTooEarlyAreAnError) {
  const std::string bytes = packed(std::string("words"), 1.0);
  std::string text;
  double number = 0.0;
  EXPECT_THROW(unpack(bytes.substr(0, bytes.size() - 1), text, number), std::runtime_error);
}

struct One {
  double number;
};
struct Mixed {
  std::string text = {};
  std::array<double, 3> place = {};
  std::vector<One> ones = {};
  std::variant<int, std::string> either = {};
  std::optional<One> perhaps = {};
  const char* last = "last";
};
struct Largest {
  int a1, a2, a3, a4, a5, a6, a7, a8, a9, a10, a11, a12, a13;
  int b1, b2, b3, b4, b5, b6, b7, b8, b9, b10, b11, b12, b13;
};

TEST(Members, AreCounted) {
  EXPECT_EQ(member_count<One>, 1u);
  EXPECT_EQ(member_count<Mixed>, 6u);
  EXPECT_EQ(member_count<Largest>, most_members);
}

TEST(Members, ComeInTheirOrder) {
  Largest largest{};
  int next = 0;
  with_members(largest, [&](auto&... members) { ((members = ++next), ...); });
  EXPECT_EQ(next, 26);
  EXPECT_EQ(largest.a1, 1);
  EXPECT_EQ(largest.a13, 13);
  EXPECT_EQ(largest.b13, 26);
}

TEST(Members, OfAConstantStructAreConstant) {
  const Mixed mixed{};
  const bool are_constant = with_members(
      mixed, []<class... Members>(Members&...) { return (std::is_const_v<Members> && ...); });
  EXPECT_TRUE(are_constant);
}

}  // namespace
}  // namespace pleuel::test::texts_test
