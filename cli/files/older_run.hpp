#pragma once

#include "cli/input/arguments.hpp"
#include "cli/text/json.hpp"
#include "core/scene/problem_file.hpp"

namespace pleuel {

inline constexpr const char* card_name = "run_card.json";

/// What the folder of a run says of it.
struct OlderRun {
  fs::path folder;
  Json card;
  Json result;  ///< null: there is none

  std::string command() const { return card.value("command", ""); }
  /// Name of the problem; of several files, how many.
  std::string problem() const;
  /// "verified", "done" …: that of the result; or "running", "killed", "damaged".
  std::string status() const;
  /// The load case whose mechanism a page shows first; empty without cases.
  std::string shown_case() const;
  /// Of the result, [SI]; none where it has no objective.
  std::optional<double> objective() const;
  /// "kg"; empty likewise.
  std::string objective_unit() const;
  std::optional<double> seconds() const;  ///< wall time of the whole run
  /// Local time at which its card was written last: "2025-03-01 17:04".
  std::string date() const;
  /// The same instant, to put runs in order by.
  fs::file_time_type written() const;
};

/// {"folder", "command", "problem", "status"}
Json summary_of(const OlderRun& run);

/// What is missing in its documents that a run has written; empty: nothing.
std::string damage_of(const OlderRun& run);

/// @returns nothing if the folder is not that of a run
std::optional<OlderRun> find_older_run(const fs::path& folder);

/// @throws InputError if the folder is not that of a run
OlderRun read_older_run(const fs::path& folder);

// What an earlier run simulated, from its documents.

/// The problem of the run card in a folder, for units and limits. None where it cannot be read any more, as
/// where its catalogue is gone.
std::optional<ProblemFile> problem_on_card(const fs::path& folder);

/// The problem as it ran: with the steps and elements that were chosen for an accuracy, and the
/// effects that were built at the end.
ProblemFile problem_of(const OlderRun& run);

/// The same of one of its load cases; of all if it is empty.
ProblemFile problem_of(const OlderRun& run, const std::string& load_case);

/// The values of a document's variables; nothing if it does not have all of them.
/// @param key  of {NAME: {key: number}}; empty for {NAME: number}
std::optional<Eigen::VectorXd> design_in(const Json& document, const ProblemFile& problem,
                                         const std::string& key);

}  // namespace pleuel
