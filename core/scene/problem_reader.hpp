#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/scene/undecided_problem.hpp"

namespace pleuel {

/// Reads and checks a problem file: syntax, keys, types, units, names, and what can be said of the
/// values without mechanics. What it returns has all defaults and is in SI units.
/// @param overrides  each "/json/pointer=value", applied in this order before anything is checked;
///                   a value that is not JSON is a text: /simulation/step=0.1 ms
/// @throws InputError  "file: pointer rule, got value".
UndecidedProblem read_problem(const std::filesystem::path& path,
                              const std::vector<std::string>& overrides = {});

/// The same for a text.
/// @param file  how messages name it; a catalogue of sections is looked for in its folder (the
///              current one if the name has none).
UndecidedProblem read_problem_text(const std::string& text, const std::string& file,
                                   const std::vector<std::string>& overrides = {});

}  // namespace pleuel
