#pragma once

#include <cstddef>
#include <utility>

#include "cli/text/json.hpp"
#include "core/base/error_bar.hpp"
#include "core/scene/shown_unit.hpp"

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
  Json all_ = Json::object();  ///< {WARNING: [whose]}
};

/// Adds the sentences that are not there yet.
void add_new(std::vector<std::string>& warnings, const std::vector<std::string>& more);

// Error bars as commands show them.

using ErrorBars = std::vector<std::optional<ErrorBar>>;

/// The bar of a response, if it has one.
inline std::optional<ErrorBar> error_of(const ErrorBars& errors, std::size_t response) {
  return response < errors.size() ? errors[response] : std::nullopt;
}

/// {"total", "step", "elements", "newton", "effects", "change", "order"} [SI]; null where the runs
/// do not agree, and for the whole where nothing is known.
Json error_document(const std::optional<ErrorBar>& bar);

/// "± 0.0012", "not resolved", "–".
/// @param error  of error_document()
std::string error_text(const Json& error, const ShownUnit& unit);

/// "known to ± 0.00012 kg (0.04 %): step 0.0001, elements 2e-05", its largest parts.
std::string error_sentence(const ErrorBar& bar, double value, const ShownUnit& unit);

}  // namespace pleuel
