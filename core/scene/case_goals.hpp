#pragma once

/// Goals of a problem that are exchanged for others: its objective, and limits that trade one
/// response for another. With load cases and without.

#include <cstddef>
#include <string>
#include <vector>

#include "core/scene/problem_file.hpp"

namespace pleuel {

/// The goal by a response of the problem: one over cases is made such a response, "peak [worst]", if
/// there is none yet.
/// @param goal  of a response of each case where it is over cases; else of one of the problem
Objective goal_of_problem(ProblemFile& problem, Objective goal);

/// The problem with another objective.
/// @param goal  as goal_of_problem() gives it
void set_objective(ProblemFile& problem, const Objective& goal);

/// A further limit, the last: at most this value, of what is maximized at least. That of the worst
/// case is one in each of them.
/// @param goal  as goal_of_problem() gives it
/// @param name  of the limit, which no other has
void add_limit(ProblemFile& problem, const Objective& goal, double value, const std::string& name);

/// Takes such a limit away again.
void remove_limit(ProblemFile& problem, const std::string& name);

/// The limit of the file that a constraint of a joined problem is of; its own name without cases.
const std::string& limit_name(const ProblemFile& problem, std::size_t constraint);

/// Constraints of the problem that a name means: one of its own, or that of a limit which stands once
/// for each case.
std::vector<std::size_t> constraints_of_limit(const ProblemFile& problem, const std::string& name);

/// What is minimized or limited has to be accurate (AccuracySettings::responses of the cases).
void ask_for_accuracy(ProblemFile& problem, std::size_t response);

/// Joins the problems of cases (ProblemFile::cases). What is the same in all stands once under its
/// own name; each other response, and limit on it, once for each case that it is for. An objective
/// over cases is one response more, the last: "peak [worst]".
/// @param cases    at least one, read from one file; constraints that a case is not meant by are
///                 taken from its problem
/// @param is_same  one a response of the file: whether it is the same in all cases
ProblemFile joined_cases(std::vector<ProblemFile> cases, const std::vector<bool>& is_same);

}  // namespace pleuel
