#pragma once

#include <memory>

#include "core/model/model.hpp"
#include "core/response/signal.hpp"
#include "core/scene/problem_file.hpp"

namespace pleuel {

/// What a response observes of its one body, in the generalized coordinates of the mechanism,
/// whether the body has those of its elements, of a basis, of a frame alone or of a file.
/// @param settings  stress, (lateral) buckling, deflection, position, velocity or acceleration
/// @param model     must outlive the signal
/// @throws InputError where the body has not what the response needs
std::unique_ptr<Signal> make_signal_of_body(const ResponseSettings& settings, const Model& model);

}  // namespace pleuel
