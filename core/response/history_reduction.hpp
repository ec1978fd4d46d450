#pragma once

#include <vector>

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

/// One curve for a history of several channels, such as the places of a stress: the largest of them
/// at each instant; of those that are reduced by their magnitude, the largest magnitude.
/// @param history  channels × instants
Eigen::VectorXd shown_history(const Response& response, const Eigen::MatrixXd& history);

}  // namespace pleuel
