#pragma once

#include <memory>

#include <Eigen/SparseCore>

#include "core/beam/invariants.hpp"
#include "core/effects/body_equations.hpp"
#include "core/system/term.hpp"

namespace pleuel {

/// Inertia (with all velocity forces), linear elasticity, Rayleigh damping and weight of one body.
/// The equations stand in general_body_equations.hpp; body_equations.hpp has them with their
/// tangents, derived by hand, since this is where the time goes.
class FloatingFrameBody : public Term {
 public:
  /// @param name         of the body
  /// @param frame        its coordinates begin at frame.offset: frame, then elastic
  /// @param invariants   of the body
  /// @param derivatives  dI/dx of the variables that the body depends on
  /// @param gravity      [m/s²], global axes
  FloatingFrameBody(std::string name, BodyFrame frame, Invariants<double> invariants,
                    const std::vector<DesignDerivative<Invariants<double>>>& derivatives,
                    const Eigen::Vector3d& gravity);
  FloatingFrameBody(const FloatingFrameBody&) = delete;

  std::string name() const override {
    return (invariants_.size() > 0 ? "inertia and elasticity of " : "inertia of ") + name_;
  }
  void declare_entries(EntryList& entries) const override;
  void add_residual(const State& state, ConstraintLevel level, Eigen::VectorXd& residual) override;
  void linearize(const State& state, const WeightList& weights, ConstraintLevel level,
                 Eigen::VectorXd& residual, const EntryBlocks& entries) override;
  void add_design_derivative(const State& state, ConstraintLevel level,
                             Eigen::MatrixXd& columns) override;
  int parameter_adjoint_count() const override { return is_designed() ? layout_.size() : 0; }
  void add_parameter_adjoints(const State& state, ConstraintLevel level, const ConstColumns& mu,
                              Columns sums) override;
  void add_design_gradients(const ConstColumns& sums, Eigen::MatrixXd& gradients) const override;

  const BodyFrame& frame() const { return frame_; }
  const Invariants<double>& invariants() const { return invariants_; }

 private:
  /// dI/dx of one variable, on the coordinates that it concerns.
  struct Derivative {
    int variable;
    std::vector<int> coordinates;
    std::unique_ptr<DerivativeForces> of_invariants;
    Eigen::VectorXd forces;  ///< scratch: frame, then those coordinates
    ElasticMotion elastic;   ///< scratch
  };

  bool is_designed() const { return !derivatives_.empty(); }
  void evaluate(const State& state);
  void evaluate(Derivative& derivative);

  std::string name_;
  BodyFrame frame_;
  Invariants<double> invariants_;
  std::vector<Derivative> derivatives_;
  InvariantLayout layout_;
  Eigen::SparseMatrix<double> flat_derivatives_;  ///< numbers of the invariants × variables
  std::vector<int> variables_;                    ///< of its columns
  Eigen::Vector3d gravity_;

  std::unique_ptr<BodyEquations> equations_;  ///< refer to frame and invariants

  // Scratch of one evaluation.
  Eigen::MatrixXd evaluated_;  ///< q, v, a of all coordinates where it was
  BodyMotion motion_;
};

}  // namespace pleuel
