#pragma once

#include "core/scene/reading/law_source.hpp"

namespace pleuel {

/// A law through points, of time or of the motion, which the file lists or another file has.
/// @throws InputError
TableFunction read_table_law(const LawSource& source, NumberReader& numbers);

}  // namespace pleuel
