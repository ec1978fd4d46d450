#pragma once

#include <memory>

#include "library/open_problem.hpp"

/// The table of problems that are open: numbers of others name nothing, whatever they are.
namespace pleuel {

/// @returns its number, which no other problem of this process ever has
pleuel_problem add_open_problem(std::shared_ptr<OpenProblem> problem);

/// @throws CallError if none of this number is open
std::shared_ptr<OpenProblem> find_open_problem(pleuel_problem number);

/// @throws CallError if none of this number is open
void remove_open_problem(pleuel_problem number);

}  // namespace pleuel
