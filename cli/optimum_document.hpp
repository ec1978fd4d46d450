#pragma once

#include "cli/json.hpp"
#include "cli/optimum.hpp"

namespace pleuel {

/// The document of `optimize`; see docs/formats.md.
Json optimum_document(const Optimum& optimum);

}  // namespace pleuel
