#pragma once

#include "core/scene/reading/case_reader.hpp"

/// What load cases have in common, as there is one design: variables with their choices, numbers
/// that stand once for all cases, and what constants and responses measure.
namespace pleuel {

struct Symbol;

/// @param documents  of the cases, one each
/// @param of_cases   names that their formulas may use
/// @throws InputError  if a case gives a constant another dimension, or changes the catalogue that a
///                     variable is chosen from
void check_shared_documents(const JsonNode& root, const std::vector<CaseChanges>& changes,
                            const std::vector<Json>& documents,
                            const std::vector<std::vector<Symbol>>& of_cases);

/// @param cases  problems of the cases with their names, one each
/// @throws InputError  if a number that stands once follows from a constant that a case changes, or
///                     a response measures something else in another case
void check_shared_numbers(const JsonNode& root, const std::vector<ProblemFile>& cases);

/// Of limits that stand once: of variables, or of a response that is the same in all cases.
/// @param joined  the problem of all cases
/// @throws InputError  if one follows from a constant that a case changes
void check_shared_limits(const JsonNode& root, const ProblemFile& joined);

}  // namespace pleuel
