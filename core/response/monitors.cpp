#include "core/response/monitors.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/quoted.hpp"
#include "core/model/body_energy.hpp"
#include "core/model/body_frames.hpp"
#include "core/start/redundancy.hpp"

namespace pleuel {

namespace {

/// Shares of a sum above this are more than round-off.
constexpr double resolved = 1e-12;

/// ∫₀ᵗ power dt in every instant, by the trapezoidal rule.
Eigen::VectorXd integral(const Eigen::VectorXd& time, const Eigen::VectorXd& power) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(power.size());
  for (Eigen::Index i = 1; i < power.size(); ++i) {
    sum(i) = sum(i - 1) + 0.5 * (time(i) - time(i - 1)) * (power(i - 1) + power(i));
  }
  return sum;
}

/// θx θy θz of all places of a body from its elastic coordinates, without rows of zeros.
SparseMatrix rotation_rows(const BodyModel& body) {
  const SparseMatrix& shape = body.places.shape;
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::Index rows = 0;
  for (Eigen::Index row = 0; body.is_elastic && row < shape.rows(); ++row) {
    if (row % 6 < 3 || shape.row(row).nonZeros() == 0) continue;
    for (SparseMatrix::InnerIterator entry(shape, row); entry; ++entry) {
      entries.emplace_back(rows, entry.col(), entry.value());
    }
    ++rows;
  }
  SparseMatrix rotations(rows, body.elastic_size());
  rotations.setFromTriplets(entries.begin(), entries.end());
  return rotations;
}

class Monitoring {
 public:
  Monitoring(const Model& model, const Trajectory& trajectory)
      : model_(model),
        trajectory_(trajectory),
        terms_(terms_besides_bodies(model)),
        residual_(model.mechanism.system->size()) {
    for (const BodyModel& body : model.bodies) rotation_rows_.push_back(rotation_rows(body));
  }

  Monitors run() {
    const Eigen::Index instants = trajectory_.time.size();
    for (auto* history : {&kinetic_, &elastic_, &weight_, &stretching_, &acting_}) {
      history->resize(instants);
    }
    for (Eigen::Index i = 0; i < instants; ++i) {
      trajectory_.states->load(static_cast<int>(i), state_);
      observe_bodies(i);
      observe_terms(i);
    }
    balance();
    require_finite();
    return std::move(monitors_);
  }

 private:
  void observe_bodies(Eigen::Index instant) {
    const BodyEnergy sum = energy_of_bodies(model_, state_);
    kinetic_(instant) = sum.kinetic;
    elastic_(instant) = sum.elastic;
    weight_(instant) = sum.weight;
    acting_(instant) = -sum.dissipation;
    for (std::size_t i = 0; i < model_.bodies.size(); ++i) observe_rotations(i);
  }

  void observe_rotations(std::size_t body) {
    const BodyModel& model = model_.bodies[body];
    rotations_.noalias() =
        rotation_rows_[body] * state_.q.segment(model.elastic_offset(), model.elastic_size());
    const double rotation = rotations_.size() > 0 ? rotations_.lpNorm<Eigen::Infinity>() : 0.0;
    if (rotation <= monitors_.elastic_rotation) return;
    monitors_.elastic_rotation = rotation;
    monitors_.most_bent = model.name;
  }

  /// One evaluation of joints at position level gives Φ and their forces.
  void observe_terms(Eigen::Index instant) {
    evaluate(terms_.stiffening, ConstraintLevel::position);
    stretching_(instant) = power();
    evaluate(terms_.acting, ConstraintLevel::position);
    acting_(instant) += power();
    monitors_.position_drift = std::max(monitors_.position_drift, drift());
    evaluate(model_.terms.joints, ConstraintLevel::velocity);
    monitors_.velocity_drift = std::max(monitors_.velocity_drift, drift());
  }

  void evaluate(const std::vector<Term*>& terms, ConstraintLevel level) {
    residual_.setZero();
    for (Term* term : terms) term->add_residual(state_, level, residual_);
  }
  double power() const { return -state_.v.dot(residual_.head(state_.v.size())); }
  /// Of the constraints that are kept: those that are left out hold as well as joints are aligned.
  double drift() {
    const Eigen::Index n = state_.q.size();
    for (int row : model_.mechanism.system->left_out()) residual_(n + row) = 0.0;
    return residual_.tail(state_.lambda.size()).lpNorm<Eigen::Infinity>();
  }

