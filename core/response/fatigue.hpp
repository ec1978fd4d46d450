#pragma once

/// Utilization of a material by a cycle of stress: Budynas & Nisbett, Shigley's Mechanical
/// Engineering Design, 10th ed. 2015, section 6-12.

#include <cstddef>
#include <vector>

#include "core/integration/trajectory.hpp"
#include "core/response/reduction.hpp"

namespace pleuel {

/// What a cycle of stress uses of a material, or adds to its damage.
struct CycleValue {
  double value = 0.0;
  double by_amplitude = 0.0, by_mean = 0.0;  ///< derivatives
};

/// u = 1/n: the load could be n times as large before the line of the criterion is reached. Of the
/// amplitude a = σ_a/S_e (S_e: endurance limit) and the mean m = σ_m/S:
///     Goodman    n σ_a/S_e + n σ_m/S_u = 1        u = a + m,   S = S_u: ultimate strength
///     Soderberg  n σ_a/S_e + n σ_m/S_y = 1        u = a + m,   S = S_y: yield strength
///     Gerber     n σ_a/S_e + (n σ_m/S_u)² = 1     u = (a + √(a² + 4m²))/2,   S = S_u
/// Compressive mean stress neither harms nor helps: u = a for m < 0. There Goodman's and
/// Soderberg's line has a kink.
/// @param amplitude, mean  a ≥ 0, m
CycleValue cycle_use(FatigueCriterion criterion, double amplitude, double mean);

/// The largest utilization of many points, each by the one cycle between its largest and its
/// smallest stress in a range of time: σ_a = (max − min)/2, σ_m = (max + min)/2. Extrema lie
/// between samples as in reduce(); their derivatives are those at their instants (envelope theorem).
/// Ties: other points, other instants of a maximum or minimum, the kink at zero mean.
/// @param values  two rows a point, one after the other: σ/S_e and σ/S; × (steps + 1)
Reduction reduce_cycle(FatigueCriterion criterion, const Eigen::VectorXd& time,
                       const Eigen::MatrixXd& values, const StepRange& range,
                       const BrokenInstants& breaks = {});

/// What is before and after a range of time.
enum class RangeEnds { cut, repeating };

/// The largest damage of many points, each by all of its cycles in a range of time:
///     D = Σ n/N     (Palmgren & Miner),   n = 1 or ½ by rainflow counting
///     N = ½ (σ_f'/σ_ar)^k                 Basquin's line
///     σ_ar = σ_a/(1 − σ_m/S)              Goodman, Soderberg
///     σ_ar = σ_a/(1 − (σ_m/S)²)           Gerber;   σ_ar = σ_a for σ_m < 0
/// with S = S_u, of Soderberg S_y. A part of a cycle that the range cuts off counts as half of one. A
/// range that repeats itself is counted from its largest stress to the same a turn later (ASTM E1049,
/// 5.4.5): all cycles are whole, wherever it begins.
/// Gradients are those of the turning points at their instants with the pairs as they are: where
/// two ranges are equal they change partners, and the gradient jumps (D does not).
/// @param values  two rows a point, one after the other: σ/σ_f' and σ/S; × (steps + 1)
/// @param exponent  k
/// @param ends      repeating: the last instant is the first of the next turn
/// @returns a value that is not finite where a mean stress reaches S
Reduction reduce_damage(FatigueCriterion criterion, double exponent, const Eigen::VectorXd& time,
                        const Eigen::MatrixXd& values, const StepRange& range,
                        const BrokenInstants& breaks = {}, RangeEnds ends = RangeEnds::cut);

/// Whether a range is a whole number of periods of a motion that repeats itself.
RangeEnds ends_of(const StepRange& range, const Trajectory& trajectory);

/// A cycle, or half of one, between two turning points of a history.
struct CountedCycle {
  std::size_t from, to;  ///< indices of turning points
  double count;          ///< 1 or ½
};

/// Rainflow counting of ASTM E1049-85 (2017), 5.4.4, in the order in which cycles close.
/// @param turning  maxima and minima in turn, the first and the last value among them
std::vector<CountedCycle> count_rainflow(const std::vector<double>& turning);

}  // namespace pleuel
