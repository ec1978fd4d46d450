#pragma once

#include <set>
#include <string>
#include <vector>

#include "core/scene/problem_file.hpp"
#include "core/scene/reading/json_node.hpp"
#include "core/scene/units.hpp"

/// What a file makes from responses of several load cases: expressions such as
/// `bow[fast] - bow[slow]`, limits on them, and an objective of them. No case has them by itself.
namespace pleuel {

/// Names of what is made from several cases.
struct AcrossCases {
  std::set<std::string> responses, constraints;
  bool has_objective = false;
};

/// Which formulas and names of a document name cases, themselves or by a response that does.
AcrossCases across_cases(const Json& document);

/// Of documents that the program makes: names of variables that count as used.
inline constexpr const char* mentioned_key = "$mentioned";

/// The document without them, as it is for each case. The design variables that they name are listed
/// under `mentioned_key`, so that they count as used. Where an accuracy is asked for them, it is asked for
/// their parts in this case.
Json without_across_cases(Json document, const std::string& load_case);

/// Reads them: responses and limits stand behind those of the joined problem. So does the study of a
/// front, which may name them.
/// @param root       of the file
/// @param documents  of the cases, one each
/// @param joined     the problem of all cases, without them
/// @throws InputError
void read_across_cases(const JsonNode& root, const std::vector<Json>& documents,
                       const UnitSystem& units, ProblemFile& joined);

}  // namespace pleuel
