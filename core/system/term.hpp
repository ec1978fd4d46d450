#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace pleuel {

/// One instant of a mechanism. q, v, a: generalized coordinates and their rates (n);
/// lambda: Lagrange multipliers (m).
struct State {
  double time = 0.0;
  Eigen::VectorXd q, v, a, lambda;

  State() = default;
  State(int coordinates, int multipliers)
      : q(Eigen::VectorXd::Zero(coordinates)),
        v(Eigen::VectorXd::Zero(coordinates)),
        a(Eigen::VectorXd::Zero(coordinates)),
        lambda(Eigen::VectorXd::Zero(multipliers)) {}
};

/// Weights of the tangent q R_q + v R_v + a R_a.
struct Weights {
  double q = 0.0, v = 0.0, a = 0.0;
};

using WeightList = std::span<const Weights>;

/// Where tangents are written: one block of entries for each of the weights.
struct EntryBlocks {
  double* first = nullptr;
  std::ptrdiff_t stride = 0;  ///< from one block to the next

  double* block(std::size_t i) const { return first + static_cast<std::ptrdiff_t>(i) * stride; }
};

/// In which form a constraint Φ(q, t) = 0 stands in the residual: Φ, dΦ/dt or d²Φ/dt².
enum class ConstraintLevel { position, velocity, acceleration };

/// Rows and columns of a term's tangent, in the order in which it writes them. Columns and rows
/// 0 … n−1 belong to the coordinates, n … n+m−1 to the multipliers. An entry may occur repeatedly.
using EntryList = std::vector<std::pair<int, int>>;

/// Columns of a matrix, or some of them.
using ConstColumns = Eigen::Ref<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>;
using Columns = Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>>;

/// One physical idea: a summand of the residual
///     R = [ M(q) a − Q(q, v, t) + Φ_qᵀ λ ;  Φ(q, t) at the given level ]                 (n + m)
/// A term may keep scratch memory: a System and its terms belong to one thread.
class Term {
 public:
  virtual ~Term() = default;

  /// What it is, for the table of effects.
  virtual std::string name() const = 0;

  virtual void declare_entries(EntryList& entries) const = 0;

  /// residual += this term's R.
  virtual void add_residual(const State& state, ConstraintLevel level,
                            Eigen::VectorXd& residual) = 0;

  /// residual += R, and writes for each of the weights the entries of  w.q R_q + w.v R_v + w.a R_a
  /// in coordinate columns and of R_λ in multiplier columns, in the order of declare_entries(). All
  /// share one evaluation.
  virtual void linearize(const State& state, const WeightList& weights, ConstraintLevel level,
                         Eigen::VectorXd& residual, const EntryBlocks& entries) = 0;

  /// The tangent alone.
  void write_tangent(const State& state, const Weights& weights, ConstraintLevel level,
                     double* entries) {
    Eigen::VectorXd unused = Eigen::VectorXd::Zero(state.q.size() + state.lambda.size());
    linearize(state, {&weights, 1}, level, unused, {entries, 0});
  }

  /// columns.col(j) += ∂R/∂x_j at fixed state, (n + m) × variables.
  virtual void add_design_derivative(const State& state, ConstraintLevel level,
                                     Eigen::MatrixXd& columns) = 0;

  // Σ μᵀ ∂R/∂x over many instants, at a cost that does not grow with the number of variables: what
  // multiplies the derivatives of the term's data is summed first, the derivatives come last.

  /// How many numbers a term sums for each μ.
  virtual int parameter_adjoint_count() const = 0;
  /// sums.col(i) += what multiplies the derivatives of the data in mu.col(i)ᵀ ∂R/∂x.
  /// @param mu    (n + m) × any number
  /// @param sums  parameter_adjoint_count() × the same number
  virtual void add_parameter_adjoints(const State& state, ConstraintLevel level,
                                      const ConstColumns& mu, Columns sums) = 0;
  /// gradients.col(i) += Σ μᵀ ∂R/∂x of sums.col(i), variables × the same number.
  virtual void add_design_gradients(const ConstColumns& sums, Eigen::MatrixXd& gradients) const = 0;
};

/// The derivative of a term's data with respect to one design variable.
template <class Data>
struct DesignDerivative {
  int variable;
  Data data;
};

/// What can be read of a force element.
enum class Reading {
  coordinate,   ///< its length or relative coordinate [m] or [rad]
  rate,         ///< of that
  force,        ///< of its spring and damper: a pull, or on the second body [N] or [N m]
  motor_power,  ///< what its motor supplies [W]
  damper_power  ///< what its damper takes, and its resistance to a rate [W]
};

/// Reads a force element in a state, with derivatives. It acts on nothing.
class Gauge {
 public:
  virtual ~Gauge() = default;
  virtual double read(const State& state, Reading reading) const = 0;
  /// q += weight · ∂(reading)/∂q; v and design alike.
  virtual void add_gradient(const State& state, Reading reading, double weight, Eigen::VectorXd& q,
                            Eigen::VectorXd& v, Eigen::VectorXd& design) const = 0;
};

/// A strain that is quadratic in some of the generalized coordinates, with its stiffness:
///     g = bᵀ q + ½ qᵀ G q,   force κ g (b + G q)
struct QuadraticStrain {
  std::vector<int> coordinates;  ///< indices in q
  Eigen::VectorXd linear;        ///< b
  Eigen::MatrixXd quadratic;     ///< G, symmetric
  double stiffness = 0.0;        ///< κ
};

/// What a term implements that is made of such strains: who solves for an equilibrium treats their
/// forces as unknowns of their own (core/linear/axial_strains.hpp).
class StrainSource {
 public:
  virtual ~StrainSource() = default;
  virtual std::vector<QuadraticStrain> strains() const = 0;
};

}  // namespace pleuel
