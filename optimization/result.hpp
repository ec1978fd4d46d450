#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/base/error_bar.hpp"
#include "optimization/problem.hpp"

namespace pleuel {

/// What an evaluation is made for.
enum class Purpose {
  search,       ///< a step of the backend
  polish,       ///< a step of what refines the backend's answer
  restoration,  ///< on the way into the limits, or to the design that breaks them least
  audit,        ///< beside an answer, to prove or disprove it: no step of anything
  trial         ///< of a choice of sizes; all evaluations of one choice have one iteration
};

/// "search", "polish", "restoration", "audit" or "trial".
std::string to_string(Purpose purpose);

/// One call of Problem::evaluate.
struct EvaluationRecord {
  int evaluation = 0;  ///< 1, 2, 3, …
  int iteration = 0;   ///< designs of a search or polish with gradients so far, this one included
  Purpose purpose = Purpose::search;
  Request request = Request::values;
  Eigen::VectorXd x;            ///< [SI]
  std::string failure;          ///< empty: it succeeded; else why not, and the numbers below say 0
  double objective = 0.0;       ///< [SI]
  Eigen::VectorXd constraints;  ///< raw values [SI]; empty after a failure
  double max_violation = 0.0;   ///< relative, see scaling.hpp
  double step = 0.0;            ///< ‖Δx / s‖∞ from the evaluation before
  double seconds = 0.0;         ///< wall time since the start of solve()
  double time_step = 0.0;       ///< of the simulation, where one is evaluated [s]
  int elements = 0;             ///< of all its elastic beams

  bool has_failed() const { return !failure.empty(); }
};

using History = std::vector<EvaluationRecord>;

/// The record of an evaluation by itself: its number, purpose, time, step and violation are those of the run.
EvaluationRecord record_of(const Eigen::VectorXd& x, Request request, const Attempt& attempt);

/// The number of evaluations that failed.
inline int count_failures(const History& history) {
  int count = 0;
  for (const EvaluationRecord& record : history) count += record.has_failed() ? 1 : 0;
  return count;
}

/// The best design seen: the lowest objective among those that exceed no limit by more than this
/// (relative), or, if there is none, the one with the smallest violation.
/// @param history  with an evaluation that did not fail
const EvaluationRecord& best_record(const History& history, double allowed_violation);

/// The first evaluation that did not fail, where the search began; the first one if all failed.
const EvaluationRecord& first_design(const History& history);

/// Sees every evaluation as it happens; may be empty.
using Observer = std::function<void(const EvaluationRecord&)>;

/// Shows a record to an observer, if there is one.
inline void show(const Observer& observer, const EvaluationRecord& record) {
  if (observer) observer(record);
}

/// Hears what a run decides on its way: a sentence; may be empty.
using Notice = std::function<void(const std::string&)>;

/// Tells a sentence, if anyone listens.
inline void notify(const Notice& notice, const std::string& sentence) {
  if (notice) notice(sentence);
}

// Limits that a design breaks, and those that contradict each other.

/// "rod_bow = 1.18 mm exceeds its upper limit 0.05 mm, …": all limits that are broken, the worst
/// first, each name once: rows of one name are peaks of one response. Empty if all are kept.
/// @param constraints  values c [SI]
/// @param scales       magnitudes C of the constraints
/// @param allowed      violation that does not count, relative to C
std::string broken_limits(const Problem& problem, const Eigen::VectorXd& constraints,
                          const Eigen::VectorXd& scales, double allowed);

/// A limit that is broken where limits are broken least, and what it would have to be [SI].
struct ExceededLimit {
  std::size_t constraint = 0;
  bool is_upper = true;
  double limit = 0.0;
  /// It is in conflict with the others that are: its multiplier holds the design where it is.
  bool is_in_conflict = false;
  /// That would do if all others are kept; none: they are in conflict without it, too, or nothing
  /// was found.
  std::optional<double> alone;
  double together = 0.0;  ///< that of the design: what would do if all broken limits give
};

/// The design that breaks its limits least, as far as could be found from one design.
struct LeastViolation {
  Eigen::VectorXd x;
  double violation = 0.0;             ///< the largest, relative to the magnitudes of the limits
  std::vector<ExceededLimit> limits;  ///< those in conflict first
  /// That no design nearby breaks its limits less is verified as any optimum is.
  bool is_proven = false;
};

/// "stress ≤ 60 MPa and bow ≤ 0.05 mm cannot be kept at once; … One change would do: …"; empty where no limit is
/// broken.
std::string describe(const LeastViolation& least, const Problem& problem);

enum class Status {
  verified,    ///< a local optimum by our own audit, whatever the backend says
  unresolved,  ///< a local optimum of these numbers, but they are not to be trusted
  stalled,     ///< nothing is proven: of a design within the limits, or of one outside
  infeasible,  ///< no design that keeps the limits was found; of find_optimum(): with evidence that
               ///< none is nearby
  failed,      ///< the evaluations fail: at the start, or too often in a row
  interrupted  ///< by the user, before anything was proven
};

/// "verified", "unresolved", "stalled", "infeasible", "failed" or "interrupted".
std::string to_string(Status status);

/// A part of the search for an optimum, see find_optimum().
struct SearchPart {
  std::string method;  ///< a backend, or "restoration"
  Status status = Status::failed;
  int evaluations = 0;
};

struct Result {
  Status status = Status::failed;
  std::string message;  ///< a sentence: why this status
  /// Sentences: what speaks against the numbers of the last design.
  std::vector<std::string> warnings;
  int consequences = 0;  ///< so many of the last warnings follow from those before them
  /// Of responses and objective by steps, elements and effects; where a design problem knows them.
  std::vector<std::optional<ErrorBar>> response_errors;
  std::vector<Eigen::VectorXd> response_bands;  ///< of histories [SI]; empty where none is known
  std::optional<ErrorBar> error;                ///< of the optimal objective
  /// What was tried one after the other, where find_optimum() searched.
  std::vector<SearchPart> parts;
  /// Of an infeasible problem: what is in conflict.
  std::optional<LeastViolation> least_violation;
  bool gradients_are_disproved = false;  ///< by differences, where all else is well
  std::string backend;                   ///< that found the answer
  std::string polished_with;             ///< the backend that refined the answer; empty: nobody did
  Eigen::VectorXd x;                     ///< [SI]
  /// At x, with gradients. Without any entry if the start already failed.
  Evaluation evaluation;
  /// μ and β of KktAudit: d(optimal objective) / d(active limit) = −μ. That of a limit with slack
  /// is 0; see has_prices() of kkt_audit.hpp for the designs at which they are prices.
  Eigen::VectorXd constraint_multipliers, bound_multipliers;
  /// Where the worst of several load cases is minimized: how much of the optimum is that of each;
  /// they add up to 1. Empty elsewhere.
  Eigen::VectorXd case_shares = {};
  /// Of an objective over load cases: its response in each of them [SI]. Empty elsewhere.
  Eigen::VectorXd case_objectives = {};
  double kkt_residual = 0.0;   ///< relative
  double max_violation = 0.0;  ///< relative
  int evaluations = 0;
  int gradient_evaluations = 0;
  int iterations = 0;  ///< designs at which gradients were computed
  int restarts = 0;
  double seconds = 0.0;
  History history;

