#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/integration/trajectory.hpp"
#include "core/response/response.hpp"

/// How the numbers that a signal observes become the history of a response, and that a number.
/// Samples of reductions are those of the history; observed_samples() tells what they are made from.
namespace pleuel {

/// The history of a response from what its signal observed.
/// @param observed  channels × instants
Eigen::MatrixXd mapped_history(const Response& response, const Eigen::VectorXd& time,
                               Eigen::MatrixXd observed);

/// Of a history, or of some of its channels.
/// @throws SimulationError if a mean stress reaches the strength of the material
Reduction reduce_history(const Response& response, const Trajectory& trajectory,
                         const Eigen::MatrixXd& history, const BrokenInstants& breaks);

/// The peak of each of so many windows of the range; of fatigue, which no window has whole, one.
std::vector<Reduction> reduce_history_windows(const Response& response,
                                              const Trajectory& trajectory,
                                              const Eigen::MatrixXd& history, int windows,
                                              const BrokenInstants& breaks);

/// Samples of a history as samples of its signal.
std::vector<Sample> observed_samples(const Response& response, const Eigen::VectorXd& time,
                                     const std::vector<Sample>& samples);

/// Whether a history jumps beside an instant, as forces do where friction turns round, a stop is
/// met or a law has a step: no parabola goes through a peak there. The slopes before and after each
/// instant tell: those of a smooth function change alike from one instant to the next, where it
/// jumps there is one change, its opposite within two steps, and then next to none; behind a jump
/// at the first instant there is none at once. Pulses that rise and fall within two steps look the
/// same. Within three instants of the ends of a history jumps are not told.
/// @param values  a row a channel
bool jumps_beside(const Eigen::VectorXd& time, const Eigen::MatrixXd& values, Eigen::Index channel,
                  Eigen::Index step);

/// One curve for a history of several channels, such as the places of a stress: the largest of them
/// at each instant; of those that are reduced by their magnitude, the largest magnitude.
/// @param history  channels × instants
Eigen::VectorXd shown_history(const Response& response, const Eigen::MatrixXd& history);

}  // namespace pleuel
