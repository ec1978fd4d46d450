#include <filesystem>

#include <gtest/gtest.h>

#include "core/scene/problem_reader.hpp"
#include "tests/support/source_folder.hpp"

namespace pleuel::test::files_test {
namespace {

TEST(HardFiles, AreReadAndSayWhyTheyAreHard) {
  const std::filesystem::path folder = std::filesystem::path(source_folder()) / "problems" / "hard";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    EXPECT_GE(read_problem(entry.path()).complete().description.size(), 80U) << entry.path();
  }
}

}  // namespace
}  // namespace pleuel::test::files_test
