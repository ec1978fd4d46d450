#pragma once

#include "core/scene/problem_text.hpp"
#include "core/scene/reading/case_reader.hpp"
#include "core/scene/reading/variable_reader.hpp"

namespace pleuel {

/// The document with all overrides, as it is for the load case that the text means.
/// @throws InputError
Json overridden_document(const ProblemText& text);

/// The load cases of a document; none where it has no such block. @throws InputError
std::vector<CaseChanges> cases_of(const Json& document, const std::string& file);

/// The document that a problem is read from: with all overrides, and sections of the catalogue
/// written out. @throws InputError
Json whole_document(const ProblemText& text);

/// @param numbers  that knows variable_names()
/// @throws InputError
ProblemFile read_document(const JsonNode& root, NumberReader& numbers);

}  // namespace pleuel
