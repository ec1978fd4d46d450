#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "cli/text/json.hpp"
#include "core/base/error_bar.hpp"
#include "core/scene/shown_unit.hpp"

/// Error bars as commands show them.
namespace pleuel {

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
