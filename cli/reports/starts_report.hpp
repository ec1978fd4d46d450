#pragma once

#include <string>

#include "cli/text/json.hpp"
#include "optimization/design/multi_start.hpp"

namespace pleuel {

/// The local optima that were found from several starts, and how often; empty for one start.
std::string starts_text(const ProblemFile& problem, const MultiStart& all);

/// {"optima": [{"objective", "found", "variables"}], "runs": [{"start", "status", …}]}
Json starts_document(const ProblemFile& problem, const MultiStart& all);

}  // namespace pleuel
