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
/// and where the time went. The card is there from the beginning; a killed run leaves one that says
/// "finished": false.
class RunRecord {
 public:
  /// Makes the folder. Results of an older run in it are removed.
  /// @param options  effective options of the command, for the card
  /// @throws InputError if the folder holds something else than a run
  RunRecord(const Arguments& arguments, const ProblemInput& input, Json options);

  /// The same for a command that takes several files.
  RunRecord(const Arguments& arguments, const std::vector<ProblemInput>& inputs, Json options);

  const std::filesystem::path& folder() const { return folder_; }

  /// Ends the phase before and begins another, for the wall times of the card.
  void begin_phase(const std::string& name);

  /// Writes a document into the folder, in place of an earlier one of this name.
  void write(const std::string& name, const Json& document) const;

  /// Writes result.json and the last card.
  void finish(const Outcome& outcome);

 private:
  RunRecord(const Arguments& arguments, Json options);
  void end_phase();
  void write_card();

  std::filesystem::path folder_;
  Json card_;
  Json phases_ = Json::object();
  std::string phase_;
  std::chrono::steady_clock::time_point begin_, phase_begin_;
};

}  // namespace pleuel
