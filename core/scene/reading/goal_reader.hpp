#pragma once

#include "core/scene/problem_file.hpp"
#include "core/scene/reading/number_reader.hpp"

/// What the design is to reach: objective, constraints, and the study that trades one for the
/// other.
namespace pleuel {

// Formulas that stand in place of a response's name become responses, at the end of the list.

/// @throws InputError
Objective read_objective(const JsonNode& node, std::vector<ResponseSettings>& responses,
                         NumberReader& numbers);

/// Limits have the unit of the response, or of the variables in a linear constraint.
/// @throws InputError
std::vector<ConstraintSettings> read_constraints(const JsonNode& node,
                                                 std::vector<ResponseSettings>& responses,
                                                 NumberReader& numbers);

/// One of them.
ConstraintSettings read_constraint(const std::string& name, const JsonNode& node,
                                   std::vector<ResponseSettings>& responses, NumberReader& numbers);

/// `problem` has its constraints already. @throws InputError
ParetoSettings read_pareto(const JsonNode& node, const ProblemFile& problem,
                           const NumberReader& numbers);

/// What names of limits and weights may stand for: ranges, then cases.
std::vector<std::string> names_of_cases(const std::vector<ProblemFile>& cases);

/// Weights by names of cases and of ranges.
using CaseWeights = std::vector<std::pair<std::string, double>>;

/// @param node  of the weights
/// @throws InputError  if a name is unknown, or a case has two weights
void check_weights(const JsonNode& node, const CaseWeights& weights,
                   const std::vector<ProblemFile>& cases);

}  // namespace pleuel
