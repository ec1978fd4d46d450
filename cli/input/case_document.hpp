#pragma once

#include <string>

#include "cli/text/json.hpp"

namespace pleuel {

/// A problem file, with all overrides, as if it were written for one of its load cases only.
/// @throws InputError if there is no such case
Json document_in_case(const Json& document, const std::string& load_case, const std::string& file);

}  // namespace pleuel
