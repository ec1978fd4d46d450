#pragma once

#include <set>

#include "core/scene/problem_file.hpp"
#include "core/scene/reading/json_node.hpp"

/// Reads the block "cases": what load cases change in the rest of the file.
namespace pleuel {

/// A load case as the file gives it.
struct CaseChanges {
  std::string name;
  std::string range;                                 ///< that it is one of; empty: none
  std::vector<std::pair<std::string, Json>> values;  ///< pointer and what stands there instead
};

/// The load cases of a document, those of ranges one by one; none if it has no such block.
/// @throws InputError
std::vector<CaseChanges> read_cases(const JsonNode& root);

/// The document with what the case changes. Limits and objective may still name cases.
/// @throws InputError
Json document_of_case(Json document, const CaseChanges& changes, const std::string& file);

/// What the document of a case says if it is read alone: with the limits that hold in the case.
void keep_case(ProblemFile& problem);

/// What the cases share, with the responses and constraints of all (ProblemFile::cases).
/// @param documents  of the cases, one each
/// @param constants  that differ from case to case
/// @param cases      problems of the cases with their names, one each
/// @throws InputError at places of `root` that name cases
ProblemFile join_cases(const JsonNode& root, const std::vector<Json>& documents,
                       const std::set<std::string>& constants, std::vector<ProblemFile> cases);

/// @throws InputError where a file without cases names some
void forbid_case_names(const JsonNode& root, const ProblemFile& problem);

}  // namespace pleuel
