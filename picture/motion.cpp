#include "picture/motion.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>
#include <set>
#include <utility>

#include <Eigen/Geometry>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/int_size.hpp"
#include "core/mobility/lock.hpp"
#include "core/model/body_frames.hpp"
#include "core/response/signal_of_body.hpp"

namespace pleuel {

namespace {

/// Of one beam; thinned where the mesh is finer.
constexpr std::size_t fewest_stations = 13, most_stations = 33;

/// Shares of the nodes of a beam, of all its parts.
std::vector<double> node_shares(const std::vector<const BodyModel*>& parts) {
  std::vector<double> shares = {0.0};
  for (const BodyModel* part : parts) {
    const double length = part->beam.node_position(part->beam.node_count() - 1);
    for (int node = 1; node < part->beam.node_count(); ++node) {
      shares.push_back(part->stretch.of_whole(part->beam.node_position(node) / length));
    }
  }
  shares.back() = 1.0;
  return shares;
}

/// Every k-th, with both ends.
std::vector<double> sparser(const std::vector<double>& shares) {
  if (shares.size() <= most_stations) return shares;
  const std::size_t stride = (shares.size() + most_stations - 2) / (most_stations - 1);
  std::vector<double> kept;
  for (std::size_t i = 0; i + 1 < shares.size(); i += stride) kept.push_back(shares[i]);
  kept.push_back(shares.back());
  return kept;
}

/// With so many points between as make a smooth curve.
std::vector<double> denser(const std::vector<double>& shares) {
  const std::size_t between = (fewest_stations - 2) / (shares.size() - 1) + 1;
  if (shares.size() >= fewest_stations || between < 2) return shares;
  std::vector<double> all;
  for (std::size_t i = 0; i + 1 < shares.size(); ++i) {
    for (std::size_t k = 0; k < between; ++k) {
      const double part = static_cast<double>(k) / static_cast<double>(between);
      all.push_back(shares[i] + part * (shares[i + 1] - shares[i]));
    }
  }
  all.push_back(shares.back());
  return all;
}

std::vector<double> beam_stations(const std::vector<const BodyModel*>& parts) {
  const bool is_elastic = std::any_of(parts.begin(), parts.end(),
                                      [](const BodyModel* part) { return part->is_elastic; });
  if (!is_elastic) return {0.0, 0.25, 0.5, 0.75, 1.0};
  return denser(sparser(node_shares(parts)));
}

int part_at(const std::vector<const BodyModel*>& parts, double share) {
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (share <= parts[i]->stretch.end + 1e-9) return static_cast<int>(i);
  }
  return int_size(parts) - 1;
}

/// Observes one body instant by instant.
class BodySampler {
 public:
  BodySampler(const Body& body, const Model& model, Eigen::Index instants)
      : parts_(model.parts(body.name)) {
    motion_.body = body.name;
    if (parts_.front()->is_beam()) {
      add_beam_stations(model);
    } else if (parts_.front()->is_imported()) {
      add_imported_places(model);
      const auto& imported = std::get<ImportedBody>(body.shape);
      has_surface_ = parts_.front()->is_elastic && imported.file->surface.has_value();
    } else {
      motion_.stations = {0.0};
      motion_.parts = {0};
      add_position({body.name}, model);
    }
    motion_.positions.resize(positions_.size(), instants);
    motion_.rotations.resize(4 * static_cast<Eigen::Index>(parts_.size()), instants);
    motion_.stress.resize(stresses_.size(), stresses_.empty() ? 0 : instants);
    if (!has_surface_) return;
    motion_.coordinates.resize(parts_.front()->elastic_size(), instants);
    motion_.origins.resize(3, instants);
  }

  void see(const State& state, Eigen::Index instant) {
    for (std::size_t i = 0; i < positions_.size(); ++i) {
      positions_[i]->observe(state, number_);
      motion_.positions(i, instant) = number_(0);
    }
    for (std::size_t i = 0; i < stresses_.size(); ++i) {
      points_.resize(stresses_[i]->channels());
      stresses_[i]->observe(state, points_);
      motion_.stress(i, instant) = points_.maxCoeff();
    }
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      motion_.rotations.block<4, 1>(4 * static_cast<Eigen::Index>(i), instant) =
          quaternion_of(parts_[i]->frame, state);
    }
    if (!has_surface_) return;
    const BodyModel& body = *parts_.front();
    motion_.coordinates.col(instant) = state.q.segment(body.elastic_offset(), body.elastic_size());
    motion_.origins.col(instant) = frame_motion(body.frame, state).r;
  }

  BodyTrack take() { return std::move(motion_); }

