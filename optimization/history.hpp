#pragma once

#include <functional>
#include <string>
#include <vector>

#include <Eigen/Core>

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

}  // namespace pleuel
