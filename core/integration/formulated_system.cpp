#include "core/integration/formulated_system.hpp"

#include "core/integration/matrix_entries.hpp"

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

}  // namespace pleuel
