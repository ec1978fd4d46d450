#pragma once

#include <functional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/response/analysis.hpp"

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

}  // namespace pleuel
