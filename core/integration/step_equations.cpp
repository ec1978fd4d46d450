#include "core/integration/step_equations.hpp"

#include <algorithm>
#include <array>

#include "core/integration/sparse_products.hpp"
#include "core/mechanism/mechanism.hpp"
#include "core/system/system.hpp"

namespace pleuel {

namespace {

ConstraintLevel level_of(ConstraintForm form) {
  switch (form) {
    case ConstraintForm::index_3:
      return ConstraintLevel::position;
    case ConstraintForm::stabilized_index_2:
      return ConstraintLevel::velocity;
    default:
      return ConstraintLevel::acceleration;
  }
}

/// to.row(n …) of coordinate columns += factor · from, of the same pattern.
void add_constraint_rows(int n, double factor, const System::Matrix& from, System::Matrix& to) {
  for_each_entry(from, [&](std::size_t k, int row, int col) {
    if (row >= n && col < n) to.valuePtr()[k] += factor * from.valuePtr()[k];
  });
}

}  // namespace

FormulatedSystem::FormulatedSystem(System& system, const Formulation& formulation)
    : system_(system), level_(level_of(formulation.constraints)) {
  const double b = formulation.baumgarte;
  if (formulation.constraints == ConstraintForm::index_1 && b > 0.0) {
    others_ = {{ConstraintLevel::velocity, 2.0 * b}, {ConstraintLevel::position, b * b}};
  }
}

const Eigen::VectorXd& FormulatedSystem::residual(const State& state) {
  system_.residual(state, level_, residual_);
  const int m = system_.multipliers();
  for (const Term& other : others_) {
    system_.residual(state, other.level, other_residual_);
    residual_.tail(m) += other.factor * other_residual_.tail(m);
  }
  return residual_;
}

const Eigen::VectorXd& FormulatedSystem::linearize(const State& state, WeightList weights,
                                                   std::size_t first,
                                                   std::vector<System::Matrix>& matrices) {
  const std::span<System::Matrix> those(matrices.data() + first, weights.size());
  system_.linearize(state, weights, level_, residual_, those);
  if (!others_.empty() && other_matrices_.empty()) other_matrices_ = matrices;
  const int m = system_.multipliers();
  for (const Term& other : others_) {
    const std::span<System::Matrix> others(other_matrices_.data() + first, weights.size());
    system_.linearize(state, weights, other.level, other_residual_, others);
    residual_.tail(m) += other.factor * other_residual_.tail(m);
    for (std::size_t i = 0; i < weights.size(); ++i) {
      add_constraint_rows(system_.coordinates(), other.factor, others[i], those[i]);
    }
  }
  return residual_;
}

Eigen::MatrixXd& FormulatedSystem::design_derivative(const State& state) {
  system_.design_derivative(state, level_, columns_);
  const int m = system_.multipliers();
  for (const Term& other : others_) {
    system_.design_derivative(state, other.level, other_columns_);
    columns_.bottomRows(m) += other.factor * other_columns_.bottomRows(m);
  }
  return columns_;
}

void FormulatedSystem::add_parameter_adjoints(const State& state, const Eigen::MatrixXd& mu,
                                              Columns sums) {
  system_.add_parameter_adjoints(state, level_, mu, sums);
  const int m = system_.multipliers();
  for (const Term& other : others_) {
    other_mu_.setZero(mu.rows(), mu.cols());
    other_mu_.bottomRows(m) = other.factor * mu.bottomRows(m);
    system_.add_parameter_adjoints(state, other.level, other_mu_, sums);
  }
}

namespace {

/// One over the weight of z in what the level constrains.
double scale_of(ConstraintLevel level, const Scheme& scheme) {
  switch (level) {
    case ConstraintLevel::position:
      return 1.0 / scheme.correction(0);
    case ConstraintLevel::velocity:
      return 1.0 / scheme.correction(1);
    default:
      return 1.0 / scheme.correction(2);
  }
}

/// Entries of Φ_q in the rows of constraints that are not left out, each with its transposed.
std::vector<std::pair<int, int>> transposed_entries(const System& system) {
  const int n = system.coordinates();
  const System::Matrix pattern = system.make_matrix();
  System::Matrix places = pattern;
  for_each_entry(pattern,
                 [&](std::size_t k, int, int) { places.valuePtr()[k] = static_cast<double>(k); });
  const std::vector<int>& left_out = system.left_out();
  std::vector<std::pair<int, int>> entries;
  for_each_entry(pattern, [&](std::size_t k, int row, int col) {
    if (row < n || col >= n) return;
    if (std::ranges::binary_search(left_out, row - n)) return;
    entries.emplace_back(static_cast<int>(k), slot_of(pattern, col, row));
  });
  return entries;
}

}  // namespace

StepEquations::StepEquations(const Mechanism& mechanism, const Scheme& scheme,
                             const Formulation& formulation)
    : mechanism_(mechanism),
      system_(*mechanism.system),
      scheme_(scheme),
      is_projected_(formulation.is_projected),
      formulated_(system_, formulation),
      matrices_(4, system_.make_matrix()) {
  set_scheme(scheme);
  if (formulation.constraints == ConstraintForm::stabilized_index_2) {
    shift_.emplace(mechanism_);
    constraint_rows_ = system_.make_matrix();
    transposed_ = transposed_entries(system_);
  }
}

void StepEquations::set_scheme(const Scheme& scheme) {
  scheme_ = scheme;
  const double dynamic = scheme.dynamic_scale(), constraint = scale_of(formulated_.level(), scheme);
  if (dynamic == dynamic_scale_ && constraint == constraint_scale_) return;
  dynamic_scale_ = dynamic;
  constraint_scale_ = constraint;
  const int n = system_.coordinates();
  const System::Matrix& matrix = matrices_.front();
  scales_.resize(matrix.outerIndexPtr()[n]);
  for (Eigen::Index k = 0; k < scales_.size(); ++k) {
    scales_(k) = matrix.innerIndexPtr()[k] < n ? dynamic_scale_ : constraint_scale_;
  }
}

StepState StepEquations::make_state(const State& start) const {
  StepState state;
  static_cast<State&>(state) = start;
  state.w = start.a;
  state.increment.setZero(system_.coordinates());
  if (shift_) {
    state.shift.setZero(system_.coordinates());
    state.eta.setZero(system_.multipliers());
  }
  if (is_projected_) {
    state.drifted_q = start.q;
    state.drifted_v = start.v;
  }
  return state;
}

void StepEquations::begin(const State& old) {
  old_ = old;
  if (shift_) shift_->begin(old);
}

void StepEquations::write_residual(const StepState& state, const Eigen::VectorXd& of_system,
                                   Eigen::VectorXd& residual) {
  const int n = system_.coordinates(), m = system_.multipliers();
  residual.resize(size());
  residual.head(n) = dynamic_scale_ * of_system.head(n);
  residual.segment(n, m) = constraint_scale_ * of_system.tail(m);
  // Rows that are left out say s λ_i = 0, or round-off at the start would grow in each step.
  for (int i : system_.left_out()) residual(n + i) = dynamic_scale_ * state.lambda(i);
  if (shift_) shift_->residual(state, state.shift, state.eta, residual.tail(n + m));
}

void StepEquations::residual(const StepState& state, Eigen::VectorXd& residual) {
  write_residual(state, formulated_.residual(state), residual);
}

void StepEquations::linearize(const StepState& state, Eigen::VectorXd& residual,
                              System::Matrix& matrix) {
  const Eigen::Vector4d& b = scheme_.correction;
  const std::array<Weights, 2> weights{{{b(0), b(1), b(2)}, {.q = 1.0}}};
  const bool turns = !mechanism_.rotations.empty();
  const WeightList needed(weights.data(), shift_ || turns ? 2u : 1u);
  write_residual(state, formulated_.linearize(state, needed, 0, matrices_), residual);
  write_matrix(state, 1, matrix);
}

/// From matrices_: the step's and the one with weight q.
void StepEquations::write_matrix(const StepState& state, std::size_t q, System::Matrix& matrix) {
  const Rotations& rotations = mechanism_.rotations;
  System::Matrix& step = matrices_.front();
  if (!rotations.empty()) {
    add_increment_tangent(rotations, state.increment, matrices_[q], scheme_.correction(0), step);
  }
  if (!shift_) {
    const Eigen::Index scaled = scales_.size(), others = step.nonZeros() - scaled;
    matrix.coeffs().head(scaled) = scales_ * step.coeffs().head(scaled);
    matrix.coeffs().tail(others) = step.coeffs().tail(others);
    return;
  }
  step.coeffs().head(scales_.size()) *= scales_;
  System::Matrix& with_q = matrices_[q];
  add_increment_tangent(rotations, state.increment, with_q, 1.0, with_q);
  set_constraint_rows(state);
  shift_->write_matrix({step, with_q, constraint_rows_}, dynamic_scale_, constraint_scale_, matrix);
}

/// From R_λ = Φ_qᵀ, which stands in the step's tangent.
void StepEquations::set_constraint_rows(const StepState& state) {
  const double* columns = matrices_.front().valuePtr();
  for (const auto& [in_row, in_column] : transposed_) {
    constraint_rows_.valuePtr()[in_row] = columns[in_column];
  }
  add_increment_tangent(mechanism_.rotations, state.increment, constraint_rows_, 1.0,
                        constraint_rows_);
}

void StepEquations::apply(const Eigen::VectorXd& correction, StepState& state) const {
  const int n = system_.coordinates(), m = system_.multipliers();
  const auto z = correction.head(n);
  state.increment += scheme_.correction(0) * z;
  state.v += scheme_.correction(1) * z;
  state.a += scheme_.correction(2) * z;
  state.w += scheme_.correction(3) * z;
  state.lambda += correction.segment(n, m) / dynamic_scale_;
  if (shift_) {
    state.shift += correction.segment(n + m, n);
    state.increment += correction.segment(n + m, n);
    state.eta += correction.tail(m);
  }
  advance(mechanism_.rotations, old_.q, state.increment, state.q);
}

void StepEquations::linearize_sensitivities(const StepState& state, System::Matrix& matrix) {
  const std::array<Weights, 3> weights{{{.v = 1.0}, {.a = 1.0}, {.q = 1.0}}};
  formulated_.linearize(state, weights, 1, matrices_);
  combine_tangents();
  write_matrix(state, 3, matrix);
}

/// The step's tangent from those with weights one.
void StepEquations::combine_tangents() {
  const Eigen::Vector4d& b = scheme_.correction;
  const System::Matrix &by_v = matrices_[1], &by_a = matrices_[2], &by_q = matrices_[3];
  matrices_[0].coeffs() = b(0) * by_q.coeffs() + b(1) * by_v.coeffs() + b(2) * by_a.coeffs();
  // R_λ stands in each of them.
  const Eigen::Index first = by_q.outerIndexPtr()[system_.coordinates()];
  const Eigen::Index count = by_q.nonZeros() - first;
  matrices_[0].coeffs().tail(count) = by_q.coeffs().tail(count);
}

void StepEquations::differentiate(const StepState& state, const Eigen::MatrixXd& v,
                                  const Eigen::MatrixXd& a, const Eigen::MatrixXd& old_q,
                                  Eigen::MatrixXd& rhs, DerivativesOf of) {
  const int n = system_.coordinates(), m = system_.multipliers();
  if (of == DerivativesOf::old_state) columns_.setZero(n + m, v.cols());
  Eigen::MatrixXd& columns =
      of == DerivativesOf::design ? formulated_.design_derivative(state) : columns_;
  add_products(matrices_[1], v, matrices_[2], a, columns);
  rhs.resize(size(), v.cols());
  rhs.topRows(n) = -dynamic_scale_ * columns.topRows(n);
  rhs.middleRows(n, m) = -constraint_scale_ * columns.bottomRows(m);
  if (shift_) shift_->differentiate(state, state.eta, old_q, of, rhs.bottomRows(n + m));
}

void StepEquations::differentiate_transposed(const StepState& state, const ConstColumns& y,
                                             Columns v, Columns a, Columns old_q, Columns sums) {
  const int n = system_.coordinates(), m = system_.multipliers();
  mu_.resize(n + m, y.cols());
  mu_.topRows(n) = -dynamic_scale_ * y.topRows(n);
  mu_.bottomRows(m) = -constraint_scale_ * y.middleRows(n, m);
  formulated_.add_parameter_adjoints(state, mu_, sums);
  add_transposed_products(matrices_[1], matrices_[2], mu_, v, a);
  if (shift_) {
    shift_->differentiate_transposed(state, state.eta, y.bottomRows(n + m), old_q, sums);
  }
}

}  // namespace pleuel
