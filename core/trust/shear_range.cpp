#include "core/trust/shear_range.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/find_named.hpp"
#include "core/base/int_size.hpp"
#include "core/base/sparse_rows.hpp"
#include "core/model/body_energy.hpp"
#include "core/scene/body_groups.hpp"
#include "core/trust/beam_bending.hpp"
#include "core/trust/beam_state.hpp"
#include "core/trust/shear_in_modes.hpp"
#include "core/trust/shear_share.hpp"

namespace pleuel {

namespace {

/// Errors that are as good as none, relative.
constexpr double tolerable_shear = 0.01;
/// From here on numbers are those of another beam. Below, that shear is missing is a property of
/// the theory that is used, as good as it is for most machines.
constexpr double alarming = 0.1;

class ShearDoubts {
 public:
  explicit ShearDoubts(const TrustedRun& run)
      : run_(run), model_(run.analysis.model), groups_(run.problem.scene), modes_(run) {}

  std::vector<Doubt> find() {
    is_held_twice_ = is_held_twice();
    const auto largest = largest_deformations(model_, run_.analysis.trajectory);
    State state;
    for (std::size_t i = 0; i < model_.bodies.size(); ++i) {
      const BodyModel& body = model_.bodies[i];
      if (!body.is_beam() || !body.is_elastic || largest[i].bending <= known_[body.name]) continue;
      known_[body.name] = largest[i].bending;
      steps_[body.name] = largest[i].bending_step;
      run_.analysis.trajectory.states->load(largest[i].bending_step, state);
      shares_[body.name] = shear_share(run_.problem, run_.x, model_, body.name, state);
    }
    std::vector<Doubt> doubts;
    for (const auto& [body, share] : shares_) add_doubt(body, share, doubts);
    add_sums(doubts);
    return doubts;
  }

 private:
  /// Whether joints and drives hold more than rigid bodies need, in every position, and that
  /// bears something: then section forces are those of deformation. Five instants are enough, of
  /// which not all are dead centres. A planar loop in space bears nothing across.
  bool is_held_twice() const {
    constexpr double nothing = 1e-6;
    const int steps = run_.analysis.trajectory.steps();
    double most = 0.0;
    State state;
    for (int i = 0; i <= 4; ++i) {
      run_.analysis.trajectory.states->load(i * steps / 4, state);
      const std::optional<double> share = share_beyond_need(state);
      if (!share) return false;
      most = std::max(most, *share);
    }
    return most > nothing;
  }

  /// Of the multipliers, what rigid bodies could do without: combinations of constraints in which
  /// the coordinates of frames cancel. None where there is no such combination.
  std::optional<double> share_beyond_need(const State& state) const {
    const Mechanism& mechanism = model_.mechanism;
    System& system = *mechanism.system;
    const int n = system.coordinates(), m = system.multipliers();
    if (m == 0) return std::nullopt;
    std::vector<int> place(m, 0), rows;
    for (const int row : system.left_out()) place[row] = -1;
    for (int row = 0; row < m; ++row) {
      int& of_row = place[row];
      if (of_row < 0) continue;
      of_row = int_size(rows);
      rows.push_back(row);
    }
    std::vector<bool> is_elastic(n, false);
    for (const int i : mechanism.elastic) is_elastic[i] = true;
    System::Matrix matrix = system.make_matrix();
    system.tangent(state, {.q = 1.0}, ConstraintLevel::position, matrix);
    std::vector<Eigen::Triplet<double>> entries;  // a row for each coordinate of a frame
    for (int i = 0; i < n; ++i) {
      if (is_elastic[i]) continue;
      for (System::Matrix::InnerIterator entry(matrix, i); entry; ++entry) {
        if (entry.row() < n || place[entry.row() - n] < 0) continue;
        entries.emplace_back(i, place[entry.row() - n], mechanism.scale(i) * entry.value());
      }
    }
    SparseRows of_frames(n, rows.size());
    of_frames.setFromTriplets(entries.begin(), entries.end());
    const Eigen::MatrixXd beyond = null_space_of_rows(of_frames, 1e-9);
    if (beyond.cols() == 0) return std::nullopt;
    const Eigen::VectorXd lambda = state.lambda(rows);
    if (lambda.isZero(0.0)) return 0.0;
    return (beyond.transpose() * lambda).norm() / lambda.norm();
  }

