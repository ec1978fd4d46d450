#pragma once

#include <filesystem>

#include "cli/text/json.hpp"
#include "core/base/fingerprint.hpp"

namespace pleuel {

/// The bytes of a file; empty if it cannot be read.
std::string whole_text(const std::filesystem::path& path);

/// The file that this code was loaded from: the shared library, wherever the program that uses it is.
std::filesystem::path own_file();

/// Of the program itself: another build has another one.
std::string program_fingerprint();

/// {NAME: fingerprint} of the files that a problem or one of its load cases names: catalogues, tables
/// and those of bodies.
/// @param problem  with all overrides
/// @param file     that it was read from: names are relative to its folder
Json fingerprints_of_files(const Json& problem, const std::filesystem::path& file);

/// "pleuel 0.1.0 (commit 0ce292e8, GNU 12.2.0, Release, -march=native)": what this program was made from, and how.
std::string version_text();

}  // namespace pleuel
