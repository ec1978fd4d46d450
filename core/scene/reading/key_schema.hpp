#pragma once

#include "core/scene/reading/json_text.hpp"

/// The part of the schema of problem files that the tables of keys say (grammar/keys.hpp).
namespace pleuel {

/// The schema with the definitions of all objects that have tables; others stay as they are.
Json with_tables(Json schema);

/// As text for readers.
std::string schema_text(const Json& schema);

}  // namespace pleuel
