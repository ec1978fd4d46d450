#include "core/integration/step_equations.hpp"

#include <algorithm>
#include <array>
#include <cassert>

#include "core/integration/configuration.hpp"
#include "core/integration/sparse_products.hpp"

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

/// Calls visit(k, row, column) for all entries of a pattern.
template <class Visit>
void for_each_entry(const System::Matrix& matrix, Visit visit) {
  for (int col = 0; col < matrix.cols(); ++col) {
    for (int k = matrix.outerIndexPtr()[col]; k < matrix.outerIndexPtr()[col + 1]; ++k) {
      visit(static_cast<std::size_t>(k), matrix.innerIndexPtr()[k], col);
    }
  }
}

int find_slot(const System::Matrix& matrix, int row, int col) {
  const int* begin = matrix.innerIndexPtr() + matrix.outerIndexPtr()[col];
  const int* end = matrix.innerIndexPtr() + matrix.outerIndexPtr()[col + 1];
  const int* found = std::lower_bound(begin, end, row);
  assert(found != end && *found == row);
  return static_cast<int>(found - matrix.innerIndexPtr());
}

/// to.row(n …) of coordinate columns += factor · from, of the same pattern.
void add_constraint_rows(int n, double factor, const System::Matrix& from, System::Matrix& to) {
  for_each_entry(from, [&](std::size_t k, int row, int col) {
    if (row >= n && col < n) to.valuePtr()[k] += factor * from.valuePtr()[k];
  });
}

}  // namespace

StepEquations::StepEquations(Mechanism& mechanism, const Scheme& scheme,
                             const Formulation& formulation)
    : mechanism_(mechanism),
      system_(*mechanism.system),
      scheme_(scheme),
      formulation_(formulation),
      level_{level_of(formulation.constraints), 1.0},
      matrices_(4, system_.make_matrix()),
      shift_forces_(system_) {
  set_scheme(scheme);
  const double b = formulation.baumgarte;
  if (formulation.constraints == ConstraintForm::index_1 && b > 0.0) {
    other_levels_ = {{ConstraintLevel::velocity, 2.0 * b}, {ConstraintLevel::position, b * b}};
    other_matrices_ = matrices_;
  }
  build_pattern();
}

