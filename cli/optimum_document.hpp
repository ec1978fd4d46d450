#pragma once

#include "cli/json.hpp"
#include "cli/optimum.hpp"

namespace pleuel {

/// The document of `optimize`; see docs/reference/commands.md.
Json optimum_document(const Optimum& optimum);

}  // namespace pleuel
