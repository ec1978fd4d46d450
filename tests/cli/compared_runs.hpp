#pragma once

#include <filesystem>
#include <random>

#include <nlohmann/json.hpp>

#include "tests/cli/program.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test {

/// The overrides of quick(), for a line of the shell.
std::string quick_line();

/// A command for the usual mechanism, with these.
std::string quick_run(const std::string& command);

/// Evaluations in the record of a run.
int count_evaluations(const std::filesystem::path& folder);

/// Runs in one folder that should have come to the same.
class ComparedRuns : public testing::Test {
 protected:
  /// But for times, which differ from run to run.
  nlohmann::json result(const std::string& name) const;
  CsvRows table(const std::string& name, const std::string& file) const;

  /// The same result, the same table, and as many evaluations.
  void expect_same(const std::string& name, const std::string& other,
                   const std::string& file) const;

  /// Kills a command so many times after other times, and lets it end then.
  void kill_and_end(const std::string& words, const std::string& name, int kills,
                    std::mt19937& random, int exit_code = 0) const;

  const ProgramFolder folder_;
};

}  // namespace pleuel::test
