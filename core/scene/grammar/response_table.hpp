#pragma once

#include "core/scene/grammar/response_keys.hpp"

/// The table of keys of each type of response.
namespace pleuel {

/// By its type. The coordinate of a joint and the formula of an expression are named here and read
/// elsewhere (reading/response_reader.cpp).
void describe(Keys& keys, ResponseSettings& response, const ResponseScope& scope);

}  // namespace pleuel
