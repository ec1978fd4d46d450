#pragma once

#include <string>

namespace pleuel {

/// What a command does, in one to three sentences, and an example of it: the end of its --help.
std::string help_text(const std::string& command);

}  // namespace pleuel
