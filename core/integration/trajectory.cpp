#include <cmath>

#include "core/integration/simulate.hpp"

namespace pleuel {

namespace {

/// Steps that differ by less, relatively, are equal.
constexpr double round_off_of_steps = 1e-6;
/// Where steps change by less, relatively, the scheme goes on with its w: that belongs to an
/// instant which is off by δ times the change, once. To drop w forgets part of what acted, to first
/// order where that jumped.
constexpr double small_change = 0.3;

}  // namespace

void Trajectory::load(int step, State& state) const {
  if (repeated) {
    repeated->load(step, state);
    return;
  }
  state.time = time(step);
  state.q = q.col(step);
  state.v = v.col(step);
  state.a = a.col(step);
  state.lambda = lambda.col(step);
}

void Trajectory::load_eta(int step, Eigen::VectorXd& to) const {
  if (repeated) {
    repeated->load_eta(step, to);
  } else {
    to = eta.col(step);
  }
}

void Trajectory::load_drifted(int step, State& state) const {
  load(step, state);
  if (!is_projected()) return;
  if (repeated) {
    repeated->load_drifted(step, state);
  } else {
    state.q = drifted_q.col(step);
    state.v = drifted_v.col(step);
  }
}

double Trajectory::step_size(int step) const {
  const double h = time(step) - time(step - 1);
  const double halved =
      std::ldexp(scheme.step, static_cast<int>(std::lround(std::log2(h / scheme.step))));
  return std::abs(h - halved) <= round_off_of_steps * halved ? halved : h;
}

Scheme Trajectory::scheme_of(int step) const {
  const double h = step_size(step);
  const bool is_as_before = step == 1 || std::abs(h - step_size(step - 1)) <= small_change * h;
  return is_as_before ? make_scheme(scheme_type, h, spectral_radius)
                      : make_restarting_scheme(scheme_type, h, spectral_radius);
}

double Trajectory::weight_of_start_jerk() const {
  if (lambda.rows() == 0 || formulation.constraints != ConstraintForm::index_3) return 0.0;
  return -scheme_of(1).local_error / step_size(1);
}

}  // namespace pleuel
