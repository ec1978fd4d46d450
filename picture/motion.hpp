#pragma once

#include <functional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/mobility/rigid_path.hpp"
#include "core/response/analysis.hpp"
#include "core/scene/problem_file.hpp"

namespace pleuel {

/// How a body moves and deforms: one column an instant.
struct BodyTrack {
  std::string body;
  /// Of a beam its stations along the length, 0 … 1; of an imported body its places along local x
  /// [m]; of others one, the centre of mass.
  std::vector<double> stations;
  std::vector<int> parts;     ///< which of the frames carries a station
  Eigen::MatrixXd positions;  ///< of the stations, global axes, 3·stations rows [m]
  /// Unit quaternions x y z w of the body frames, 4·frames rows; they turn body to global axes.
  Eigen::MatrixXd rotations;
  /// The largest von Mises stress of the section at each station [Pa]; empty where there is none.
  Eigen::MatrixXd stress;
  /// Of a body whose surface is known, its elastic coordinates, and the origin of its frame [m].
  Eigen::MatrixXd coordinates, origins;
};

struct Motion {
  Eigen::VectorXd time;           ///< [s]
  std::vector<BodyTrack> bodies;  ///< in the order of the scene
};

/// The motion through states that are given.
/// @param time      of each of them [s]
/// @param state_at  fills in the i-th
Motion sample_motion(const Scene& scene, const Model& model, const Eigen::VectorXd& time,
                     const std::function<void(Eigen::Index, State&)>& state_at);

/// The motion of a simulation at some of its steps.
/// @param steps  ascending
Motion sample_motion(const Scene& scene, const Analysis& analysis, const std::vector<int>& steps);

/// The steps of a simulation at which a moving picture is drawn: equal in time, so close that no
/// body turns by more than some degrees from one to the next, and those at which responses have
/// their peaks.
/// @param most  at most so many, besides the peaks
std::vector<int> frames_of_motion(const Analysis& analysis, int most);

/// Bodies that do not deform, as the drives take them: to the end of the motion, or to where the
/// mechanism locks.
struct RigidMotion {
  RigidPath path;
  Motion motion;  ///< without stress; of one instant where nothing is driven
};

/// @param end   [s]
/// @param step  [s] of the simulation
RigidMotion rigid_motion(const Scene& scene, const Model& model, double end, double step);

/// Of the mechanism of a problem at a design; nothing where nothing is driven or it cannot be assembled.
Motion rigid_motion(const ProblemFile& problem, const Eigen::VectorXd& x);

}  // namespace pleuel