  void add_doubt(const std::string& body, const ShearShare& share, std::vector<Doubt>& doubts) {
    double worst = 0.0;
    std::vector<std::string> responses;
    for (std::size_t i = 0; i < run_.problem.responses.size(); ++i) {
      const double error = error_of(i, body, share);
      if (error <= tolerable_shear) continue;
      worst = std::max(worst, error);
      responses.push_back(run_.problem.responses[i].name);
    }
    if (responses.empty()) return;
    std::string names;
    for (const std::string& name : responses) {
      names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", name);
    }
    const bool is_serious = worst > alarming;
    doubts.push_back(
        {fmt::format(
             "\"{}\" is stubby: shear, which it leaves out, would change {} by {} {:.2g} %{}.{}",
             body, names, is_held_twice_ ? "up to" : "some", 100.0 * worst,
             is_serious ? " of what it is with shear" : "", advice(body, is_serious)),
         is_serious, responses});
  }

  /// Where the shear of several beams adds up to more than is tolerable of each.
  void add_sums(std::vector<Doubt>& doubts) {
    for (std::size_t i = 0; i < run_.problem.responses.size(); ++i) {
      const ResponseSettings& response = run_.problem.responses[i];
      if (!is_of_all_bodies(response)) continue;
      double sum = 0.0, largest = 0.0;
      std::vector<std::string> bodies;
      for (const auto& [body, share] : shares_) {
        const double error = error_of(i, body, share);
        if (error > 0.1 * tolerable_shear) bodies.push_back(fmt::format("\"{}\"", body));
        sum += error;
        largest = std::max(largest, error);
      }
      const bool is_said = largest > alarming || (largest > tolerable_shear && sum <= alarming);
      if (sum <= tolerable_shear || is_said) continue;
      const bool is_serious = sum > alarming;
      doubts.push_back(
          {fmt::format("shear, which {} leave out, would change \"{}\" by some {:.2g} % together. "
                       "{}: set their \"shear\" to true.",
                       fmt::join(bodies, ", "), response.name, 100.0 * sum,
                       is_serious ? "Do not trust that" : "Where that matters"),
           is_serious,
           {response.name}});
    }
  }

  /// Whether the deformation of all bodies moves it.
  static bool is_of_all_bodies(const ResponseSettings& response) {
    switch (response.type) {
      case ResponseType::position:
        return true;
      case ResponseType::deflection:
        return response.against == DeflectionReference::rigid_mechanism;
      case ResponseType::elastic_energy:
      case ResponseType::frequency:
        return response.bodies.empty();
      default:
        return false;
    }
  }

  std::string advice(const std::string& body, bool is_serious) const {
    const auto& segments = scene_beam(body).segments;
    const bool is_known = std::all_of(segments.begin(), segments.end(), [](const Segment& segment) {
      const auto* general = std::get_if<GeneralSection>(&segment.section);
      return general == nullptr || general->shear_area_y;
    });
    return fmt::format(
        " {}: set /scene/bodies/{}/shear to true{}.",
        is_serious ? "Do not trust that" : "Where that matters", body,
        is_known ? "" : ", and give its section \"shear_area_y\" and \"shear_area_z\"");
  }

  const BeamBody& scene_beam(const std::string& body) const {
    return std::get<BeamBody>(find_named(run_.problem.scene.bodies, body)->shape);
  }

  /// Whether a body is tied to what a response is about.
  bool depends_on(const ResponseSettings& response, const std::string& body) const {
    std::vector<std::string> about = response.bodies;
    const Joint* joint = find_named(run_.problem.scene.joints, response.joint);
    if (joint != nullptr) about.insert(about.end(), joint->bodies.begin(), joint->bodies.end());
    std::erase(about, ground_name);
    return about.empty() || std::ranges::any_of(about, [&](const std::string& other) {
             return groups_.of(other) == groups_.of(body);
           });
  }