  /// A local optimum by its numbers, be they trusted or not.
  bool is_optimum() const { return status == Status::verified || status == Status::unresolved; }
};

/// Whether a result is to be preferred: verified before unresolved before unproven, within the limits before
/// outside, with gradients before none; then the lower objective, or outside the smaller violation.
/// @param violation  relative, that still counts as within the limits
/// @param equal      relative difference of objectives that is none: the first one is preferred then; 0: the other
bool is_better(const Result& one, const Result& other, double violation, double equal = 0.0);

/// Whether the multipliers of a result say what limits are worth: those of an optimum, and of a
/// design within the limits with a KKT residual of at most 10⁻². What explains the gradients of any
/// other design best is no price.
bool has_prices(const Result& result);

/// Puts what an earlier run of the same optimization did before a result: counts, time, history.
void continue_from(const Result& before, Result& result);

/// An answer with the counts, time and history of another result in place of its own.
Result with_effort_of(Result effort, Result answer);

/// A record as one that follows on a run.
EvaluationRecord following(EvaluationRecord record, const Result& before);

/// A run with an observer.
using ObservedRun = std::function<Result(const Observer& observer)>;

/// A run that goes on where an earlier one has ended: its records, in the result and for the observer, follow
/// on those before.
/// @param before  must not change during the run
Result run_after(const Result& before, const Observer& observer, const ObservedRun& run);

/// A run whose records, in the result and for the observer, are changed one by one.
Result run_with_records(const std::function<EvaluationRecord(EvaluationRecord)>& changed,
                        const Observer& observer, const ObservedRun& run);

}  // namespace pleuel
