#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/integration/simulation_options.hpp"
#include "core/integration/step_equations.hpp"

namespace pleuel {

/// Elastic coordinates that forget an acceleration well within a step, as they are damped stiffly.
std::vector<int> stiffly_damped(const Mechanism& mechanism, const State& state, double step);

/// From where the first step sets out: consistent initial values, but only as far as the step can
/// follow them.
///
/// A load that acts all at once on an undeformed body accelerates its light nodes by a₀ = M⁻¹f.
/// Where these are stiff or much damped they do so for far less than a step; a scheme that takes a₀
/// for the acceleration of a step moves them by h²a₀ and their dampers by h a₀, which rings for
/// many steps and the more, the finer the mesh. So accelerations are taken from two steps of
/// implicit Euler from the same start to s₁ = h/2 and s₂ = h, with the constraints on acceleration
/// level: these are a(s) + O(s²) of all motion that a step resolves, and forget the rest as (1 + s
/// d/m + s²k/m)⁻¹ does. With the line through both,
///     a = a(0) + O(h²),   w = a(δ) + O(h²) with the delay δ of the scheme
/// so multipliers keep their order from the first step on (Jay & Negrut 2007). Index 3 also needs
/// velocities that start off the constraints.
///
/// Where the damping of elastic coordinates is no stiffer than the step, or the step resolves the
/// start, so that both agree, a₀ itself serves: a = a₀, and w = a₀ + δ j with the jerk j of the
/// constraints.
class DampedStart {
 public:
  /// @param first_step  the scheme of the first step
  /// @param weight_of_jerk  in the velocities (Trajectory::weight_of_jerk)
  /// @throws SimulationError if the first step is so long that not even a part of it can be made
  DampedStart(Mechanism& mechanism, const State& start, const Scheme& first_step,
              double weight_of_jerk);

  const Eigen::VectorXd& v() const { return v_; }
  const Eigen::VectorXd& a() const { return a_; }
  const Eigen::VectorXd& w() const { return w_; }

  struct Derivatives {
    Eigen::MatrixXd v, a, w;  ///< n × variables
  };
  /// @param q, v, a  derivatives of the start, n × variables
  Derivatives differentiate(const Eigen::MatrixXd& q, const Eigen::MatrixXd& v,
                            const Eigen::MatrixXd& a);

 private:
  /// One step of implicit Euler from the start.
  struct Probe {
    double step = 0.0;
    StepState state;
  };
  bool make_probe(Probe& probe);
  Eigen::MatrixXd differentiate(const Probe& probe, const Eigen::MatrixXd& q,
                                const Eigen::MatrixXd& v);
  /// What the line through both makes of them at a time.
  std::array<double, 2> weights_at(double time) const;
  /// Whether the probes find the acceleration of the start again.
  bool is_resolved(const Eigen::VectorXd& found) const;
  void set_exact();

  Mechanism& mechanism_;
  State start_;
  double step_, delay_, weight_of_jerk_;
  bool is_needed_;         ///< implicit Euler looks at no accelerations
  bool is_exact_ = false;  ///< not damped, or resolved by the step
  std::array<Probe, 2> probes_;
  Eigen::VectorXd v_, a_, w_;
};

}  // namespace pleuel
