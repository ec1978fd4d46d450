#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/find_named.hpp"
#include "core/base/quoted.hpp"
#include "core/model/body_energy.hpp"
#include "core/model/body_frames.hpp"
#include "core/scene/body_groups.hpp"
#include "core/scene/joint_kind.hpp"
#include "core/scene/response_parts.hpp"
#include "core/start/degrees_of_freedom.hpp"
#include "core/trust/check_list.hpp"

namespace pleuel {

namespace {

/// Of motions of length one; of works relative to the largest force.
constexpr double visible = 1e-6;
/// Instants at which loads are looked at.
constexpr int instants = 200;
/// Of the scale of a coordinate.
constexpr double idle_speed = 1e-9;

/// Names of the bodies that joints, springs and each other tie to the ground.
std::set<std::string> grounded_bodies(const Scene& scene) {
  const BodyGroups groups(scene);
  std::set<std::string> grounded;
  for (const Body& body : scene.bodies) {
    if (groups.is_grounded(groups.of(body.name))) grounded.insert(body.name);
  }
  return grounded;
}

/// Whether the file gives a body a velocity at the start.
bool has_given_velocity(const Body& body, const std::vector<double>& design) {
  const auto is_given = [&](const Number& number) { return resolve(number, design) != 0.0; };
  return std::ranges::any_of(body.velocity, is_given) ||
         std::ranges::any_of(body.angular_velocity, is_given);
}

/// Whether a force or a torque acts on a body.
bool has_load(const Scene& scene, const std::string& body) {
  return std::ranges::any_of(scene.loads, [&](const Load& load) {
    const auto* point = std::get_if<PointLoad>(&load.element);
    return point && point->body == body;
  });
}

/// Rows of the motions of a body's frame.
auto rows_of(const BodyModel& body, const Eigen::MatrixXd& motions) {
  return motions.middleRows(body.frame.offset, body.frame.size());
}

/// The state of the trajectory with the fewest free motions: no dead centre.
State least_free_state(const Analysis& analysis) {
  State best;
  int fewest = 0;
  const int steps = analysis.trajectory.steps();
  for (int i = 0; i <= 4; ++i) {
    const State state = analysis.trajectory.state_at(i * steps / 4);
    const int free = rigid_degrees_of_freedom(analysis.model.mechanism, state).free();
    if (i > 0 && free >= fewest) continue;
    best = state;
    fewest = free;
    if (free == 0) break;
  }
  return best;
}

class IdleFreedoms {
 public:
  explicit IdleFreedoms(const TrustedRun& run)
      : run_(run), model_(run.analysis.model), design_(run.x.begin(), run.x.end()) {}

  std::vector<Finding> find() {
    if (looks_at_no_motion()) return {};
    state_ = least_free_state(run_.analysis);
    if (rigid_degrees_of_freedom(model_.mechanism, state_).free() <= 0) return {};
    for (const int i : model_.mechanism.elastic) state_.q(i) = 0.0;
    state_ = generic_position(model_.mechanism, state_);
    state_.v.setZero();
    state_.a.setZero();
    state_.lambda.setZero();
    motions_.emplace(model_.mechanism, state_);
    free_ = motions_->some(motions_->rigid());
    if (floats_and_moves()) return {};
    find_forced();
    const std::vector<int> idle = idle_coordinates(true);
    if (motions_->count(idle) > 0) return {describe(idle)};
    if (drive_rows(model_).empty()) return {};
    const std::vector<int> hanging = idle_coordinates(false);
    if (motions_->count(hanging) == 0) return {};
    return {describe_hanging(hanging)};
  }

 private:
  /// Those of the bodies on which nothing acts, and whose spin is not harmless.
  std::vector<int> idle_coordinates(bool weight_counts) {
    std::vector<bool> is_idle;
    for (std::size_t i = 0; i < model_.bodies.size(); ++i) {
      const BodyModel& body = model_.bodies[i];
      is_idle.push_back(moves_freely(body) && !is_acted_on(i, weight_counts) && is_grounded(body));
    }
    for (std::size_t i = 0; i < is_idle.size(); ++i) {
      if (is_idle[i] && spins_harmlessly(model_.bodies[i], is_idle)) is_idle[i] = false;
    }
    return coordinates_of(is_idle, {});
  }

  /// @param name  of the body that is meant; empty: all
  std::vector<int> coordinates_of(const std::vector<bool>& bodies, const std::string& name) const {
    std::vector<int> coordinates;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const BodyModel& body = model_.bodies[i];
      if (!bodies[i] || (!name.empty() && body.name != name)) continue;
      for (int k = 0; k < body.frame.size(); ++k) coordinates.push_back(body.frame.offset + k);
    }
    return coordinates;
  }

