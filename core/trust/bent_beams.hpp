#pragma once

#include <string>
#include <vector>

#include "core/trust/finding.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// Displacements u v w θx θy θz of the nodes of an elastic beam (or of the places of an imported
/// body) against its frame, 6 × nodes; zero where there is no coordinate. Of a reduced beam those
/// that its modes make.
Eigen::MatrixXd nodal_displacements(const BodyModel& body, const State& state);

/// Δu of an element, with the shortening by bending where geometric stiffening is built [m].
double elongation_of(const BodyModel& body, const Eigen::MatrixXd& nodal, int element);

/// Takes the deformation of an elastic body at an instant into account. Of an imported body that is the
/// rotations of its places.
void record_deformation(const BodyModel& body, const State& state, int step,
                        LargestDeformation& largest);

/// One an elastic body of the model (others stay zero), in its order.
const std::vector<LargestDeformation>& largest_deformations(const TrustedRun& run);

/// A beam for which it may count what the model leaves out.
struct ConcernedBeam {
  std::string name;
  double indicator = 0.0;  ///< of how much, beside other beams
};

/// Beams that bend or twist so far against their frames that more frames may change something, and
/// that can be divided: not those with damping of the motion against one frame.
/// @returns those that turn most first
std::vector<ConcernedBeam> find_far_bending(const TrustedRun& run);

/// Of these bodies, those that bend so far that 0.45 θ² exceeds 1 %: what is missed of the deflection of a
/// cantilever whose tip turns by θ.
/// @param why  no run with more frames can tell
std::vector<Finding> check_untold_bending(const TrustedRun& run,
                                          const std::vector<std::string>& bodies,
                                          const std::string& why);

/// Bodies that are stretched or bent beyond what linear elasticity is for, where no variant can tell
/// what that changes: stretched by more than 1 %, or bent and not to be divided.
std::vector<Finding> check_linear_elasticity(const TrustedRun& run);

/// Finds elastic beams without shear in which it may count: those in which it would store more than
/// a small share of the energy of bending, in one of both planes, where they bend most; and, where
/// a frequency or a load of buckling is asked for, those that are too thick for it by their
/// proportions, with half waves of such a number. The share is that of the section forces of the
/// run: V²/(κ G A) over M²/(EI), both integrated; 3EI/(κ G A L²) of a cantilever with a force at
/// its tip, 12EI/(κ G A L²) of a beam on two pins with one in the middle. κ is that of the
/// sections, or of a rectangle where they do not say.
/// @returns the largest share first, which is the indicator [–]
std::vector<ConcernedBeam> find_slenderness(const TrustedRun& run);

/// Beams under a pull N that bend within √(EI/N) of where they are held or loaded, far less than their
/// elements are long: with twice the elements hardly more of it is seen. By the moment of a pulled cantilever,
/// M = F √(EI/N) tanh(ℓ √(N/EI)): elements of length ℓ ≫ √(EI/N) see about the part √(EI/N)/ℓ of it. The
/// indicator is the stress that may be missed, of the largest (tension_layers.cpp).
std::vector<ConcernedBeam> find_taut(const TrustedRun& run);

/// The share of one beam in a state, of the plane in which it is larger. [–]
/// @param x  design variables [SI]
double shear_share(const ProblemFile& problem, const Eigen::VectorXd& x, const Model& model,
                   const std::string& beam, const State& state);

}  // namespace pleuel
