#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/scene/problem_file.hpp"
#include "core/trust/finding.hpp"
#include "core/trust/trusted_run.hpp"

/// What is looked for in a simulated design. Most kinds of findings have a source of their own.
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
/// (check_sideways_buckling()).
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

/// Variables whose range says nothing of how far they may go, since one bound is far from both the
/// start and the other bound: other starts, step lengths and scales of a search are taken from it.
std::vector<Finding> check_far_bounds(const ProblemFile& problem);

/// What is said of a value [SI] that is so far beyond the limit of a response; nothing if it is not.
std::optional<std::string> far_limit_text(const ProblemFile& problem,
                                          const ConstraintSettings& constraint, double value);

/// Limits that the value exceeds (or, of lower ones, misses) more than ten-thousandfold: a plain
/// number is in SI units, so that a stress limit of 80 is 80 Pa.
std::vector<Finding> check_far_limits(const TrustedRun& run);

/// Beams close to the global z axis whose direction is a matter of the design, without a `reference`:
/// local y lies in the x–y plane by default, so that the section turns with the smallest inclination,
/// and by 90 degrees where the beam is exactly along z. Not for sections that bend alike both ways.
std::vector<Finding> check_section_axes(const TrustedRun& run);

/// Places of joints and loads so near to an end of an elastic beam, a boundary of its segments or
/// another place that no node of the mesh is there (core/scene/beam_mesh.hpp): section forces do not
/// know what lies between both.
std::vector<Finding> check_lost_places(const TrustedRun& run);

/// Joints that would constrain a motion twice if they were aligned exactly, and are so nearly: a
/// motion is blocked by what is hardly a number of the file, with forces that are the larger the
/// smaller it is.
std::vector<Finding> check_misaligned_joints(const TrustedRun& run);

/// Springs in joints in space that turn farther than half a turn from where they began: there the
/// angle is counted from −π to π, where motion in a plane counts whole turns, and the moment jumps.
std::vector<Finding> check_joint_turns(const TrustedRun& run);

/// Drives that no rigid motion follows, since joints or other drives hold already what they move:
/// all that moves then does so because bodies bend. That may be meant, of a press fit say; mostly a
/// joint has a freedom too few, or a drive is too many.
std::vector<Finding> check_blocked_drives(const TrustedRun& run);

/// Drives that stand still where nothing else acts: numbers that are round-off.
std::vector<Finding> check_rest(const TrustedRun& run);

/// The finding at a state; empty if there is none.
std::string blocked_drives_text(const Model& model, const State& state);

/// Reactions of joints that hold more than they have to, as two hinges of a door do: the equations
/// of motion do not say which one takes how much (redundancy.hpp).
std::vector<Finding> check_undetermined_reactions(const TrustedRun& run);

/// A design simulated once more with all effects, where a tolerance leaves some out.
struct CompleteRun {
  ProblemFile problem;
  std::unique_ptr<Analysis> analysis;  ///< null: it cannot be simulated
  std::string failure;                 ///< why not
};

/// @returns none where no effect is left out by measurement
std::optional<CompleteRun> simulate_completely(const TrustedRun& run);

/// Effects that were left out because little changed without them at the start design, and change
/// more at this one.
std::vector<Finding> check_neglected_effects(const TrustedRun& run, const CompleteRun& complete);

/// Adds to the error of each response what the effects change that are left out by a tolerance.
void add_neglected_effects(const TrustedRun& run, const CompleteRun& complete,
                           std::vector<std::optional<ErrorBar>>& errors);

/// Beams with modal damping and geometric stiffening that bend far: their axial displacements hold
/// the shortening by bending, which a ratio of the axial modes damps as if it were stretch.
std::vector<Finding> check_modal_damping(const TrustedRun& run);

/// What one variant makes of all responses.
struct VariantChange {
  std::string name;        ///< of what is left out: "shear"
  Eigen::VectorXd change;  ///< what is missing of each response [its unit]
};

/// What the model leaves out: the mechanism is simulated once more with it, and the difference is what
/// it would change.
struct LeftOut {
  std::vector<VariantChange> changes;
  std::vector<Finding> findings;
};

/// Runs the variants whose indicators speak, in larger steps (coarse_runs.hpp):
/// - `shear` in beams that leave it out and are stubby (bent_beams.hpp),
/// - `more_frames`, by twice as many, in beams that bend or twist far against those they have: linear
///   elasticity in a frame is off by the square of rotations, of which twice the frames leave a
///   quarter,
/// - `more_elements`, four times as many, in beams under a pull that bend within far less than an element's length
///   of where they are held or loaded (bent_beams.hpp): half or twice the elements do not tell,
/// - `axial_elasticity`, and with it geometric stiffening, where the file switches it off.
///
/// Told from 1 % of what a response is with it, serious from 10 % of that or of a tenth of its
/// limits (coarse_runs.hpp), with the beams whose indicators say that they have a part in it. Where a response cannot be had of a divided beam, rotations tell (bent_beams.hpp).
LeftOut compare_variants(const TrustedRun& run);

/// Beams whose bending moment makes them buckle out of the plane in which they bend, by
/// lateral–torsional buckling, which the equations of motion do not have. Mentioned from three
/// quarters of the critical load on, serious beyond it, unless the file says that the beam is held.
/// The section forces of each instant count as if they lasted, neighbours at joints as rigid. What
/// compression does alone, or with neighbours, is asked of the whole mechanism (check_stability()).
/// Warping of sections helps short I beams: a bent beam is said to buckle only beyond what flanges
/// at the edges of its section could bear.
std::vector<Finding> check_sideways_buckling(const TrustedRun& run);

/// Whether the response `buckling` of a member says more than is true of the mechanism: it takes the
/// member as pinned at both ends, by itself; the rod of a hydraulic cylinder buckles together with
/// its barrel. Told where the mechanism buckles by smaller loads than the limit of the response is
/// for, or without a limit by less than twice its loads. Its factor is that of linear buckling at
/// the instant of the peak (elastic_stability.hpp), in the coordinates of the motion: in a plane, of
/// buckling in it. Drives hold. Not serious: the response is what it says it is. Nothing is said of
/// mechanisms with springs, nor without geometric stiffening.
std::vector<Finding> check_promised_buckling(const TrustedRun& run);

/// Bodies that can move freely although nothing is there to move them: a joint or a drive may have
/// been forgotten.
///
/// A body is acted on if its free motion does work against its weight, a load, a spring, a damper
/// or a motor, or if the file gives it a velocity. Free motions of the mechanism (all drives held)
/// that move only bodies on which nothing acts are idle: at most inertia moves them. They are
/// looked for in a position near the start that is no special one. Of a mechanism with drives those
/// are told, too, on which only weight acts: a linkage that hangs where a joint is missing.
///
/// Not idle: a mechanism that touches the ground nowhere but moves; the spin of a body about an
/// axis through its centre of mass, where its joints are points or the body moves otherwise (a rod
/// between ball joints, a roller).
std::vector<Finding> check_unactuated_freedoms(const TrustedRun& run);

/// Bodies without a way of joints and springs to the ground that nobody has given a velocity. Not serious where
/// loads act on them: they may be meant to fly.
std::vector<Finding> check_unconnected_bodies(const TrustedRun& run);

}  // namespace pleuel