  /// Frequencies and masses need no motion.
  bool looks_at_no_motion() const {
    const auto& responses = run_.problem.responses;
    return !responses.empty() &&
           std::ranges::all_of(
               responses,
               [](const ResponseSettings& response) {
                 return response.is<ModeResponse, MassResponse, ExpressionResponse>();
               }) &&
           std::ranges::any_of(responses, [](const ResponseSettings& response) {
             return response.is<ModeResponse>();
           });
  }

  const Body& scene_body(const BodyModel& body) const {
    return *find_named(run_.problem.scene.bodies, body.name);
  }

  bool is_grounded(const BodyModel& body) const {
    return grounded_.empty() || grounded_.contains(body.name);
  }

  bool floats_and_moves() const {
    return grounded_.empty() &&
           std::ranges::any_of(model_.bodies, [&](const BodyModel& body) { return moves(body); });
  }

  bool moves(const BodyModel& body) const {
    const Trajectory& trajectory = run_.analysis.trajectory;
    const State start = trajectory.state_at(0);
    for (int step = 0; step <= trajectory.steps(); ++step) {
      const State state = trajectory.state_at(step);
      const auto change = (state.q - start.q).cwiseQuotient(model_.mechanism.scale).eval();
      if (change.segment(body.frame.offset, body.frame.size()).lpNorm<Eigen::Infinity>() >
          idle_speed) {
        return true;
      }
    }
    return false;
  }

  bool moves_freely(const BodyModel& body) const {
    return rows_of(body, free_).lpNorm<Eigen::Infinity>() > visible;
  }

  bool is_acted_on(std::size_t i, bool weight_counts) const {
    const BodyModel& body = model_.bodies[i];
    return is_forced_[i] || has_given_velocity(scene_body(body), design_) ||
           (weight_counts && has_weight(body));
  }

  bool does_work(const Eigen::VectorXd& force, const BodyModel& body) const {
    const auto part =
        force.segment(body.frame.offset, body.frame.size())
            .cwiseProduct(model_.mechanism.scale.segment(body.frame.offset, body.frame.size()))
            .eval();
    if (part.isZero(0.0)) return false;
    return (rows_of(body, free_).transpose() * part).lpNorm<Eigen::Infinity>() >
           visible * part.lpNorm<Eigen::Infinity>();
  }

  /// Its weight is what is left of the residual of a body at rest.
  bool has_weight(const BodyModel& body) const {
    if (model_.gravity.isZero(0.0)) return false;
    Eigen::VectorXd force = Eigen::VectorXd::Zero(model_.mechanism.system->size());
    Eigen::VectorXd q, v;
    q.setZero(state_.q.size());
    v.setZero(state_.q.size());
    add_energy_gradient(body, model_.gravity, state_, {.weight = 1.0}, q, v);
    force.head(q.size()) = q;
    return does_work(force, body);
  }

  /// On which loads and force elements do work, with any motion and at any time; joints exert none
  /// with λ = 0.
  void find_forced() {
    is_forced_.assign(model_.bodies.size(), false);
    const std::vector<Term*> terms = terms_besides_bodies(model_).acting;
    State state = state_;
    state.v = model_.mechanism.scale.cwiseProduct(
        free_ * Eigen::VectorXd::LinSpaced(free_.cols(), 1.0, 1.7));
    add_forced(terms, state);
    state.v.setZero();
    const double end = run_.problem.simulation.end_time;  // of which the analysis may be a part
    for (int i = 0; i <= instants; ++i) {
      state.time = end * i / instants;
      add_forced(terms, state);
    }
  }

  void add_forced(const std::vector<Term*>& terms, const State& state) {
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < is_forced_.size(); ++i) {
      if (!is_forced_[i] && moves_freely(model_.bodies[i])) open.push_back(i);
    }
    Eigen::VectorXd force(model_.mechanism.system->size());
    for (Term* term : terms) {
      if (open.empty()) return;
      force.setZero();
      term->add_residual(state, ConstraintLevel::position, force);
      std::erase_if(open, [&](std::size_t i) {
        is_forced_[i] = does_work(force, model_.bodies[i]);
        return is_forced_[i];
      });
    }
  }

  /// Whether it is the only body that moves, about an axis through its centre of mass.
  bool spins_harmlessly(const BodyModel& body, const std::vector<bool>& is_idle) const {
    const std::vector<int> coordinates = coordinates_of(is_idle, body.name);
    if (motions_->count(coordinates) != 1) return false;
    return !moves_centre(body, motions_->some(coordinates)) &&
           (is_held_by_points(body.name) || moves(body));
  }

  /// The kinetic energy of the motion that the mass would have in its centre.
  bool moves_centre(const BodyModel& body, const Eigen::MatrixXd& motion) const {
    double work = 0.0, force = 0.0;
    for (int i = 0; i < 3; ++i) {
      Eigen::VectorXd q, v;
      q.setZero(motion.rows());
      v.setZero(motion.rows());
      add_energy_gradient(body, Eigen::Vector3d::Unit(i), state_, {.weight = 1.0}, q, v);
      q = q.cwiseProduct(model_.mechanism.scale);
      work = std::max(work, std::abs(motion.col(0).dot(q)));
      force = std::max(force, q.lpNorm<Eigen::Infinity>());
    }
    return work > visible * force;
  }

