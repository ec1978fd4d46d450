#pragma once

#include <vector>

#include "core/trust/finding.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// Initial velocities and deflections of the file that are not those of the simulation: they are made
/// consistent with joints and drives, and elastic bodies begin without other elastic rates. What the
/// file gives and changes by more than a percent is named.
std::vector<Finding> check_initial_motion(const TrustedRun& run);

/// Natural frequencies of the whole mechanism that do not say what they seem to: the stress of
/// members that start undeformed though they are loaded or turn, modes out of the plane that cannot be
/// had, and those that are not high against the speed of the motion.
std::vector<Finding> check_frequencies(const TrustedRun& run);

/// Loads that are functions of the coordinate of a joint or the elongation of a spring, as cogging or
/// the gas force of a crank, or of its rate, of which the steps pass over most of a tooth or peak: what
/// acts between two instants is not seen, and runs with other steps may miss the same. Less than that
/// they do see.
std::vector<Finding> check_laws_over_coordinates(const TrustedRun& run);

/// Imported bodies whose constants are continued linearly to another design than that of their
/// file: nothing says how far they are still those of the body. Serious where a variable has moved
/// by more than 1e-4 of its value: then the square of that may matter beside an optimizer's
/// tolerance.
std::vector<Finding> check_extrapolation(const TrustedRun& run);

/// What slides along an elastic beam: the line of a joint belongs to the node at which the joint is
/// drawn, and does not bend with the beam, so that forces act there as by a rigid lever, wherever
/// the slider is. Right for a contact that stays, wrong for one that travels over the beam.
std::vector<Finding> check_sliding_contacts(const TrustedRun& run);

/// Sizes that can hardly be meant, by name and place in the file: few points far away from all
/// others (a hundred times the size of the rest), sections larger than their beam is long or beams
/// five thousand times as long as they are thick, densities and moduli of no solid, inertia of a
/// body ten times as large as the mechanism, drives beyond 1000 rad/s that move a body beyond 50 m/s, gravity of
/// no planet. Most often a unit is missing.
std::vector<Finding> check_proportions(const TrustedRun& run);

/// The same of a design that need not be simulated.
std::vector<Finding> check_proportions_before(const ProblemFile& problem, const Eigen::VectorXd& x);

/// A mechanism of more coordinates is not judged: its stiffness would have to be a dense matrix.
constexpr int most_judged_coordinates = 600;

/// Whether members of a mechanism buckle or flutter, alone or together, where the motion does not
/// show it, as it is straight, in a plane, or too short. It is judged in space and with geometric
/// stiffening, for which a mechanism without them is simulated once more, with twice the steps.
///
/// At an equilibrium that the motion starts from the eigenvalues decide, rigid motions included. Along
/// a motion frozen eigenvalues only say whether to look: where the loads are more than a fifth of those that
/// make the stiffness singular (may_grow()), or more than what nothing grows tenfold below
/// (CriticalInstants::harmless), at the instants at which beams are pressed most, each of them and all
/// together, and of the fastest turn. Then small disturbances are propagated through all
/// of it (stability.cpp). Serious where one grows more than tenfold; mentioned where an
/// instant is not stable, but does not last. Forces that follow, springs, rigid parts and turning
/// damping count as they are. Not seen is what moments do to a beam that they bend
/// (sideways_buckling.hpp).
///
/// A mechanism in a plane is judged in space where it may grow in the plane, or where a beam is pressed beyond
/// a twentieth of the Euler load of a column as long as all beams together, or at all beside springs.
/// Mechanisms of more than most_judged_coordinates are told of.
std::vector<Finding> check_stability(const TrustedRun& run);

/// Positions that the file gives and joints and drives do not let be, where they leave open which
/// others they are: as a drive that begins at an angle between two bodies that are both free to
/// turn. The mechanism starts as close to the file as possible, by lengths and angles, which are
/// compared by the size of the mechanism at the start of its variables; serious where another
/// measure, of which angles or one direction count more, moves a body by more than a hundredth of
/// this size, or of a radian.
std::vector<Finding> check_open_positions(const TrustedRun& run);

/// Limits on the largest value alone (or the smallest) of what has a sign without a meaning, as a
/// deflection or a torque, where the motion goes further to the other side: an optimum uses that.
std::vector<Finding> check_other_side(const TrustedRun& run);

/// Beams under a pull N that bend within √(EI/N) of where they are held or loaded, far less than their
/// elements are long: with twice the elements hardly more of it is seen, so that error bars say
/// nothing of it. Serious for what is made from the bending moment, where that counts. By the
/// moment of a pulled cantilever, M = F √(EI/N) tanh(ℓ √(N/EI)): elements of length ℓ ≫ √(EI/N)
/// see about the part √(EI/N)/ℓ of it.
std::vector<Finding> check_tension_layers(const TrustedRun& run);

/// Peaks that the steps pass over: where a load or the acceleration of a drive jumps, elastic
/// bodies swing beyond their new equilibrium, up to as far again (the dynamic factor of two). Of
/// those that do so within a step nothing is left, with twice and half of it neither. Which may do
/// so the equations about that instant tell (fast_vibration.hpp); what is missing is seen by one
/// more simulation, with short steps behind such jumps (sudden_jumps.hpp).
std::vector<Finding> check_unresolved_transients(const TrustedRun& run);

/// Peaks that are those of the start: elastic bodies which begin undeformed, under loads and speeds
/// that are there at once, vibrate about the deformation that these would have made, up to twice as
/// far. Such peaks are compared with those of a start in elastic equilibrium; laws that jump at t =
/// 0 (`step`) are meant and are sudden in both. The numbers are right, so this is never serious.
std::vector<Finding> check_startup_transient(const TrustedRun& run);

}  // namespace pleuel
