#pragma once

#include "cli/reports/optimum.hpp"
#include "cli/text/json.hpp"

namespace pleuel {

/// The document of `optimize`; see docs/reference/commands.md.
Json optimum_document(const Optimum& optimum);

}  // namespace pleuel
