#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "core/base/int_size.hpp"
#include "core/system/term.hpp"

namespace pleuel {

/// Local coordinates as linear combinations of the generalized ones,
///     q_local = rows · q(coordinates)
/// such as nodal displacements of a body that is described by modes, or the displacement of a place
/// between nodes. Terms and signals written in local coordinates serve through it unchanged. Rows
/// of a rotation vector must be copies: it does not combine.
struct CoordinateMap {
  std::vector<int> coordinates;                                ///< indices in q of the columns
  Eigen::MatrixXd rows;                                        ///< local × coordinates
  std::vector<DesignDerivative<Eigen::MatrixXd>> derivatives;  ///< ∂rows/∂x, where not zero
  std::vector<int> multipliers;  ///< indices in λ of the local multipliers

  int size() const { return static_cast<int>(rows.rows()); }
  int columns() const { return int_size(coordinates); }

  /// Local part of a vector of generalized coordinates or of their rates.
  template <class Vector>
  void gather(const Vector& all, Eigen::VectorXd& columns, Eigen::VectorXd& local) const {
    for (int i = 0; i < this->columns(); ++i) {
      columns(i) = all(coordinates[i]);
    }
    local.noalias() = rows * columns;
  }
};

/// A state in local coordinates with the generalized ones that it was made from.
struct LocalState {
  explicit LocalState(const CoordinateMap& map);
  void set(const CoordinateMap& map, const State& state);

  State local;
  Eigen::VectorXd q, v, a;  ///< of the columns
};

/// A term in local coordinates q_l = P q that acts on the generalized ones by virtual work:
///     R = Pᵀ R_l(P q, P v, P a),   tangent Pᵀ T_l P,
///     R_x = Pᵀ R_l,x + P_xᵀ R_l + Pᵀ (T_q P_x q + T_v P_x v + T_a P_x a)
///     μᵀ R_x = (P μ)ᵀ R_l,x + P_x : [ R_l μᵀ + (T_qᵀ P μ) qᵀ + (T_vᵀ P μ) vᵀ + (T_aᵀ P μ) aᵀ ]
/// Rows of multipliers stay what they are.
class ProjectedTerm final : public Term {
 public:
  /// @param inner  numbers its coordinates and multipliers as the map does
  ProjectedTerm(std::unique_ptr<Term> inner, CoordinateMap map, int coordinates);

  std::string name() const override { return inner_->name(); }
  void declare_entries(EntryList& entries) const override;
  void add_residual(const State& state, ConstraintLevel level, Eigen::VectorXd& residual) override;
  void linearize(const State& state, const WeightList& weights, ConstraintLevel level,
                 Eigen::VectorXd& residual, const EntryBlocks& entries) override;
  void add_design_derivative(const State& state, ConstraintLevel level,
                             Eigen::MatrixXd& columns) override;
  int parameter_adjoint_count() const override {
    return inner_->parameter_adjoint_count() + map_sum_count();
  }
  void add_parameter_adjoints(const State& state, ConstraintLevel level, const ConstColumns& mu,
                              Columns sums) override;
  void add_design_gradients(const ConstColumns& sums, Eigen::MatrixXd& gradients) const override;

 private:
  int locals() const { return map_.size(); }
  int multipliers() const { return int_size(map_.multipliers); }
  int row_of_multiplier(int i) const { return coordinates_ + map_.multipliers[i]; }
  void scatter(Eigen::VectorXd& residual);
  void set_tangent(std::size_t block);
  void write_projected(double* entries);
  void prepare(std::size_t weights);
  void add_moving_map(ConstraintLevel level, Eigen::MatrixXd& columns);
  /// Residual and the tangents for weights one on q, v and a at the local state.
  void linearize_inner(ConstraintLevel level);
  int map_sum_count() const { return map_.derivatives.empty() ? 0 : int_size(map_.rows); }
  void add_map_sums(ConstraintLevel level, const ConstColumns& mu, Columns sums);

  std::unique_ptr<Term> inner_;
  CoordinateMap map_;
  int coordinates_;  ///< of the system
  EntryList inner_entries_;

  // Scratch
  LocalState state_;
  Eigen::VectorXd residual_, projected_;
  std::vector<double> values_;   ///< inner entries, one block a weight
  Eigen::MatrixXd tangent_;      ///< local and multipliers, square
  Eigen::MatrixXd half_, full_;  ///< T P, Pᵀ T P
  Eigen::MatrixXd inner_columns_, inner_mu_;
};

}  // namespace pleuel
