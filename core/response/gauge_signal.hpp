#pragma once

#include <memory>

#include "core/model/model.hpp"
#include "core/response/signal.hpp"

namespace pleuel {

/// Position and velocity of a joint, length and pull of a spring, power of a motor: what a gauge of
/// the model reads (core/system/gauge.hpp).
/// @throws InputError where the model has no such gauge
std::unique_ptr<Signal> make_gauge_signal(const ResponseSettings& settings, const Model& model);

}  // namespace pleuel
