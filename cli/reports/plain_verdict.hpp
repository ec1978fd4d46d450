#pragma once

#include <string>

#include "cli/reports/optimum.hpp"

namespace pleuel {

/// What was checked of a verified answer, in words that need no theory: "every limit holds; no
/// design nearby is lighter; …". Empty of other answers, whose message says what is missing.
std::string plain_verdict(const Optimum& optimum);

/// "no design nearby that keeps them is lighter"; of sizes out of lists, what was tried of them.
std::string neighbours_text(const Optimum& optimum);

}  // namespace pleuel
