#include "core/response/validity.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"

namespace pleuel {

namespace {

/// A joint that is apart by this share of the shortest beam, or by so many radians, is no joint.
constexpr double most_drift = 1e-3;
/// A looser tolerance of Newton's method is no drift.
constexpr double most_tolerances = 100.0;
/// So many instants are looked at.
constexpr int looks = 8;

/// Length of the shortest beam [m]; without beams the scale of the mechanism.
double shortest_length(const Model& model) {
  double shortest = std::numeric_limits<double>::infinity();
  for (const BodyModel& body : model.bodies) {
    if (!body.is_beam()) continue;
    shortest = std::min(shortest, body.beam.node_position(body.beam.node_count() - 1));
  }
  return std::isfinite(shortest) ? shortest : model.mechanism.scale.maxCoeff();
}

bool keeps_positions(const Formulation& formulation) {
  return formulation.constraints != ConstraintForm::index_1 || formulation.is_projected;
}

/// The first instant at which a history is not finite; none if all of it is.
std::optional<Eigen::Index> first_not_finite(const Eigen::MatrixXd& history) {
  if (history.allFinite()) return std::nullopt;
  for (Eigen::Index i = 0; i < history.cols(); ++i) {
    if (!history.col(i).allFinite()) return i;
  }
  return std::nullopt;
}

constexpr const char* advice =
    "Look for numbers of the file that are out of proportion (sizes, densities, stiffness, units)";

}  // namespace

ConstraintGuard::ConstraintGuard(const Model& model, const SimulationOptions& options)
    : model_(model),
      terms_(terms_besides_bodies(model)),
      is_watching_(keeps_positions(options.formulation) &&
                   model.mechanism.system->multipliers() > 0),
      interval_(std::max(1, step_count(options) / looks)),
      largest_drift_(std::max(most_drift, most_tolerances * options.newton_tolerance)),
      residual_(model.mechanism.system->size()) {
  largest_drift_ *= std::min(1.0, shortest_length(model));
}

void ConstraintGuard::see(int step, const State& state) {
  if (!is_watching_ || step % interval_ != 0) return;
  residual_.setZero();
  for (Term* term : terms_.acting) term->add_residual(state, ConstraintLevel::position, residual_);
  const auto drift = residual_.tail(state.lambda.size()).cwiseAbs();
  Eigen::Index worst = 0;
  if (drift.maxCoeff(&worst) <= largest_drift_) return;
  const std::size_t equation = state.q.size() + worst;
  const auto& names = model_.mechanism.equation_names;
  throw SimulationError(
      fmt::format("at t = {:.6g} s (step {}) {} is apart by {:.3g} m or rad, which equations of "
                  "motion and their round-off do not explain in a mechanism whose shortest beam is "
                  "{:.3g} m long. {}",
                  state.time, step, equation < names.size() ? names[equation] : "a constraint",
                  drift(worst), shortest_length(model_), advice));
}

void require_finite(const std::vector<Response>& responses, const Histories& histories,
                    const Trajectory& trajectory) {
  std::optional<Eigen::Index> first;
  std::size_t which = 0;
  for (std::size_t i = 0; i < histories.size(); ++i) {
    const std::optional<Eigen::Index> instant = first_not_finite(histories[i]);
    if (!instant || (first && *first <= *instant)) continue;
    first = instant;
    which = i;
  }
  if (first) {
    throw SimulationError(fmt::format("the response \"{}\" is not finite at t = {:.6g} s. {}",
                                      responses[which].name, trajectory.time(*first), advice));
  }
}

void require_finite(const std::vector<Response>& responses,
                    const std::vector<Reduction>& reductions) {
  for (std::size_t i = 0; i < reductions.size(); ++i) {
    if (std::isfinite(reductions[i].value)) continue;
    throw SimulationError(
        fmt::format("the response \"{}\" is not finite. {}", responses[i].name, advice));
  }
}

}  // namespace pleuel
