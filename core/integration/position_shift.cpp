#include "core/integration/position_shift.hpp"

#include "core/integration/sparse_products.hpp"
#include "core/system/system.hpp"

namespace pleuel {

PositionShift::PositionShift(const Mechanism& mechanism)
    : mechanism_(mechanism),
      system_(*mechanism.system),
      old_constraints_(system_.make_matrix()),
      constraints_(system_),
      forces_(system_.coordinates(), system_.multipliers()),
      tangent_(system_.make_matrix()) {
  build_pattern();
}

void PositionShift::build_pattern() {
  const System::Matrix block = system_.make_matrix();
  const int n = system_.coordinates(), size = system_.size();
  // In the second block rows the dynamics is W δ and does not know z.
  const auto is_in_12 = [n](int col) { return col < n; };
  const auto is_in_21 = [n](int row, int col) { return row >= n && col < n; };
  const auto is_in_22 = [n](int row, int col) { return row >= n || col >= n || row == col; };
  std::vector<Eigen::Triplet<double>> entries;
  for_each_entry(block, [&](std::size_t, int row, int col) {
    entries.emplace_back(row, col, 0.0);
    if (is_in_12(col)) entries.emplace_back(row, size + col, 0.0);
    if (is_in_21(row, col)) entries.emplace_back(size + row, col, 0.0);
    if (is_in_22(row, col)) entries.emplace_back(size + row, size + col, 0.0);
  });
  pattern_.resize(2 * size, 2 * size);
  pattern_.setFromTriplets(entries.begin(), entries.end());
  pattern_.makeCompressed();
  slots_.resize(block.nonZeros());
  for_each_entry(block, [&](std::size_t k, int row, int col) {
    slots_[k].in_11 = slot_of(pattern_, row, col);
    if (is_in_12(col)) slots_[k].in_12 = slot_of(pattern_, row, size + col);
    if (is_in_21(row, col)) slots_[k].in_21 = slot_of(pattern_, size + row, col);
    if (is_in_22(row, col)) slots_[k].in_22 = slot_of(pattern_, size + row, size + col);
  });
}

void PositionShift::begin(const State& old) {
  old_ = old;
  constraints_.tangent(old_, {}, ConstraintLevel::position, old_constraints_);
}

void PositionShift::residual(const State& state, const Eigen::VectorXd& shift,
                             const Eigen::VectorXd& eta, Eigen::Ref<Eigen::VectorXd> residual) {
  const int n = system_.coordinates(), m = system_.multipliers();
  residual.head(n) = mechanism_.assembly_weight.cwiseProduct(shift);
  for_each_entry(old_constraints_, [&](std::size_t k, int row, int col) {
    if (col < n || row >= n) return;
    residual(row) += old_constraints_.valuePtr()[k] * eta(col - n);
  });
  constraints_.residual(state, ConstraintLevel::position, values_);
  residual.tail(m) = values_.tail(m);
  for (int i : system_.left_out()) residual(n + i) = eta(i);
}

void PositionShift::write_matrix(const Tangents& tangents, double dynamic_scale,
                                 double constraint_scale, System::Matrix& matrix) const {
  const int n = system_.coordinates();
  double* out = matrix.valuePtr();
  const double* constraints = tangents.constraints.valuePtr();
  for_each_entry(tangents.step, [&](std::size_t k, int row, int col) {
    const Slots& slots = slots_[k];
    out[slots.in_11] = tangents.step.valuePtr()[k];
    if (slots.in_12) {
      out[*slots.in_12] =
          (row < n ? dynamic_scale : constraint_scale) * tangents.with_q.valuePtr()[k];
    }
    if (slots.in_21) out[*slots.in_21] = constraints[k];
    if (!slots.in_22) return;
    if (col < n) {
      out[*slots.in_22] = row < n ? mechanism_.assembly_weight(row) : constraints[k];
    } else {
      out[*slots.in_22] = old_constraints_.valuePtr()[k];
    }
  });
}

void PositionShift::set_forces(const Eigen::VectorXd& eta) {
  forces_.time = old_.time;
  forces_.q = old_.q;
  forces_.lambda = eta;
}

void PositionShift::differentiate(const State& state, const Eigen::VectorXd& eta,
                                  const Eigen::MatrixXd& old_q, DerivativesOf of,
                                  Eigen::Ref<Eigen::MatrixXd> rhs) {
  const int n = system_.coordinates(), m = system_.multipliers();
  set_forces(eta);
  constraints_.tangent(forces_, {.q = 1.0}, ConstraintLevel::position, tangent_);
  columns_.setZero(n + m, old_q.cols());
  if (of == DerivativesOf::design) {
    constraints_.design_derivative(forces_, ConstraintLevel::position, columns_);
  }
  columns_.noalias() += tangent_.leftCols(n) * old_q;
  rhs.topRows(n) = -columns_.topRows(n);
  rhs.bottomRows(m).setZero();
  if (of == DerivativesOf::old_state) return;
  constraints_.design_derivative(state, ConstraintLevel::position, columns_);
  rhs.bottomRows(m) = -columns_.bottomRows(m);
}

void PositionShift::differentiate_transposed(const State& state, const Eigen::VectorXd& eta,
                                             const ConstColumns& y, Columns old_q, Columns sums) {
  const int n = system_.coordinates(), m = system_.multipliers();
  mu_.setZero(n + m, y.cols());
  mu_.topRows(n) = -y.topRows(n);
  set_forces(eta);
  constraints_.tangent(forces_, {.q = 1.0}, ConstraintLevel::position, tangent_);
  old_q.noalias() += tangent_.leftCols(n).transpose() * mu_;
  constraints_.add_parameter_adjoints(forces_, ConstraintLevel::position, mu_, sums);
  mu_.topRows(n).setZero();
  mu_.bottomRows(m) = -y.bottomRows(m);
  for (const int i : system_.left_out()) mu_.row(n + i).setZero();
  constraints_.add_parameter_adjoints(state, ConstraintLevel::position, mu_, sums);
}

}  // namespace pleuel
