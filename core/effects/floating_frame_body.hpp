#pragma once

#include <Eigen/SparseCore>

#include "core/beam/invariant_vector.hpp"
#include "core/effects/floating_frame_residual.hpp"
#include "core/system/term.hpp"

namespace pleuel {

/// Inertia (with all velocity forces), linear elasticity, Rayleigh damping and weight of one body.
/// The equations stand in floating_frame_residual.hpp; the tangent here is derived by hand, since
/// this is where the time goes.
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
    int variable = 0;
    PartialInvariants invariants;
    Eigen::VectorXd forces;  ///< scratch: frame, then those coordinates
    ElasticMotion elastic;   ///< scratch
  };

  bool is_designed() const { return !derivatives_.empty(); }
  void evaluate(const State& state);
  void evaluate(Derivative& derivative);
  void write_tangent_of(const Weights& weights, double* entries);
  void set_frame_columns(const Weights& weights);
  void set_elastic_columns(const Weights& weights);
  void write_elastic_block(const Weights& weights, double* entries) const;

  std::string name_;
  BodyFrame frame_;
  Invariants<double> invariants_;
  std::vector<Derivative> derivatives_;
  InvariantLayout layout_;
  Eigen::MatrixXd elastic_;  ///< K, D, S_ff and S_kl, a column of non-zeros each
  Eigen::SparseMatrix<double> flat_derivatives_;  ///< numbers of the invariants × variables
  std::vector<int> variables_;                    ///< of its columns
  Eigen::Vector3d gravity_;

  // Scratch of one evaluation.
  Eigen::MatrixXd evaluated_;  ///< q, v, a of all coordinates where it was
  FrameMotion<double> motion_;
  BodyProducts products_;
  Eigen::MatrixXd frame_block_;  ///< m × m
  /// The coupling of m frame coordinates with elastic coordinate i is this times column i of
  /// BodyProducts::coupling: entries (frame, i), then (i, frame); 2m × its rows.
  Eigen::MatrixXd coupling_;
};

}  // namespace pleuel
