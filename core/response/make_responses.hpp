#pragma once

#include <vector>

#include "core/model/model.hpp"
#include "core/response/response.hpp"

namespace pleuel {

/// Builds the responses of a model, which must outlive them.
/// @throws InputError where the model has not what a response needs
std::vector<Response> make_responses(const std::vector<ResponseSettings>& settings,
                                     const Model& model);

/// The same with the natural frequencies of bodies from another model, that with all their modes.
std::vector<Response> make_responses(const std::vector<ResponseSettings>& settings,
                                     const Model& model, const Model& with_all_modes);

}  // namespace pleuel
