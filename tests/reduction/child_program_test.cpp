#include "core/jobs/child_program.hpp"

#include <chrono>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.hpp"

namespace pleuel::test::child_program_test {
namespace {

using testing::HasSubstr;

std::string shell(const std::string& script, double limit = 0.0) {
  return output_of({{"sh", "-c", script}, {}, limit}, "two\nlines\n");
}

std::string failure_of(const ChildProgram& program) {
  try {
    output_of(program, "");
  } catch (const SimulationError& error) {
    return error.what();
  }
  return "";
}

TEST(ChildProgram, GetsItsInputAndGivesItsOutput) {
  EXPECT_EQ(shell("cat; echo unheard >&2"), "two\nlines\n");
}

/// More than any pipe holds, both ways.
TEST(ChildProgram, MayWriteMoreThanAPipeHolds) {
  EXPECT_EQ(shell("head -c 3000000 /dev/zero").size(), 3000000u);
}

TEST(ChildProgram, FailsWithItsCodeAndItsLastWords) {
  EXPECT_THAT(failure_of({{"sh", "-c", "echo no mesh >&2; exit 3"}, {}, 0.0}),
              testing::AllOf(HasSubstr("exit code 3"), HasSubstr("no mesh")));
  EXPECT_THAT(failure_of({{"pleuel-has-no-such-program"}, {}, 0.0}), HasSubstr("in PATH"));
  EXPECT_THAT(failure_of({{"sh", "-c", "kill -9 $$"}, {}, 0.0}), HasSubstr("signal 9"));
}

/// It ends with all that it started.
TEST(ChildProgram, IsEndedAtItsTimeLimit) {
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_THAT(failure_of({{"sh", "-c", "sleep 60 & wait"}, {}, 0.2}), HasSubstr("limit of 0.2 s"));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
}

}  // namespace
}  // namespace pleuel::test::child_program_test
