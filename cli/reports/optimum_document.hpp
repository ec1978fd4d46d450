#pragma once

#include "cli/text/json.hpp"
#include "cli/reports/optimum.hpp"

namespace pleuel {

/// The document of `optimize`; see docs/reference/commands.md.
Json optimum_document(const Optimum& optimum);

}  // namespace pleuel
