#pragma once

#include <optional>
#include <vector>

#include "core/base/error_bar.hpp"
#include "core/response/analysis.hpp"
#include "core/trust/refined_runs.hpp"

/// How far the responses of a simulation may be from those of an arbitrarily fine one.
namespace pleuel {

/// What estimates of what is missing are multiplied with, the same for bars, bands and the choice of a
/// setting: how often bars hold with these, tests/honesty measures (docs/accuracy.md).
namespace safety {
/// How far the observed order may be from the promised one.
inline constexpr double order_room = 0.5;
/// On estimates of the promised order, for the terms of higher order and for orders that are seen
/// by accident; less where a run with a smaller step has seen most of the error already.
inline constexpr double of_order = 2.0, of_seen = 1.5;
/// On differences without an order, and on those that fall by two at least: no more is left then.
inline constexpr double of_difference = 2.0, of_falling = 1.0;
/// On differences by twice and by half the elements, of which 4/3 and 1/3 are missing in order two (2 and
/// 1 in order one, for which both grow alike).
/// Bending has a higher one; stress, and what is asked of a place that is a node of one division only,
/// has an uneven one: all of a difference by fewer elements may be missing.
inline constexpr double of_more = 2.0, of_fewer = 1.0;
/// On differences by more modes, and by a smaller tolerance of Newton's method.
inline constexpr double of_modes = 1.5, of_newton = 1.5;
}  // namespace safety

/// The order in the step that a scheme has: 2, or 1 of those that damp by their truncation error.
int scheme_order(const SimulationSettings& settings);

/// The order in the length of elements: 1 of shear forces and of what is made from them, as tension
/// between nodes changes them at first order; else 2.
double element_order(const ProblemFile& problem, std::size_t response);

/// Whether an order that is seen is the promised one, to what steps of these sizes leave open.
bool is_near_order(const std::optional<double>& seen, double promised);

/// What refinement by two says of the finest of three values, v(h), v(2h), v(4h).
struct Extrapolation {
  ErrorPart part;
  std::optional<double> order;  ///< log₂ of the ratio of the differences, if both have one sign
  bool has_promised_order = false;
};

/// Richardson's estimate (v(h) − v(2h)) / (2ᵖ − 1) where the observed order is p ± 0.5. Elsewhere,
/// as where a peak rings, or two of them change places, the bound is the larger one of
/// v(h) − v(2h) and of what v(2h) − v(4h) promises of it, (v(2h) − v(4h)) / 2ᵖ: the difference of
/// two runs may be small by accident. How much is put on top was found in tests/honesty.
/// @param order  p that is promised
/// @param local  |y(h) − y(2h)| of the history where the value comes from: peaks can agree by
///               accident
/// @param small  bounds up to this need no order: they are resolved for what they are
Extrapolation extrapolate(double fine, double middle, double coarse, double order, double local,
                          double small);

/// Two runs that differ in one thing.
struct Comparison {
  const RefinedRun* run = nullptr;  ///< null: not made
  const RefinedRun* beside = nullptr;

  bool is_asked() const { return run != nullptr; }
};

/// Runs that judge a simulation; those that are null were not made.
struct JudgingRuns {
  const RefinedRun* quarter_step = nullptr;  ///< beside half_step only
  const RefinedRun* half_step = nullptr;
  const RefinedRun* twice_step = nullptr;
  const RefinedRun* four_steps = nullptr;
  Comparison more_elements;   ///< with twice the elements
  Comparison fewer_elements;  ///< with half the elements
  Comparison modes;           ///< with more modes
  Comparison newton;          ///< with a smaller tolerance of Newton's method
};

/// What runs say of one value. Numbers are absent where no run was made, and NaN where it failed.
struct Evidence {
  double order = 2.0;          ///< of the scheme
  double element_order = 2.0;  ///< element_order()
  double value = 0.0;          ///< of the simulation that is judged
  double magnitude = 0.0;      ///< what errors are small beside
  double local = 0.0;          ///< of extrapolate()
  std::optional<double> quarter_step, half_step, twice_step, four_steps;  ///< values of these runs
  /// Differences of both runs of a comparison.
  std::optional<double> more_elements, fewer_elements, modes, newton;

  /// Adds `factor` times the value of another response of the same runs: the evidence of a sum.
  /// The magnitude stays.
  void add(const Evidence& other, double factor);
};

/// @param order  of the scheme
Evidence evidence_of(const Analysis& analysis, std::size_t response, const JudgingRuns& runs,
                     double order);

/// What a bar says of the division of beams, and of the modes of reduced ones, beside each other.
ErrorPart element_part(const Evidence& evidence);
ErrorPart mode_part(const Evidence& evidence);

/// The bar of a value. Where a run is missing or failed, what it would tell is not resolved.
ErrorBar error_bar(const Evidence& evidence);

/// How far the shown history of each response (history_reduction.hpp) may be from that of arbitrarily
/// fine steps and elements, at each instant: error bars (error_bars.hpp) of histories. At an
/// instant of the run with twice the step the bound is what the runs differ by there, or at the
/// instants beside it (errors of a vibration pass through zero), times what is left by the order
/// that the histories as wholes show; differences by elements, modes and Newton's tolerance come on
/// top.
/// @returns one a response, half-widths at the instants of the simulation [SI]; empty for those
/// without a history, and where the run of twice the step failed
std::vector<Eigen::VectorXd> error_bands(const ProblemFile& problem, const Analysis& analysis,
                                         const JudgingRuns& runs, double order);

}  // namespace pleuel
