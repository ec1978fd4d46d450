#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/model/body_energy.hpp"
#include "core/model/model.hpp"
#include "core/response/signal.hpp"

/// Energy of bodies (core/model/body_energy.hpp) [J]. The model must outlive the signals.
namespace pleuel {

/// Of these bodies, or of all if none is named.
std::unique_ptr<Signal> make_kinetic_energy_signal(const Model& model,
                                                   const std::vector<std::string>& bodies);

/// The same of ½ q_fᵀ K q_f and what geometric stiffening adds to it: the energy of the strain.
std::unique_ptr<Signal> make_elastic_energy_signal(const Model& model,
                                                   const std::vector<std::string>& bodies);

/// What the balance of energy is made from, two channels: the energy E of all bodies [J] without
/// what geometric stiffening stores, and the power into them [W] of all else: stiffening, joints
/// and drives, loads, springs and dampers, damping.
std::unique_ptr<Signal> make_energy_and_power_signal(const Model& model);

/// Φ(q, t) or dΦ/dt of every equation of joints and drives, a channel each, as the joints state it:
/// [m], [rad], or the cosine between directions that shall stay normal; rates of it per second.
/// Equations that are left out as redundant are there, too.
/// @param model  with constraints; must outlive the signal
std::unique_ptr<Signal> make_drift_signal(const Model& model, DriftLevel level);

}  // namespace pleuel
