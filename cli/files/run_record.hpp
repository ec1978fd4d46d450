#pragma once

#include "cli/files/output_file.hpp"
#include "cli/files/run_folder.hpp"
#include "cli/input/problem_input.hpp"
#include "cli/reports/outcome.hpp"
#include "core/base/stopwatch.hpp"

namespace pleuel {

/// The run folder and its run_card.json: what ran, on what input, with which options and libraries,
/// and where the time went. Nothing is written before there is a result: input that fails leaves an
/// older run that shall be overwritten as it was. The first result takes its place, with a card
/// that says "finished": false until the run ends. What cannot be written ends no run: the outcome
/// says it.
class RunRecord {
 public:
  /// Makes the folder.
  /// @param options  effective options of the command, for the card
  /// @throws InputError if it cannot be had: see RunFolder
  RunRecord(const Arguments& arguments, const ProblemInput& input, Json options);

  /// The same for a command that takes several files.
  RunRecord(const Arguments& arguments, const std::vector<ProblemInput>& inputs, Json options);

  const fs::path& folder() const { return folder_.path(); }

  /// Of the program, its libraries and its compiler.
  const Json& versions() const { return card_.at("versions"); }

  /// Ends the phase before and begins another, for the wall times of the card.
  void begin_phase(const std::string& name);

  /// Where the result of this name is to be written; makes the folder of "folder/name".
  ResultFile result(const fs::path& name);

  /// Writes a document into the folder, in place of an earlier one of this name.
  void write(const std::string& name, const Json& document);

  /// Writes result.json, which tells its version.
  void write_result(const Json& document);

  /// What the report shows of the mechanism: see run_picture(). Makes it only if there will be a
  /// report.
  void show_picture(const std::function<Json()>& make_picture);

  /// Writes result.json, the last card and the report, with this picture if there is none yet, and
  /// tells the outcome which files were written, and which could not be.
  void finish(Outcome& outcome, const std::function<Json()>& make_picture = nullptr);

 private:
  RunRecord(const Arguments& arguments, Json options);
  void end_phase();
  std::string files_text() const;
  void write_report(Outcome& outcome);
  void replace_older_run();

  RunFolder folder_;
  std::vector<std::string> unwritten_;
  std::vector<fs::path> results_;  ///< names, in the order in which they were begun
  Json card_;
  Json phases_ = Json::object();
  Json picture_;
  std::string program_;
  bool makes_report_ = true;
  std::string phase_;
  bool has_results_ = false;
  Stopwatch total_, of_phase_;
};

}  // namespace pleuel
