#include "core/base/members.hpp"

#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

namespace pleuel::test::members_test {
namespace {

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
}  // namespace pleuel::test::members_test
