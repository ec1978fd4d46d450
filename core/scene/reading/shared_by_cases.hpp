#pragma once

#include <vector>

#include "core/scene/problem_file.hpp"
#include "core/scene/reading/case_reader.hpp"

/// What load cases have in common, as there is one design: variables with their choices, numbers
/// that stand once for all cases, and what constants and responses measure.
namespace pleuel {

/// @param documents  of the cases, one each
/// @throws InputError  if a case gives a constant another dimension, or changes the catalogue that a
///                     variable is chosen from
void check_shared_documents(const JsonNode& root, const std::vector<CaseChanges>& changes,
                            const std::vector<Json>& documents, const UnitSystem& units);

/// @param cases    problems of the cases, one each
/// @param is_same  one a response: whether it is the same in all cases
/// @throws InputError  if a number that stands once follows from a constant that a case changes, or
///                     a response measures something else in another case
void check_shared_numbers(const JsonNode& root, const std::vector<ProblemFile>& cases,
                          const std::vector<bool>& is_same, const UnitSystem& units);

}  // namespace pleuel
