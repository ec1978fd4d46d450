#pragma once

#include "core/scene/reading/json_text.hpp"
#include "core/scene/units.hpp"

namespace pleuel {

/// Writes out what a document has by name only. Materials of the library that bodies name are declared, as if the
/// file did so. The section of the catalogue is put in the place of its name, wherever a beam of the document has
///     "section": {"catalogue": "IPE 80"}
/// The scene names the file, relative to the folder of the problem file: "catalogue": "my.json".
///     {"description": "…", "sections": {"IPE 80": {"type": "general", …}, …}}
/// Its sections are written as in a problem file, but nothing in them can be bound to a variable.
/// All of them are checked, used or not. Sections that a variable chooses are written out too
/// (section_choices.hpp).
/// @param file  how messages name the document; its folder is that of the problem.
/// @throws InputError  that names the file and the pointer in which the fault is.
void expand_names(Json& document, const std::string& file);

/// The variables that choose sections in a document that is not expanded yet.
std::vector<std::string> section_variables(const Json& document);

}  // namespace pleuel
