#pragma once

#include "studies/accuracy_optimum.hpp"

namespace pleuel {

/// What the command accuracy prints: the answer as sentences first, then the tables behind it.
/// @param optima  whole optimizations; null without
std::string accuracy_text(const ProblemFile& problem, const AccuracyStudy& study,
                          const OptimumStudy* optima, bool is_verbose);

/// "4 elements a segment", "the elements of the file", "0.5 times the elements of the file"
std::string division_text(const Discretization& settings);

/// "a step of 0.2 ms and 4 elements a segment"
std::string setting_text(const Discretization& settings);

/// "formulation stabilized-index-2", "geometric_stiffening off"
std::string variation_text(const Variation& variation);

/// "9.7 ms", "140 ms"
std::string milliseconds(double seconds);

/// "1 %", "0.1 %"
std::string target_text(double target);

/// "+7.8 g", "−0.2 mm": a change in the unit of a response, masses in grams.
std::string change_text(const ResponseSettings& response, double change);

}  // namespace pleuel
