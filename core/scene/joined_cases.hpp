#pragma once

#include <vector>

#include "core/scene/problem_file.hpp"

namespace pleuel {

/// Joins the problems of cases (ProblemFile::cases). What is the same in all stands once under its
/// own name; each other response, and limit on it, once for each case that it is for. An objective
/// over cases is one response more, the last: "peak [worst]".
/// @param cases    at least one, read from one file; constraints that a case is not meant by are
///                 taken from its problem
/// @param is_same  one a response of the file: whether it is the same in all cases
ProblemFile joined_cases(std::vector<ProblemFile> cases, const std::vector<bool>& is_same);

}  // namespace pleuel
