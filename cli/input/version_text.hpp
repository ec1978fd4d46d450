#pragma once

#include <string>

namespace pleuel {

/// "pleuel 0.1.0 (commit 0ce292e8, GNU 12.2.0, Release, -march=native)": what this program was made from, and how.
std::string version_text();

}  // namespace pleuel