void StepEquations::set_scheme(const Scheme& scheme) {
  scheme_ = scheme;
  const double dynamic = scheme.dynamic_scale(), constraint = scale_of(level_.level, scheme);
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

void StepEquations::build_pattern() {
  pattern_ = system_.make_matrix();
  if (!is_stabilized()) return;
  const System::Matrix& block = matrices_.front();
  const int n = system_.coordinates(), size = system_.size();
  // In the second block rows the dynamics is W δ and does not know z.
  const auto is_in_21 = [n](int row, int col) { return row >= n && col < n; };
  const auto is_in_22 = [n](int row, int col) { return row >= n || col >= n || row == col; };
  std::vector<Eigen::Triplet<double>> entries;
  for_each_entry(block, [&](std::size_t, int row, int col) {
    entries.emplace_back(row, col, 0.0);
    if (col < n) entries.emplace_back(row, size + col, 0.0);
    if (is_in_21(row, col)) entries.emplace_back(size + row, col, 0.0);
    if (is_in_22(row, col)) entries.emplace_back(size + row, size + col, 0.0);
  });
  pattern_.resize(2 * size, 2 * size);
  pattern_.setFromTriplets(entries.begin(), entries.end());
  pattern_.makeCompressed();
  const auto count = static_cast<std::size_t>(block.nonZeros());
  for (auto* slots : {&slots_11_, &slots_12_, &slots_21_, &slots_22_}) slots->assign(count, -1);
  for_each_entry(block, [&](std::size_t k, int row, int col) {
    slots_11_[k] = find_slot(pattern_, row, col);
    if (col < n) slots_12_[k] = find_slot(pattern_, row, size + col);
    if (is_in_21(row, col)) slots_21_[k] = find_slot(pattern_, size + row, col);
    if (is_in_22(row, col)) slots_22_[k] = find_slot(pattern_, size + row, size + col);
  });
  old_constraints_ = system_.make_matrix();
  turned_ = system_.make_matrix();
}

StepState StepEquations::make_state(const State& start) const {
  StepState state;
  static_cast<State&>(state) = start;
  state.w = start.a;
  state.increment.setZero(system_.coordinates());
  if (is_stabilized()) {
    state.shift.setZero(system_.coordinates());
    state.eta.setZero(system_.multipliers());
  }
  if (formulation_.is_projected) {
    state.drifted_q = start.q;
    state.drifted_v = start.v;
  }
  return state;
}

void StepEquations::begin(const State& old) {
  old_ = old;
  if (is_stabilized()) {
    system_.tangent(old_, {}, ConstraintLevel::position, old_constraints_);
  }
}

/// The system's residual and tangents for the weights into residual_ and matrices_ from the first
/// on, constraints on the levels of the formulation.
void StepEquations::evaluate(const StepState& state, WeightList weights, std::size_t first) {
  const std::span<System::Matrix> matrices(matrices_.data() + first, weights.size());
  system_.linearize(state, weights, level_.level, residual_, matrices);
  for (const Level& other : other_levels_) {
    const std::span<System::Matrix> others(other_matrices_.data() + first, weights.size());
    system_.linearize(state, weights, other.level, other_residual_, others);
    residual_.tail(system_.multipliers()) +=
        other.factor * other_residual_.tail(system_.multipliers());
    for (std::size_t i = 0; i < weights.size(); ++i) {
      add_constraint_rows(system_.coordinates(), other.factor, others[i], matrices[i]);
    }
  }
}

/// From residual_, at the same state.
void StepEquations::write_residual(const StepState& state, Eigen::VectorXd& residual) {
  const int n = system_.coordinates(), m = system_.multipliers();
  residual.resize(size());
  residual.head(n) = dynamic_scale_ * residual_.head(n);
  residual.segment(n, m) = constraint_scale_ * residual_.tail(m);
  // Rows that are left out say s λ_i = 0, or round-off at the start would grow in each step.
  for (int i : system_.left_out()) residual(n + i) = dynamic_scale_ * state.lambda(i);
  if (!is_stabilized()) return;
  residual.segment(n + m, n) = mechanism_.assembly_weight.cwiseProduct(state.shift);
  for_each_entry(old_constraints_, [&](std::size_t k, int row, int col) {
    if (col < n || row >= n) return;
    residual(n + m + row) += old_constraints_.valuePtr()[k] * state.eta(col - n);
  });
  system_.residual(state, ConstraintLevel::position, other_residual_);
  residual.tail(m) = other_residual_.tail(m);
  for (int i : system_.left_out()) residual(2 * n + m + i) = state.eta(i);
}

void StepEquations::residual(const StepState& state, Eigen::VectorXd& residual) {
  system_.residual(state, level_.level, residual_);
  for (const Level& other : other_levels_) {
    system_.residual(state, other.level, other_residual_);
    residual_.tail(system_.multipliers()) +=
        other.factor * other_residual_.tail(system_.multipliers());
  }
  write_residual(state, residual);
}

void StepEquations::linearize(const StepState& state, Eigen::VectorXd& residual,
                              System::Matrix& matrix) {
  const Eigen::Vector4d& b = scheme_.correction;
  const std::array<Weights, 3> weights{{{b(0), b(1), b(2)}, {.q = 1.0}, {.v = 1.0}}};
  const bool turns = !mechanism_.rotations.empty();
  evaluate(state, WeightList(weights.data(), is_stabilized() ? 3u : turns ? 2u : 1u), 0);
  write_residual(state, residual);
  write_matrix(state, 1, 2, matrix);
}

/// From matrices_: the step's, the one with weight q and the one with weight v.
void StepEquations::write_matrix(const StepState& state, std::size_t q, std::size_t v,
                                 System::Matrix& matrix) {
  const int n = system_.coordinates();
  const Rotations& rotations = mechanism_.rotations;
  System::Matrix& step = matrices_.front();
  if (!rotations.empty()) {
    add_increment_tangent(rotations, state.increment, matrices_[q], scheme_.correction(0), step);
  }
  step.coeffs().head(scales_.size()) *= scales_;
  if (!is_stabilized()) {
    matrix.coeffs() = step.coeffs();
    return;
  }
  System::Matrix &with_q = matrices_[q], &with_v = turned_;
  std::copy(matrices_[v].valuePtr(), matrices_[v].valuePtr() + with_v.nonZeros(),
            with_v.valuePtr());
  if (!rotations.empty()) {
    add_increment_tangent(rotations, state.increment, with_q, 1.0, with_q);
    add_increment_tangent(rotations, state.increment, matrices_[v], 1.0, with_v);
  }
  double* out = matrix.valuePtr();
  for_each_entry(step, [&](std::size_t k, int row, int col) {
    out[slots_11_[k]] = step.valuePtr()[k];
    if (slots_12_[k] >= 0) {
      out[slots_12_[k]] = (row < n ? dynamic_scale_ : constraint_scale_) * with_q.valuePtr()[k];
    }
    // On velocity level the derivative with respect to v is Φ_q.
    if (slots_21_[k] >= 0) out[slots_21_[k]] = with_v.valuePtr()[k];
    if (slots_22_[k] < 0) return;
    if (col < n) {
      out[slots_22_[k]] = row < n ? mechanism_.assembly_weight(row) : with_v.valuePtr()[k];
    } else {
      out[slots_22_[k]] = old_constraints_.valuePtr()[k];
    }
  });
}

void StepEquations::apply(const Eigen::VectorXd& correction, StepState& state) const {
  const int n = system_.coordinates(), m = system_.multipliers();
  const auto z = correction.head(n);
  state.increment += scheme_.correction(0) * z;
  state.v += scheme_.correction(1) * z;
  state.a += scheme_.correction(2) * z;
  state.w += scheme_.correction(3) * z;
  state.lambda += correction.segment(n, m) / dynamic_scale_;
  if (is_stabilized()) {
    state.shift += correction.segment(n + m, n);
    state.increment += correction.segment(n + m, n);
    state.eta += correction.tail(m);
  }
  advance(mechanism_.rotations, old_.q, state.increment, state.q);
}

void StepEquations::linearize_sensitivities(const StepState& state, System::Matrix& matrix) {
  const std::array<Weights, 3> weights{{{.v = 1.0}, {.a = 1.0}, {.q = 1.0}}};
  evaluate(state, weights, 1);
  combine_tangents();
  write_matrix(state, 3, 1, matrix);
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
                                  Eigen::MatrixXd& rhs) {
  const int n = system_.coordinates(), m = system_.multipliers();
  system_.design_derivative(state, level_.level, columns_);
  for (const Level& other : other_levels_) {
    system_.design_derivative(state, other.level, other_columns_);
    columns_.bottomRows(m) += other.factor * other_columns_.bottomRows(m);
  }
  add_products(matrices_[1], v, matrices_[2], a, columns_);
  rhs.resize(size(), system_.variables());
  rhs.topRows(n) = -dynamic_scale_ * columns_.topRows(n);
  rhs.middleRows(n, m) = -constraint_scale_ * columns_.bottomRows(m);
  if (is_stabilized()) differentiate_old_constraints(state, old_q, rhs);
}

void StepEquations::differentiate_transposed(const StepState& state, const ConstColumns& y,
                                             Columns v, Columns a, Columns old_q, Columns sums) {
  const int n = system_.coordinates(), m = system_.multipliers();
  mu_.resize(n + m, y.cols());
  mu_.topRows(n) = -dynamic_scale_ * y.topRows(n);
  mu_.bottomRows(m) = -constraint_scale_ * y.middleRows(n, m);
  system_.add_parameter_adjoints(state, level_.level, mu_, sums);
  for (const Level& other : other_levels_) {
    other_mu_.setZero(n + m, y.cols());
    other_mu_.bottomRows(m) = other.factor * mu_.bottomRows(m);
    system_.add_parameter_adjoints(state, other.level, other_mu_, sums);
  }
  v.noalias() += matrices_[1].leftCols(n).transpose() * mu_;
  a.noalias() += matrices_[2].leftCols(n).transpose() * mu_;
  if (is_stabilized()) differentiate_old_constraints_transposed(state, y, old_q, sums);
}

/// The rows of the shift, −(Φ_q(q)ᵀ η)_q s_q − (Φ_q(q)ᵀ η)_x, and of Φ(q⁺), −Φ_x.
void StepEquations::differentiate_old_constraints(const StepState& state,
                                                  const Eigen::MatrixXd& old_q,
                                                  Eigen::MatrixXd& rhs) {
  const int n = system_.coordinates(), m = system_.multipliers();
  shift_forces_.set(old_, state.eta);
  shift_forces_.tangent(matrices_.front());
  other_columns_ = shift_forces_.design_derivative();
  other_columns_.noalias() += matrices_.front().leftCols(n) * old_q;
  rhs.middleRows(n + m, n) = -other_columns_.topRows(n);
  system_.design_derivative(state, ConstraintLevel::position, other_columns_);
  rhs.bottomRows(m) = -other_columns_.bottomRows(m);
}

/// As above, transposed.
void StepEquations::differentiate_old_constraints_transposed(const StepState& state,
                                                             const ConstColumns& y, Columns old_q,
                                                             Columns sums) {
  const int n = system_.coordinates(), m = system_.multipliers();
  other_mu_.setZero(n + m, y.cols());
  other_mu_.topRows(n) = -y.middleRows(n + m, n);
  shift_forces_.set(old_, state.eta);
  shift_forces_.tangent(matrices_.front());
  old_q.noalias() += matrices_.front().leftCols(n).transpose() * other_mu_;
  shift_forces_.add_parameter_adjoints(other_mu_, sums);
  other_mu_.topRows(n).setZero();
  other_mu_.bottomRows(m) = -y.bottomRows(m);
  system_.add_parameter_adjoints(state, ConstraintLevel::position, other_mu_, sums);
}

}  // namespace pleuel
