#pragma once

#include <string>
#include <vector>

#include "core/frame/body_frame.hpp"
#include "core/model/model.hpp"

/// Frames of bodies in a state, deformation left out.
namespace pleuel {

FrameMotion<double> frame_motion(const BodyFrame& frame, const State& state);

/// Of a body of the scene, or of the ground; of a divided beam that of its first part.
BodyFrame frame_of(const Model& model, const std::string& body);

/// That of the second body as the first one sees it.
Pose<double> relative_pose(const Model& model, const std::string& first, const std::string& second,
                           const State& state);

/// Names of the bodies of which one of these motions moves a coordinate of a frame by more than `least`.
/// @param motions  coordinates × motions
std::vector<std::string> moved_bodies(const Model& model, const Eigen::MatrixXd& motions,
                                      double least);

}  // namespace pleuel
