#pragma once

#include "cli/files/run_record.hpp"
#include "optimization/result.hpp"

/// What an optimization leaves of a design that could not be evaluated, so that it can be looked
/// at.
namespace pleuel {

/// Writes failed_design.json: design, failure, and the command that evaluates that design again.
void write_failed_design(RunRecord& record, const Arguments& arguments, const ProblemFile& problem,
                         const EvaluationRecord& failed);

/// Says where the last failed design is and how to run it; empty if none failed.
std::string failed_design_text(const RunRecord& record, const Arguments& arguments,
                               const ProblemFile& problem, const History& history);

}  // namespace pleuel
