#pragma once

#include <string>
#include <vector>

#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// How far the elastic beams of a run bend, and which of them are stubby.
struct BentBeams {
  std::vector<std::string> stubby;  ///< names, the largest share of shear first
  std::vector<double> shares;       ///< of shear, of each of them
  double deflection = 0.0;          ///< the largest against a body frame [m]
  double rotation = 0.0;            ///< and of a section [rad]
};

/// Finds elastic beams without shear in which it may count: those in which it would store more than a
/// small share of the energy of bending, in one of both planes, where they bend most; and, where a
/// frequency or a load of buckling is asked for, those that are too thick for it by their
/// proportions, with half waves of such a number.
/// The share is that of the section forces of the run: V²/(κ G A) over M²/(EI), both integrated;
/// 3EI/(κ G A L²) of a cantilever with a force at its tip, 12EI/(κ G A L²) of a beam on two pins with
/// one in the middle. κ is that of the sections, or of a rectangle where they do not say.
BentBeams find_bent_beams(const TrustedRun& run);

/// The share of one beam in a state, of the plane in which it is larger. [–]
/// @param x  design variables [SI]
double shear_share(const ProblemFile& problem, const Eigen::VectorXd& x, const Model& model,
                   const std::string& beam, const State& state);

}  // namespace pleuel
