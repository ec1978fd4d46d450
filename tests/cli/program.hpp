#pragma once

#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/files.hpp"
#include "tests/support/test.hpp"

/// The built program as a subprocess, in a folder of its own.

namespace pleuel::test {

using nlohmann::json;

/// What a run of the program left.
struct ProgramRun {
  int exit_code = -1;
  std::string out, err;

  /// Standard output as one JSON document; a test failure otherwise.
  json document() const;
};

/// Runs `pleuel LINE` in a shell with this folder as the current one. In the line stand
///   $crank     for the usual problem, the round slider-crank
///   $problems  for the folder of the problem files of the repository
///   $quick     for overrides that make a simulation of slider-cranks take some milliseconds: coarse
///              steps, and the ramp only; with the most robust of the backends
///   $pleuel    for the program, where the shell shall run it once more
ProgramRun run_line(const std::filesystem::path& folder, const std::string& line);

/// Of the shell: goes on as soon as a condition holds, or after half a minute.
std::string wait_until(const std::string& condition);

/// A folder of its own, for runs of the program.
class ProgramFolder : public TemporaryFolder {
 public:
  std::filesystem::path operator/(const std::string& name) const { return path() / name; }

  /// A run of a line; a test failure if it ends with another code.
  ProgramRun run(const std::string& line, int exit_code = 0) const;
  /// The document that it writes because of --json.
  json document(const std::string& line, int exit_code = 0) const;
  /// What it says of bad input, in one line.
  std::string refusal(const std::string& line) const;

  std::string text(const std::string& name) const;
  json read(const std::string& name) const { return json::parse(text(name)); }
  /// The document that a run left in a folder of this one.
  json result(const std::string& name = "run") const { return read(name + "/result.json"); }
  CsvRows csv(const std::string& name) const { return parse_csv(text(name)); }
  bool has(const std::string& name) const { return std::filesystem::exists(*this / name); }

  template <class Content>
  void write(const std::string& name, const Content& content) const {
    std::ofstream(*this / name) << content;
  }
};

/// Tests of runs in a folder of their own.
class InProgramFolder : public testing::Test {
 protected:
  ProgramRun run(const std::string& line, int exit_code = 0) const {
    return folder_.run(line, exit_code);
  }
  json document(const std::string& line, int exit_code = 0) const {
    return folder_.document(line, exit_code);
  }
  std::string refusal(const std::string& line) const { return folder_.refusal(line); }
  json result(const std::string& name = "run") const { return folder_.result(name); }

  const ProgramFolder folder_{};
};

/// A problem file of the repository, and what stands in it.
std::string problem(const std::string& name);
json read_problem(const std::string& name);

/// The text with every run of spaces and line breaks as one space: sentences are broken into lines.
std::string unwrapped(const std::string& text);

std::string read_file(const std::filesystem::path& path);
json read_json(const std::filesystem::path& path);

/// What stands at a path of a document, as "responses/rod_bow/value".
json at(const json& document, const std::string& path);
double number(const json& document, const std::string& path);
/// The overrides of a setting as options.
std::string overrides_of(const json& setting);
/// The entry of a list that has this name. @throws std::runtime_error if there is none
json named(const json& list, const std::string& name);

/// The cells below a title; a test failure if there is none.
std::vector<std::string> column(const CsvRows& rows, const std::string& title);
/// The same as numbers; empty cells are NaN.
std::vector<double> numbers(const CsvRows& rows, const std::string& title);

/// Evaluations in the record of a run.
int count_evaluations(const std::filesystem::path& folder);

/// Runs in one folder that should have come to the same.
class ComparedRuns : public InProgramFolder {
 protected:
  /// But for times, which differ from run to run.
  json timeless_result(const std::string& name) const;

  /// The same result, the same table, and as many evaluations.
  void expect_same(const std::string& name, const std::string& other,
                   const std::string& file) const;

  /// Kills a command so many times after other times, and lets it end then.
  void kill_and_end(const std::string& line, const std::string& name, int kills, unsigned seed,
                    int exit_code = 0) const;
};

}  // namespace pleuel::test
