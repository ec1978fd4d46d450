#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "cli/arguments.hpp"
#include "cli/outcome.hpp"
#include "cli/problem_input.hpp"

namespace pleuel {

/// The run folder and its run_card.json: what ran, on what input, with which options and libraries,
/// and where the time went. Nothing is written before there is a result: input that fails leaves an
/// older run as it was. The first result takes its place, with a card that says "finished": false
/// until the run ends.
class RunRecord {
 public:
  /// Makes the folder.
  /// @param options  effective options of the command, for the card
  /// @throws InputError if the folder cannot be written or holds something else than a run of this
  ///         command
  RunRecord(const Arguments& arguments, const ProblemInput& input, Json options);

  /// The same for a command that takes several files.
  RunRecord(const Arguments& arguments, const std::vector<ProblemInput>& inputs, Json options);

  const std::filesystem::path& folder() const { return folder_; }

  /// Ends the phase before and begins another, for the wall times of the card.
  void begin_phase(const std::string& name);

  /// Where the result of this name is to be written.
  std::filesystem::path result(const std::string& name);

  /// Writes a document into the folder, in place of an earlier one of this name.
  void write(const std::string& name, const Json& document);

  /// Writes result.json and the last card.
  void finish(const Outcome& outcome);

 private:
  RunRecord(const Arguments& arguments, Json options);
  void end_phase();
  void replace_older_run();

  std::filesystem::path folder_;
  Json card_;
  Json phases_ = Json::object();
  std::string phase_;
  bool has_results_ = false;
  std::chrono::steady_clock::time_point begin_, phase_begin_;
};

}  // namespace pleuel
