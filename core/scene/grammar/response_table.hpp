#pragma once

#include "core/scene/grammar/response_keys.hpp"

/// The tables of keys of responses.
namespace pleuel {

/// By its kind. The coordinate of a joint and the formula of an expression are named here and read
/// elsewhere (reading/response_reader.cpp).
void describe(Keys& keys, ResponseSettings& response, const ResponseScope& scope);

}  // namespace pleuel
