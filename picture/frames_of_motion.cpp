#include "picture/frames_of_motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "core/base/eager_matrices.hpp"
#include "core/frame/body_frame.hpp"

namespace pleuel {

namespace {

constexpr double turn_of_frame = 4.0 * std::numbers::pi / 180.0;  ///< [rad]
constexpr int fewest = 150;

Eigen::Matrix3d rotation_of(const BodyModel& body, const State& state) {
  const auto own = [&](const Eigen::VectorXd& all) -> Eigen::VectorXd {
    return all.segment(body.frame.offset, body.frame.size());
  };
  const Eigen::VectorXd q = own(state.q), v = own(state.v), a = own(state.a);
  return frame_motion<double>(body.frame, q, v, a).A;
}

double angle_between(const Eigen::Matrix3d& before, const Eigen::Matrix3d& after) {
  const double cosine = ((before.transpose() * after).trace() - 1.0) / 2.0;
  return std::acos(std::clamp(cosine, -1.0, 1.0));
}

/// How far the body that turns most turns [rad], looked at some hundred times.
double largest_turn(const Analysis& analysis) {
  const int steps = analysis.trajectory.steps();
  const int stride = std::max(1, steps / 800);
  std::vector<Eigen::Matrix3d> before;
  std::vector<double> turned(analysis.model.bodies.size(), 0.0);
  State state;
  for (int step = 0; step <= steps; step += stride) {
    analysis.trajectory.states->load(step, state);
    std::vector<Eigen::Matrix3d> now;
    for (const BodyModel& body : analysis.model.bodies) now.push_back(rotation_of(body, state));
    for (std::size_t i = 0; i < before.size(); ++i) turned[i] += angle_between(before[i], now[i]);
    before = std::move(now);
  }
  return turned.empty() ? 0.0 : *std::max_element(turned.begin(), turned.end());
}

void add_peaks(const Analysis& analysis, std::set<int>& steps) {
  for (std::size_t i = 0; i < analysis.responses.size(); ++i) {
    if (!analysis.responses[i].is_peak_over_time()) continue;
    for (const Sample& sample : analysis.reductions[i].samples) steps.insert(sample.step);
  }
}

}  // namespace

std::vector<int> frames_of_motion(const Analysis& analysis, int most) {
  const Eigen::VectorXd& time = analysis.trajectory.time;
  const double wanted = std::ceil(largest_turn(analysis) / turn_of_frame);
  const int frames = static_cast<int>(
      std::clamp(wanted, static_cast<double>(std::min(fewest, most)), static_cast<double>(most)));
  std::set<int> steps = {0, analysis.trajectory.steps()};
  for (int i = 1; i < frames; ++i) {
    const double instant = time(0) + (time(time.size() - 1) - time(0)) * i / frames;
    const auto after = std::lower_bound(time.begin(), time.end(), instant);
    steps.insert(static_cast<int>(after - time.begin()));
  }
  add_peaks(analysis, steps);
  return {steps.begin(), steps.end()};
}

}  // namespace pleuel
