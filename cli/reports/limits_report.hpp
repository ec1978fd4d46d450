#pragma once

/// What simulate, gradient and check have in common to say of one simulated design.

/// How one simulated design stands to the limits of its problem, without the margins that
/// `deviations` ask for.

#include "cli/reports/document_table.hpp"
#include "cli/reports/warnings.hpp"
#include "core/response/analysis.hpp"
#include "core/response/monitors.hpp"
#include "sensitivity/kinks.hpp"
#include "studies/pareto.hpp"

namespace pleuel {

/// {NAME: {"value", "unit", "error", "peak"}} [SI]; without "error" where none are known, and
/// "peak" (time, place) of peaks over time only
Json responses_document(const ProblemFile& problem, const Analysis& analysis,
                        const ErrorBars& errors = {});

/// Of the mechanism as it is drawn; 0 if nothing in it moves [m].
double size_of(const Model& model);

/// The value of a response for people: 0 where it is round-off of its history (1e-14 of the largest
/// number in it), or a length that is round-off of the size of the mechanism.
double without_round_off(const Analysis& analysis, std::size_t response);

/// Table of values in engineering units.
std::string responses_text(const ProblemFile& problem, const Analysis& analysis,
                           const ErrorBars& errors = {});

/// {"position_drift", "velocity_drift", "energy_error", "elastic_rotation"} [SI]
Json monitors_document(const Monitors& monitors);

/// Sentences about constraints (if there are multipliers) and energy.
std::string monitors_text(const Monitors& monitors, int multipliers);

/// "4514 steps of 2.5e-05 s, 41 coordinates, 24 multipliers"
std::string size_text(const Analysis& analysis);

/// {"value", "limit", "side", "unit", "utilisation"} of the limit of a constraint that is nearer to its
/// value [SI]: how much of it is used, 1 = at the limit, where the ratio says something.
Json limit_entry(const ProblemFile& problem, const ConstraintSettings& constraint, double value);

/// The same with "kept".
Json limit_document(const ProblemFile& problem, const ConstraintSettings& constraint,
                    const Eigen::VectorXd& x, double value);

/// {NAME: {"value", "limit", "side", "unit", "utilisation", "kept", "within_error"}} [SI]; the last of
/// those that are broken: whether by less than the error of the response
/// @param errors  of the responses; may be empty
Json limits_document(const ProblemFile& problem, const Eigen::VectorXd& x, const Analysis& analysis,
                     const ErrorBars& errors);

/// "kept", "BROKEN" of an entry of such a document.
DocumentColumn kept_column();

/// A table of limits_document(), and which limits are broken; empty without limits.
std::string limits_text(const ProblemFile& problem, const Json& limits);

/// Names of those that are broken, judged as exactly as of a verified optimum.
/// @param limits  of limits_document()
std::vector<std::string> broken_limits(const Json& limits);

/// Sentences on the gaps of a front that was asked for one: how large they are, where it jumps, and
/// what kept it from closing others.
/// @param limited  name of what is limited
std::string gaps_message(const ProblemFile& problem, const ParetoFront& front,
                         const std::string& limited);

/// `largest` is null of fewer than two points.
/// {"asked", "largest", "left": [{"points": [i, j], "limited": [a, b], "size", "cause"}]};
/// points are counted from 1.
Json gaps_document(const ProblemFile& problem, const ParetoFront& front);

// Maxima that two peaks share. If the peaks move alike with the design that is no harm; if not,
// the response has a kink there, and its gradient is that of the higher peak only.

struct Tie {
  PeakTie peaks;
  std::optional<double> kink;  ///< relative difference of the two gradients, if they differ

  bool is_kink() const { return kink.has_value(); }
};

/// The tie of each response, if it has one; a kink before a harmless one.
using Ties = std::vector<std::optional<Tie>>;

/// @param kinks  of find_kinks()
Ties make_ties(const Analysis& analysis, const std::vector<Kink>& kinks);

/// {"times": [s, s], "places": ["…", "…"], "gap", "is_kink"}
Json tie_document(const Tie& tie, const Response& response);

/// A line for each kink, and one for all harmless ties; or nothing.
std::string ties_text(const Ties& ties, const Analysis& analysis);

}  // namespace pleuel
