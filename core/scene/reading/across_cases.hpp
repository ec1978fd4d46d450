#pragma once

#include "core/scene/problem_file.hpp"
#include "core/scene/reading/symbols.hpp"
#include "core/scene/units.hpp"

/// What a file makes from responses of several load cases: expressions such as
/// `bow[fast] - bow[slow]`, limits on them, and an objective of them. No case has them by itself.
namespace pleuel {

/// Reads them: responses and limits stand behind those of the joined problem. So does the study of a
/// front, which may name them.
/// @param root      of the file
/// @param of_cases  names that formulas of each case may use
/// @param joined    the problem of all cases, without them
/// @throws InputError
void read_across_cases(const JsonNode& root, const std::vector<std::vector<Symbol>>& of_cases,
                       ProblemFile& joined);

}  // namespace pleuel
