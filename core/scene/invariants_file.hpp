#pragma once

#include <filesystem>
#include <string>

#include "core/scene/body_constants.hpp"

/// The files by which bodies come from other codes and go to them (docs/invariants.md).
namespace pleuel {

/// The text of a file. Numbers read back exactly.
std::string write_invariants(const InvariantsFile& file);

/// Reads a file and checks it: sizes, finite numbers, a mass that is positive, matrices that are
/// symmetric and positive definite, S_xx + S_yy + S_zz = mass matrix.
/// @throws InputError that names the file and the JSON pointer.
InvariantsFile read_invariants(const std::filesystem::path& path);

/// @param file  how messages name the text
InvariantsFile read_invariants_text(const std::string& text, const std::string& file);

}  // namespace pleuel
