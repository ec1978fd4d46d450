#include "core/integration/trajectory.hpp"

#include <cmath>
#include <stdexcept>

namespace pleuel {

namespace {

/// Steps that differ by less, relatively, are equal.
constexpr double round_off_of_steps = 1e-6;
/// Where steps change by less, relatively, the scheme goes on with its w: that belongs to an
/// instant which is off by δ times the change, once. To drop w forgets part of what acted, to first
/// order where that jumped.
constexpr double small_change = 0.3;

}  // namespace

State Trajectory::state_at(int step) const {
  State state;
  states->load(step, state);
  return state;
}

StateColumns& Trajectory::columns() const {
  auto* stored = dynamic_cast<StoredStates*>(states.get());
  if (!stored) throw std::logic_error("the states of the trajectory are not held in memory");
  return stored->columns();
}

RecomputedStates* Trajectory::recomputed() const {
  return dynamic_cast<RecomputedStates*>(states.get());
}

double Trajectory::step_size(int step) const {
  const double h = time(step) - time(step - 1);
  const double halved =
      std::ldexp(scheme.step, static_cast<int>(std::lround(std::log2(h / scheme.step))));
  return std::abs(h - halved) <= round_off_of_steps * halved ? halved : h;
}

Scheme Trajectory::scheme_of(int step) const {
  const double h = step_size(step);
  const double before = step > 1 ? step_size(step - 1) : step_before;
  const bool is_as_before = before == 0.0 || std::abs(h - before) <= small_change * h;
  return is_as_before ? make_scheme(scheme_type, h, spectral_radius)
                      : make_restarting_scheme(scheme_type, h, spectral_radius);
}

double Trajectory::weight_of_jerk(int step) const {
  if (!has_constraints || formulation.constraints != ConstraintForm::index_3) return 0.0;
  return -scheme_of(step).local_error / step_size(step);
}

}  // namespace pleuel
