#pragma once

#include <optional>

#include "core/base/error_bar.hpp"
#include "core/response/analysis.hpp"
#include "core/trust/nested_runs.hpp"

/// How far the responses of a simulation may be from those of an arbitrarily fine one.
namespace pleuel {

/// The order in the step that a scheme has: 2, or 1 of those that damp by their truncation error.
int scheme_order(const SimulationSettings& settings);

/// What refinement by two says of the finest of three values, v(h), v(2h), v(4h).
struct Extrapolation {
  ErrorPart part;
  std::optional<double> order;  ///< log₂ of the ratio of the differences, if both have one sign
};

/// Richardson's estimate (v(h) − v(2h)) / (2ᵖ − 1) where the observed order is p ± 0.5. Elsewhere
/// the larger difference is the bound, as where a peak rings, or two of them change places: the
/// difference of two runs may be small by accident then.
/// @param order  p that is promised
/// @param local  |y(h) − y(2h)| of the history where the value comes from: peaks can agree by
///               accident
/// @param small  differences below this need no order: they are resolved for what they are
Extrapolation extrapolate(double fine, double middle, double coarse, double order, double local,
                          double small);

/// Two runs that differ in one thing.
struct Comparison {
  const NestedRun* run = nullptr;  ///< null: not made
  const NestedRun* beside = nullptr;

  bool is_asked() const { return run != nullptr; }
};

/// Runs that judge a simulation; those that are null were not made.
struct JudgingRuns {
  const NestedRun* quarter_step = nullptr;  ///< beside half_step only
  const NestedRun* half_step = nullptr;
  const NestedRun* twice_step = nullptr;
  const NestedRun* four_steps = nullptr;
  Comparison elements;          ///< with other elements
  double element_factor = 0.5;  ///< so many times as many
  Comparison modes;             ///< with more modes
  Comparison newton;            ///< with a smaller tolerance of Newton's method
};

/// The bar of one response. Where a run is missing or failed, what it would tell is not resolved.
/// @param order  of the scheme
ErrorBar error_bar(const Analysis& analysis, std::size_t response, const JudgingRuns& runs,
                   double order);

}  // namespace pleuel
