#pragma once

#include <memory>

#include "core/model/model.hpp"
#include "core/response/signal.hpp"

namespace pleuel {

/// Φ(q, t) or dΦ/dt of every equation of joints and drives, a channel each, as the joints state it:
/// [m], [rad], or the cosine between directions that shall stay normal; rates of it per second.
/// Equations that are left out as redundant are there, too.
/// @param model  with constraints; must outlive the signal
std::unique_ptr<Signal> make_drift_signal(const Model& model, DriftLevel level);

}  // namespace pleuel
