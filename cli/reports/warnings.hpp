#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/scene/problem_file.hpp"

/// What speaks against numbers, as people read it.
namespace pleuel {

/// "Warning: …" of each, in lines of their own.
/// @param consequences  so many of the last ones are only counted
std::string warnings_text(const std::vector<std::string>& warnings, int consequences = 0);

/// Those that are known before a long run, on standard error.
void show_warnings_before(const ProblemFile& problem);

/// Sentences that several runs have in common, each with those that it concerns.
class SharedWarnings {
 public:
  void add(const std::vector<std::string>& warnings, const std::string& whose);

  /// "the sentence (one, another)"
  std::vector<std::string> sentences() const;

 private:
  std::vector<std::pair<std::string, std::string>> warnings_;  ///< and whose they are
};

/// Adds the sentences that are not there yet.
void add_new(std::vector<std::string>& warnings, const std::vector<std::string>& more);

}  // namespace pleuel
