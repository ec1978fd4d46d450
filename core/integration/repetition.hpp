#pragma once

#include <string>
#include <vector>

#include "core/integration/trajectory.hpp"
#include "core/mechanism/mechanism.hpp"

namespace pleuel {

/// Whether all that acts repeats itself with a period: each term is evaluated between the instants
/// of a motion, and a period later at the same place,
///     R(q, v, a, λ, t) = R(q + whole turns, v, a, λ, t + T)
/// @param trajectory  of one period
/// @returns a sentence naming the term that does not; empty if all do
std::string complaint_about_repetition(Mechanism& mechanism, const Trajectory& trajectory,
                                       double period);

/// The same of the derivatives of all terms with respect to the design: whether the motion repeats
/// itself with this period at designs close by, without which it has no derivatives.
/// @param trajectory  begins with a period of that many steps
std::string complaint_about_repeated_derivatives(Mechanism& mechanism, const Trajectory& trajectory,
                                                 int steps, double period);

/// The design variables, in ascending order, that keep the motion from repeating itself at designs
/// close by.
std::vector<int> variables_of_unrepeated_derivatives(Mechanism& mechanism,
                                                     const Trajectory& trajectory, int steps,
                                                     double period);

/// Of a period that is rounded: a sentence, with its full stop before it, that says what nearly
/// makes whole turns in it; or nothing.
/// @param trajectory  of a period whose beginning is that of the file
std::string advice_to_be_exact(const Mechanism& mechanism, const Trajectory& trajectory);

}  // namespace pleuel