  bool is_held_by_points(const std::string& name) const {
    int count = 0;
    for (const Joint& joint : run_.problem.scene.joints) {
      if (joint.bodies[0] != name && joint.bodies[1] != name) continue;
      ++count;
      if (kind_of(joint.type).turns != JointTurns::all) return false;
    }
    return count >= 2;
  }

  /// The bodies that move while all other coordinates are held.
  std::vector<std::string> names_of(const std::vector<int>& coordinates) const {
    return moved_bodies(model_, motions_->some(coordinates), visible);
  }

  std::string count_text(const std::vector<int>& coordinates) const {
    const Eigen::Index count = motions_->count(coordinates);
    return count == 1 ? "one free motion" : fmt::format("{} free motions", count);
  }

  /// A payload that swings is meant, a linkage that lacks a joint is not.
  Finding describe_hanging(const std::vector<int>& hanging) const {
    const std::vector<std::string> names = names_of(hanging);
    return {fmt::format("beside the drives {} can move freely ({}), with nothing but weight that "
                        "acts on {}: a pendulum, or is a joint missing?",
                        quoted(names), count_text(hanging), names.size() == 1 ? "it" : "them"),
            false, concerned(names), names};
  }

  Finding describe(const std::vector<int>& idle) const {
    const std::vector<std::string> names = names_of(idle);
    const bool is_moved = std::ranges::any_of(model_.bodies, [&](const BodyModel& body) {
      return std::ranges::find(names, body.name) != names.end() && moves(body);
    });
    Finding finding;
    finding.text = fmt::format(
        "{} can move freely ({}), and no drive, load, spring, damper, weight or initial velocity "
        "acts on {}: {}. Is a joint or a drive missing? If it is meant, put a damper, however "
        "weak, into the joint that is free.",
        quoted(names), count_text(idle), names.size() == 1 ? "it" : "them",
        is_moved ? "only the inertia of the rest moves what is free" : "nothing moves there");
    finding.responses = concerned(names);
    finding.bodies = names;
    finding.is_serious = !finding.responses.empty();
    return finding;
  }

  /// Responses of the bodies, of their joints, and of the whole mechanism.
  std::vector<std::string> concerned(const std::vector<std::string>& names) const {
    return names_made_of(run_.problem, [&](const ResponseSettings& response) {
      const std::vector<std::string> about = bodies_about(response, run_.problem.scene);
      return !response.is<MassResponse>() &&
             (about.empty() || std::ranges::find_first_of(about, names) != about.end());
    });
  }

  const TrustedRun& run_;
  const Model& model_;
  std::vector<double> design_;
  State state_;
  std::optional<FreeMotions> motions_;  ///< there
  Eigen::MatrixXd free_;                ///< some of the whole mechanism
  std::vector<bool> is_forced_;         ///< one a body
  std::set<std::string> grounded_ = grounded_bodies(run_.problem.scene);
};

}  // namespace

std::vector<Finding> check_unactuated_freedoms(const TrustedRun& run) {
  return IdleFreedoms(run).find();
}

std::vector<Finding> check_unconnected_bodies(const TrustedRun& run) {
  const Scene& scene = run.problem.scene;
  const std::set<std::string> grounded = grounded_bodies(scene);
  const std::vector<double> design(run.x.begin(), run.x.end());
  std::vector<std::string> names;
  bool is_pushed = false;
  for (const Body& body : scene.bodies) {
    if (grounded.contains(body.name)) continue;
    // Of a group that somebody throws, nothing is forgotten.
    if (has_given_velocity(body, design)) return {};
    is_pushed = is_pushed || has_load(scene, body.name);
    names.push_back(body.name);
  }
  const bool has_weight = !run.analysis.model.gravity.isZero(0.0);
  // Where nothing acts on a mechanism that is free as a whole, its vibrations are asked for.
  const bool is_free = grounded.empty();
  if (names.empty() || (is_free && !is_pushed && !has_weight)) return {};
  Finding finding;
  finding.text = fmt::format(
      "no joint or spring connects {} with the ground, directly or by way of other bodies, and no "
      "initial velocity is given: {}. Is a joint missing?",
      quoted(names),
      is_pushed    ? "loads push it away"
      : has_weight ? "falls"
                   : "nothing moves there");
  for (const ResponseSettings& response : run.problem.responses) {
    const std::vector<std::string> about = bodies_of(response);
    const bool looks_there = std::ranges::find_first_of(about, names) != about.end();
    if (looks_there && !response.is<MassResponse>()) {
      finding.responses.push_back(response.name);
    }
  }
  finding.is_serious = !finding.responses.empty() && !is_pushed && !is_free;
  finding.bodies = names;
  return {finding};
}

}  // namespace pleuel