 private:
  void add_position(const ResponsePoint& point, const Model& model) {
    for (int direction = 0; direction < 3; ++direction) {
      const PointMotionResponse motion{point, {direction}};
      positions_.push_back(make_signal_of_body({point.body, motion}, model));
    }
  }

  void add_beam_stations(const Model& model) {
    motion_.stations = beam_stations(parts_);
    for (const double share : motion_.stations) {
      motion_.parts.push_back(part_at(parts_, share));
      add_position({motion_.body, share}, model);
    }
    if (!parts_.front()->is_elastic) return;
    for (const double share : motion_.stations) {
      const StressResponse stress{{.bodies = {motion_.body}, .station = share}};
      try {
        stresses_.push_back(make_signal_of_body({motion_.body, stress}, model));
      } catch (const InputError&) {  // no such stress of this body
        stresses_.clear();
        return;
      }
    }
  }

  void add_imported_places(const Model& model) {
    const BodyPlaces& places = parts_.front()->places;
    std::vector<int> order(places.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](int a, int b) { return places.positions(0, a) < places.positions(0, b); });
    for (const int place : order) {
      motion_.stations.push_back(places.positions(0, place));
      motion_.parts.push_back(0);
      add_position({motion_.body, 0.0, places.names[place]}, model);
    }
  }

  static Eigen::Vector4d quaternion_of(const BodyFrame& frame, const State& state) {
    return Eigen::Quaterniond(Eigen::Matrix3d(frame_motion(frame, state).A)).normalized().coeffs();
  }

  BodyTrack motion_;
  std::vector<const BodyModel*> parts_;
  bool has_surface_ = false;
  std::vector<std::unique_ptr<Signal>> positions_, stresses_;
  Eigen::VectorXd number_ = Eigen::VectorXd::Zero(1), points_;
};

}  // namespace

Motion sample_motion(const Scene& scene, const Model& model, const Eigen::VectorXd& time,
                     const std::function<void(Eigen::Index, State&)>& state_at) {
  std::vector<BodySampler> samplers;
  for (const Body& body : scene.bodies) samplers.emplace_back(body, model, time.size());
  State state(model.mechanism.system->coordinates(), model.mechanism.system->multipliers());
  for (Eigen::Index i = 0; i < time.size(); ++i) {
    state_at(i, state);
    for (BodySampler& sampler : samplers) sampler.see(state, i);
  }
  Motion motion;
  motion.time = time;
  for (BodySampler& sampler : samplers) motion.bodies.push_back(sampler.take());
  return motion;
}

Motion sample_motion(const Scene& scene, const Analysis& analysis, const std::vector<int>& steps) {
  Eigen::VectorXd time(std::ssize(steps));
  for (Eigen::Index i = 0; i < time.size(); ++i) time(i) = analysis.trajectory.time(steps[i]);
  return sample_motion(scene, analysis.model, time, [&](Eigen::Index i, State& state) {
    analysis.trajectory.states->load(steps[i], state);
  });
}

namespace {

constexpr double turn_of_frame = 4.0 * std::numbers::pi / 180.0;  ///< [rad]
constexpr int fewest = 150;

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
  for (int step = 0; step <= steps; step += stride) {
    const State state = analysis.trajectory.state_at(step);
    std::vector<Eigen::Matrix3d> now;
    for (const BodyModel& body : analysis.model.bodies) {
      now.push_back(frame_motion(body.frame, state).A);
    }
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

RigidMotion rigid_motion(const Scene& scene, const Model& model, double end, double step) {
  std::vector<double> time;
  std::vector<Eigen::VectorXd> positions;
  const auto see = [&](double now, const Eigen::VectorXd& q) {
    time.push_back(now);
    positions.push_back(q);
  };
  RigidMotion rigid{follow_drives(model, end, step, see), {}};
  if (positions.empty()) see(0.0, model.mechanism.guess.q);
  const Eigen::VectorXd instants = Eigen::Map<Eigen::VectorXd>(time.data(), std::ssize(time));
  rigid.motion = sample_motion(scene, model, instants,
                               [&](Eigen::Index i, State& state) { state.q = positions[i]; });
  for (BodyTrack& body : rigid.motion.bodies) body.stress.resize(0, 0);
  return rigid;
}

Motion rigid_motion(const ProblemFile& problem, const Eigen::VectorXd& x) {
  const Eigen::VectorXd start = start_design(problem);
  try {
    const Model model = build_model(problem.scene, problem.effects, {start.begin(), start.end()},
                                    {x.begin(), x.end()}, std::nullopt);
    RigidMotion rigid =
        rigid_motion(problem.scene, model, problem.simulation.end_time, problem.simulation.step);
    return rigid.motion.time.size() > 1 ? std::move(rigid.motion) : Motion();
  } catch (const SimulationError&) {
    return {};
  }
}

}  // namespace pleuel
