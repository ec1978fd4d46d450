#pragma once

#include <string>

#include "optimization/design/staged_solve.hpp"

namespace pleuel {

/// A solution for another process, with what the problem of its last stage differs by from the file.
std::string pack_solution(const StagedSolution& solution);

/// @param file     that was solved
/// @param threads  of the problem that is made again
StagedSolution unpack_solution(const std::string& bytes, const ProblemFile& file, int threads);

}  // namespace pleuel
