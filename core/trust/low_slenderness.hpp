#pragma once

#include <string>
#include <vector>

#include "core/trust/far_bending.hpp"

namespace pleuel {

/// Finds elastic beams without shear in which it may count: those in which it would store more than
/// a small share of the energy of bending, in one of both planes, where they bend most; and, where
/// a frequency or a load of buckling is asked for, those that are too thick for it by their
/// proportions, with half waves of such a number. The share is that of the section forces of the
/// run: V²/(κ G A) over M²/(EI), both integrated; 3EI/(κ G A L²) of a cantilever with a force at
/// its tip, 12EI/(κ G A L²) of a beam on two pins with one in the middle. κ is that of the
/// sections, or of a rectangle where they do not say.
/// @returns the largest share first, which is the indicator [–]
std::vector<ConcernedBeam> find_slenderness(const TrustedRun& run);

/// The share of one beam in a state, of the plane in which it is larger. [–]
/// @param x  design variables [SI]
double shear_share(const ProblemFile& problem, const Eigen::VectorXd& x, const Model& model,
                   const std::string& beam, const State& state);

}  // namespace pleuel
