#pragma once

#include "core/response/reduction.hpp"

/// Utilization of a material by a cycle of stress: Budynas & Nisbett, Shigley's Mechanical
/// Engineering Design, 10th ed. 2015, section 6-12.
namespace pleuel {

/// u = 1/n: the load could be n times as large before the line of the criterion is reached.
struct CycleUse {
  double value = 0.0;
  double by_amplitude = 0.0, by_mean = 0.0;  ///< derivatives
};

/// Of the amplitude a = σ_a/S_e (S_e: endurance limit) and the mean m = σ_m/S:
///     Goodman    n σ_a/S_e + n σ_m/S_u = 1        u = a + m,   S = S_u: ultimate strength
///     Soderberg  n σ_a/S_e + n σ_m/S_y = 1        u = a + m,   S = S_y: yield strength
///     Gerber     n σ_a/S_e + (n σ_m/S_u)² = 1     u = (a + √(a² + 4m²))/2,   S = S_u
/// Compressive mean stress neither harms nor helps: u = a for m < 0. There Goodman's and
/// Soderberg's line has a kink.
/// @param amplitude, mean  a ≥ 0, m
CycleUse cycle_use(FatigueCriterion criterion, double amplitude, double mean);

/// The largest utilization of many points, each by the one cycle between its largest and its
/// smallest stress in a range of time: σ_a = (max − min)/2, σ_m = (max + min)/2. Extrema lie
/// between samples as in reduce(); their derivatives are those at their instants (envelope theorem).
/// Ties: other points, other instants of a maximum or minimum, the kink at zero mean.
/// @param values  two rows a point, one after the other: σ/S_e and σ/S; × (steps + 1)
Reduction reduce_cycle(FatigueCriterion criterion, const Eigen::VectorXd& time,
                       const Eigen::MatrixXd& values, const StepRange& range,
                       const BrokenInstants& breaks = {});

}  // namespace pleuel
