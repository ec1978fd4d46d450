#pragma once

#include "core/scene/grammar/keys.hpp"
#include "core/scene/problem_file.hpp"

/// The table of keys of each type of response.
namespace pleuel {

/// What responses name, and the end of the simulation [s].
struct ResponseScope {
  const Scene& scene;
  double end_time = 0.0;
};

/// By its type. The coordinate of a joint and the formula of an expression are named here and read
/// elsewhere (reading/response_reader.cpp).
void describe(Keys& keys, ResponseSettings& response, const ResponseScope& scope);

}  // namespace pleuel
