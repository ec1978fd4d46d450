#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace pleuel {

/// Keys in the order in which they are written.
using Json = nlohmann::ordered_json;

/// An indented document that ends with a newline; numbers read back exactly.
std::string to_text(const Json& document);

}  // namespace pleuel
