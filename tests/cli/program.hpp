#pragma once

#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/files.hpp"
#include "tests/support/test.hpp"

/// The built program as a subprocess, in a folder of its own.

namespace pleuel::test {

/// What a run of the program left.
struct ProgramRun {
  int exit_code = -1;
  std::string out, err;

  /// Standard output as one JSON document; a test failure otherwise.
  nlohmann::json document() const;
};

/// A run; a test failure if it ended with another code.
inline ProgramRun exits(int code, ProgramRun run) {
  EXPECT_EQ(run.exit_code, code) << run.out << run.err;
  return run;
}

/// Runs `pleuel words…` with this folder as the current one.
ProgramRun run_program(const std::filesystem::path& folder, const std::vector<std::string>& words);

/// The same with the words as a line for the shell, and whatever it shall do afterwards.
ProgramRun run_line(const std::filesystem::path& folder, const std::string& line);

nlohmann::json read_json(const std::filesystem::path& path);

/// A folder of its own, for runs of the program.
class ProgramFolder : public TemporaryFolder {
 public:
  ProgramRun run(const std::vector<std::string>& words) const { return run_program(path(), words); }
  /// With the overrides of quick() behind the words.
  ProgramRun run_quick(const std::vector<std::string>& words) const;
  ProgramRun run_line(const std::string& line) const { return test::run_line(path(), line); }
  /// The document that a run left in a folder of this one.
  nlohmann::json result(const std::string& name) const {
    return read_json(path() / name / "result.json");
  }
};

/// Tests of runs in a folder of their own.
class InProgramFolder : public testing::Test {
 protected:
  const ProgramFolder folder_;
};

/// A problem file of the repository.
std::string problem(const std::string& name);

/// Overrides that make a simulation of the slider-crank problems take some milliseconds: coarse
/// steps, and the ramp only; with the most robust of the backends.
std::vector<std::string> quick();

std::vector<std::string> joined(std::vector<std::string> words,
                                const std::vector<std::string>& more);

/// The text with every run of spaces and line breaks as one space: sentences are broken into lines.
std::string unwrapped(const std::string& text);

std::string read_file(const std::filesystem::path& path);

/// The cells of a CSV file.
CsvRows read_csv(const std::filesystem::path& path);

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
