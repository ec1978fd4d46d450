#pragma once

#include <random>

#include "core/model/model.hpp"

/// A state somewhere near the start, with all rates and multipliers: no law of a term or of a
/// signal needs a consistent one. Lengths are some 0.1 m, strains far beyond what is sensible.
inline pleuel::State random_state(const pleuel::Model& model, unsigned seed) {
  const pleuel::System& system = *model.mechanism.system;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  pleuel::State state(system.coordinates(), system.multipliers());
  state.time = 0.013;
  state.q = model.mechanism.guess.q;
  const auto disturb = [&](Eigen::Index first, Eigen::Index size, double q, double v, double a) {
    for (Eigen::Index i = first; i < first + size; ++i) {
      state.q(i) += q * uniform(random);
      state.v(i) += v * uniform(random);
      state.a(i) += a * uniform(random);
    }
  };
  for (const pleuel::BodyModel& body : model.bodies) {
    disturb(body.frame.offset, body.frame.size(), 0.2, 3.0, 30.0);
    disturb(body.elastic_offset(), body.elastic_size(), 5e-3, 0.3, 3.0);
  }
  for (double& lambda : state.lambda) lambda = 10.0 * uniform(random);
  return state;
}
