#include "core/model/body_frames.hpp"

#include "core/base/eager_matrices.hpp"

namespace pleuel {

FrameMotion<double> frame_motion(const BodyFrame& frame, const State& state) {
  const int first = frame.offset, size = frame.size();
  return frame_motion<double>(frame, state.q.segment(first, size), state.v.segment(first, size),
                              state.a.segment(first, size));
}

BodyFrame frame_of(const Model& model, const std::string& body) {
  return body == ground_name ? ground_frame() : model.parts(body).front()->frame;
}

Pose<double> relative_pose(const Model& model, const std::string& first, const std::string& second,
                           const State& state) {
  const FrameMotion<double> from = frame_motion(frame_of(model, first), state),
                            to = frame_motion(frame_of(model, second), state);
  return {from.A.transpose() * (to.r - from.r), from.A.transpose() * to.A};
}

std::vector<std::string> moved_bodies(const Model& model, const Eigen::MatrixXd& motions,
                                      double least) {
  std::vector<std::string> names;
  for (const BodyModel& body : model.bodies) {
    const auto own = motions.middleRows(body.frame.offset, body.frame.size());
    if (own.lpNorm<Eigen::Infinity>() <= least) continue;
    if (names.empty() || names.back() != body.name) names.push_back(body.name);
  }
  return names;
}

}  // namespace pleuel