  /// What shear that is left out changes of a response, over what it is with shear.
  double error_of(std::size_t index, const std::string& body, const ShearShare& share) {
    const ResponseSettings& response = run_.problem.responses[index];
    if (scene_beam(body).has_shear || !depends_on(response, body)) return 0.0;
    const bool is_of_body =
        std::find(response.bodies.begin(), response.bodies.end(), body) != response.bodies.end();
    const double largest = share.largest() / (1.0 + share.largest());
    switch (response.type) {
      case ResponseType::deflection: {
        if (response.against == DeflectionReference::rigid_mechanism) return moved(index, share);
        if (response.direction == 0 || !is_of_body) return 0.0;  // along the beam
        const ShearShare there = share_at(body, response.at);
        const double own = response.direction == 1   ? there.along_y
                           : response.direction == 2 ? there.along_z
                                                     : there.largest();
        return own / (1.0 + own);
      }
      case ResponseType::position:
        return moved(index, share);
      case ResponseType::elastic_energy:
        if (response.bodies.empty()) return largest * energy_share(body);
        return is_of_body ? largest : 0.0;
      case ResponseType::buckling:
      case ResponseType::lateral_buckling:
        return is_of_body ? euler_share(body) : 0.0;
      case ResponseType::frequency:
        if (response.bodies.empty()) return modes_.of_mechanism(body, index);
        return is_of_body ? modes_.of_body(body, response.mode) : 0.0;
      case ResponseType::stress:
      case ResponseType::fatigue:
      case ResponseType::fatigue_damage:
      case ResponseType::shear_stress:
      case ResponseType::section_force:
        return is_held_twice_ && is_of_body ? largest : 0.0;
      case ResponseType::reaction_force:
      case ResponseType::reaction_moment:
      case ResponseType::drive_torque:
      case ResponseType::drive_force:
      case ResponseType::drive_power:
        return is_held_twice_ ? largest : 0.0;
      default:
        return 0.0;
    }
  }

  /// Where the beam bends most, of the deflection at a place.
  ShearShare share_at(const std::string& body, double place) const {
    State state;
    run_.analysis.trajectory.states->load(steps_.at(body), state);
    return shear_share(run_.problem, run_.x, model_, body, state, place);
  }

  /// Of the range of a position or a deflection against the rigid mechanism.
  double moved(std::size_t index, const ShearShare& share) const {
    const Eigen::MatrixXd& history = run_.analysis.histories[index];
    if (history.size() == 0) return 0.0;
    const double largest = share.largest();
    const double range = std::max(history.maxCoeff() - history.minCoeff(), 1e-300);
    return std::min(largest * share.displacement / range, largest / (1.0 + largest));
  }

  /// Shear lowers Euler's load P to P/(1 + s), s = π² EI/(κ G A L²). What buckles first is the
  /// plane with the smaller load, mostly that in which shear is the smaller part.
  double euler_share(const std::string& name) const {
    const BodyModel& body = model_.body(name);
    const BendingReader reader(run_.problem, run_.x, name);
    const double length = body.beam.node_position(body.beam.node_count() - 1);
    const Eigen::MatrixXd straight = Eigen::MatrixXd::Zero(6, body.beam.node_count());
    double without = std::numeric_limits<double>::infinity(), with = without;  // EI, EI/(1 + s)
    for (int plane = 0; plane < 2; ++plane) {
      double least = std::numeric_limits<double>::infinity(), share = 0.0;
      for (const ElementBending& element : reader.read(body, straight, plane)) {
        least = std::min(least, element.stiffness);
        share = std::max(share, element.stiffness / element.shear_stiffness);
      }
      share *= std::numbers::pi * std::numbers::pi / (length * length);
      without = std::min(without, least);
      with = std::min(with, least / (1.0 + share));
    }
    return 1.0 - with / without;
  }

  /// How much of the elastic energy of all bodies is in one, where it bends most.
  double energy_share(const std::string& name) const {
    State state;
    run_.analysis.trajectory.states->load(steps_.at(name), state);
    double own = 0.0, all = 0.0;
    for (const BodyModel& body : model_.bodies) {
      const double energy = body_energy(body, body.invariants, model_.gravity, state).elastic;
      all += energy;
      if (body.name == name) own += energy;
    }
    return all > 0.0 ? own / all : 0.0;
  }

  const TrustedRun& run_;
  const Model& model_;
  BodyGroups groups_;
  bool is_held_twice_ = false;
  std::map<std::string, double> known_;  ///< largest rotations [rad]
  std::map<std::string, int> steps_;     ///< of these
  std::map<std::string, ShearShare> shares_;
  ShearInModes modes_;
};

}  // namespace

std::vector<Doubt> doubt_shear_range(const TrustedRun& run) {
  return ShearDoubts(run).find();
}

}  // namespace pleuel