  void balance() {
    elastic_ -= integral(trajectory_.time, stretching_);
    monitors_.work = integral(trajectory_.time, acting_);
    monitors_.energy = kinetic_ + elastic_ + weight_;
    // Changes that are lost in the last digits of the potential are none.
    const double round_off = energy_of_round_off();
    double largest = std::max(round_off, resolved * weight_.lpNorm<Eigen::Infinity>());
    weight_.array() -= weight_(0);
    for (const auto* part : {&kinetic_, &elastic_, &weight_, &monitors_.work}) {
      largest = std::max(largest, part->lpNorm<Eigen::Infinity>());
    }
    if (largest == 0.0) return;
    const Eigen::VectorXd error = (monitors_.energy - monitors_.work).array() - monitors_.energy(0);
    monitors_.energy_error = error.lpNorm<Eigen::Infinity>() / largest;
    const double elastic = elastic_.lpNorm<Eigen::Infinity>();
    if (elastic > round_off)
      monitors_.elastic_energy_error = monitors_.energy_error * largest / elastic;
  }

  /// What displacements hold that are lost in the last digits of a length of the mechanism, and their
  /// rates in its time: all that moves where nothing acts.
  double energy_of_round_off() const {
    const Mechanism& mechanism = model_.mechanism;
    if (mechanism.scale.size() == 0) return 0.0;
    const double length = resolved * mechanism.scale.maxCoeff();
    const double speed = length / trajectory_.time(trajectory_.time.size() - 1);
    double energy = 0.0;
    for (const BodyModel& body : model_.bodies) {
      energy += 0.5 * body.mass * speed * speed;
      if (body.elastic_size() == 0) continue;
      const double stiffness = body.invariants.stiffness.lpNorm<Eigen::Infinity>();
      energy += 0.5 * stiffness * length * length;
    }
    return energy;
  }

  /// A sum of squares is beyond the range of numbers before the motion is.
  void require_finite() const {
    const Eigen::VectorXd sum = monitors_.energy + monitors_.work;
    for (Eigen::Index i = 0; i < sum.size(); ++i) {
      if (std::isfinite(sum(i))) continue;
      throw SimulationError(fmt::format(
          "the energy of the mechanism is not finite at t = {:.6g} s. Look for numbers of the file "
          "that are out of proportion",
          trajectory_.time(i)));
    }
    if (std::isfinite(monitors_.position_drift) && std::isfinite(monitors_.velocity_drift)) return;
    throw SimulationError("constraints are not finite in some instant");
  }

  const Model& model_;
  const Trajectory& trajectory_;
  TermsBesidesBodies terms_;
  std::vector<SparseMatrix> rotation_rows_;  ///< of each body
  State state_;
  Eigen::VectorXd residual_, rotations_;
  Eigen::VectorXd kinetic_, elastic_, weight_;  ///< energies [J]
  Eigen::VectorXd stretching_, acting_;         ///< powers on the bodies [W]
  Monitors monitors_;
};

}  // namespace

Monitors monitor(const Model& model, const Trajectory& trajectory) {
  return Monitoring(model, trajectory).run();
}

namespace {

/// Parts of a motion of length one that are more than round-off.
constexpr double visible = 1e-3;

std::vector<std::string> joints_of(const NearRedundancy& near, const Model& model) {
  std::vector<std::string> names;
  for (const JointModel& joint : model.joints) {
    const auto is_its = [&joint](int row) {
      return joint.first_multiplier <= row && row < joint.first_multiplier + joint.equations();
    };
    if (joint.is_division) continue;
    if (is_its(near.constraint) || std::ranges::any_of(near.others, is_its)) {
      names.push_back(joint.name);
    }
  }
  return names;
}

}  // namespace

std::string Misalignment::text() const {
  const std::string motion =
      bodies.empty() ? "one deformation" : fmt::format("a motion of {}", quoted(bodies));
  return fmt::format(
      "the joints {} would hold {} twice if they were aligned; they are out of line by "
      "only {:.1g} (rad, or of the mechanism's size), which blocks that motion or makes the forces "
      "in them huge. Align their points and axes exactly, or let one of them free what the others "
      "hold.",
      quoted(joints), motion, size);
}

std::vector<Misalignment> find_misalignments(const Model& model, const State& state,
                                             double largest) {
  std::vector<Misalignment> found;
  for (const NearRedundancy& near :
       nearly_redundant_constraints(model.mechanism, state, drive_rows(model), largest)) {
    Misalignment misalignment{joints_of(near, model), moved_bodies(model, near.motion, visible),
                              near.misalignment};
    const auto same = std::ranges::find_if(
        found, [&](const Misalignment& other) { return other.joints == misalignment.joints; });
    if (same == found.end()) {
      found.push_back(std::move(misalignment));
    } else if (misalignment.size < same->size) {
      *same = std::move(misalignment);
    }
  }
  return found;
}

}  // namespace pleuel
