#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "cli/text/json.hpp"

namespace pleuel {

inline constexpr const char* card_name = "run_card.json";

/// The JSON object in a file; null if there is none that can be read.
Json document_in(const std::filesystem::path& file);

/// What the folder of a run says of it.
struct OlderRun {
  std::filesystem::path folder;
  Json card;
  Json result;  ///< null: there is none

  std::string command() const { return card.value("command", ""); }
  /// Name of the problem; of several files, how many.
  std::string problem() const;
  /// "verified", "done" …: that of the result; or "running", "killed".
  std::string status() const;
  /// Of the result, [SI]; none where it has no objective.
  std::optional<double> objective() const;
  /// "kg"; empty likewise.
  std::string objective_unit() const;
  std::optional<double> seconds() const;  ///< wall time of the whole run
  /// Local time at which its card was written last: "2025-03-01 17:04".
  std::string date() const;
  /// The same instant, to put runs in order by.
  std::filesystem::file_time_type written() const;
};

/// @returns nothing if the folder is not that of a run
std::optional<OlderRun> find_older_run(const std::filesystem::path& folder);

/// @throws InputError if the folder is not that of a run
OlderRun read_older_run(const std::filesystem::path& folder);

}  // namespace pleuel
