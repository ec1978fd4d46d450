#include "core/trust/energy_balance.hpp"

#include <fmt/format.h>

#include "core/trust/percent.hpp"

namespace pleuel {

namespace {

/// Share of the energy in motion. Errors of order h² are a few times larger in peaks than in
/// energy.
constexpr double small_energy_error = 1e-2;
/// Where so much is missing, vibrations are not seen that the motion has.
constexpr double large_energy_error = 0.1;

}  // namespace

std::vector<Doubt> doubt_energy_balance(const TrustedRun& run) {
  const double error = run.monitors.energy_error;
  if (error <= small_energy_error) return {};
  return {{fmt::format("energy is balanced to {} % of the largest in the motion only: steps are "
                       "too long for what moves here, or a drive jumps. Compare with a smaller "
                       "/simulation/step.",
                       percent(error)),
           error > large_energy_error}};
}

}  // namespace pleuel
