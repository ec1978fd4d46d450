#pragma once

#include "core/system/term.hpp"

namespace pleuel {

/// Constants of geometric stiffening of one member, on the coordinates that move it: those of the
/// nodes of a finite element, or the elastic coordinates of a body with few of them.
struct StiffeningElement {
  std::vector<int> coordinates;  ///< indices in q
  Eigen::VectorXd elongation;    ///< b: Δu = bᵀ q
  double axial_stiffness = 0.0;  ///< κ = EA/ℓ [N/m]
  Eigen::MatrixXd slopes;        ///< Ĝ: ∫ v'² + w'² dx = qᵀ Ĝ q [1/m], symmetric
};

/// Derivative of those constants with respect to one design variable.
struct StiffeningDerivative {
  int element;
  double axial_stiffness = 0.0;
  double damping = 0.0;
  Eigen::VectorXd elongation;
  Eigen::MatrixXd slopes;
};

/// The axial force of a member stiffens its bending, and bending shortens it: von Kármán's strain,
/// averaged over each element,
///     g = Δu + ½ qᵀ Ĝ q,    V = ½ κ g²
/// in place of the linear ½ κ Δu², with viscous stress β ġ (stiffness-proportional damping):
///     f = κ (g + β ġ)(b + Ĝ q) − κ (Δu + β Δu̇) b
/// The linear part is in K and D; this term is what is missing there. Without it a rotating beam
/// has centrifugal softening only and diverges (Simo & Vu-Quoc 1987; Wallrapp & Schwertassek 1991).
class GeometricStiffening : public Term, public StrainSource {
 public:
  GeometricStiffening(
      std::string body, std::vector<StiffeningElement> elements, double damping,
      const std::vector<DesignDerivative<std::vector<StiffeningDerivative>>>& derivatives);

  std::string name() const override { return "geometric stiffening of " + body_; }
  void declare_entries(EntryList& entries) const override;
  void add_residual(const State& state, ConstraintLevel level, Eigen::VectorXd& residual) override;
  void linearize(const State& state, const WeightList& weights, ConstraintLevel level,
                 Eigen::VectorXd& residual, const EntryBlocks& entries) override;
  void add_design_derivative(const State& state, ConstraintLevel level,
                             Eigen::MatrixXd& columns) override;
  int parameter_adjoint_count() const override;
  void add_parameter_adjoints(const State& state, ConstraintLevel level, const ConstColumns& mu,
                              Columns sums) override;
  void add_design_gradients(const ConstColumns& sums, Eigen::MatrixXd& gradients) const override;
  std::vector<QuadraticStrain> strains() const override;

 private:
  /// An element with its constants filled up by zeros to a size that the compiler knows.
  struct PaddedElement : StiffeningElement {
    explicit PaddedElement(StiffeningElement element);
    Eigen::Index size() const { return elongation.size(); }
    Eigen::VectorXd padded_elongation;
    Eigen::MatrixXd padded_slopes;
  };
  /// Strain measures of one element in one state. Vectors are as long as the largest element needs
  /// them: no heap in the time loop.
  struct Strain {
    Eigen::VectorXd q, v, gradient, slope_v;        ///< gradient = b + Ĝ q, slope_v = Ĝ q̇
    double linear, linear_rate, total, total_rate;  ///< Δu, Δu̇, g, ġ
  };
  /// What a variable changes of one element.
  struct Change {
    int variable;
    StiffeningDerivative derivative;
    bool is_of_shape;  ///< not of κ alone
  };
  void evaluate(const PaddedElement& element, const State& state);
  template <int Size>
  void evaluate(const PaddedElement& element, const State& state);
  void write_element(const PaddedElement& element, const Weights& weights, double* entries);
  /// Sums of an element: those of κ, of β, of b, of Ĝ.
  static Eigen::Index sum_count(const StiffeningElement& element) {
    return 2 + element.elongation.size() + element.slopes.size();
  }
  // From the strain of the last evaluation.
  template <int Size>
  void write_element(const PaddedElement& element, const Weights& weights, double* entries);
  void set_unit_forces(const StiffeningElement& element);
  void add_unit_change(const StiffeningElement& element, const Change& change, double factor);
  void add_forces(const StiffeningElement& element, Eigen::VectorXd& residual);

  std::string body_;
  std::vector<PaddedElement> elements_;
  double damping_;
  std::vector<std::vector<Change>> changes_;  ///< one list an element
  bool is_designed_;

  // Scratch, as long as the largest element.
  Strain strain_;
  Eigen::VectorXd unit_forces_;  ///< f/κ
  Eigen::VectorXd row_, column_, bent_, forces_;
};

}  // namespace pleuel
