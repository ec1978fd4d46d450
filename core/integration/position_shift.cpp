#include "core/integration/position_shift.hpp"

#include <algorithm>
#include <cassert>

#include "core/integration/matrix_entries.hpp"

namespace pleuel {

namespace {

int find_slot(const System::Matrix& matrix, int row, int col) {
  const int* begin = matrix.innerIndexPtr() + matrix.outerIndexPtr()[col];
  const int* end = matrix.innerIndexPtr() + matrix.outerIndexPtr()[col + 1];
  const int* found = std::lower_bound(begin, end, row);
  assert(found != end && *found == row);
  return static_cast<int>(found - matrix.innerIndexPtr());
}

}  // namespace

PositionShift::PositionShift(Mechanism& mechanism)
    : mechanism_(mechanism),
      system_(*mechanism.system),
      old_constraints_(system_.make_matrix()),
      forces_(system_),
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
  slots_.resize(static_cast<std::size_t>(block.nonZeros()));
  for_each_entry(block, [&](std::size_t k, int row, int col) {
    slots_[k].in_11 = find_slot(pattern_, row, col);
    if (is_in_12(col)) slots_[k].in_12 = find_slot(pattern_, row, size + col);
    if (is_in_21(row, col)) slots_[k].in_21 = find_slot(pattern_, size + row, col);
    if (is_in_22(row, col)) slots_[k].in_22 = find_slot(pattern_, size + row, size + col);
  });
}

void PositionShift::begin(const State& old) {
  old_ = old;
  system_.tangent(old_, {}, ConstraintLevel::position, old_constraints_);
}

void PositionShift::residual(const State& state, const Eigen::VectorXd& shift,
                             const Eigen::VectorXd& eta, Eigen::Ref<Eigen::VectorXd> residual) {
  const int n = system_.coordinates(), m = system_.multipliers();
  residual.head(n) = mechanism_.assembly_weight.cwiseProduct(shift);
  for_each_entry(old_constraints_, [&](std::size_t k, int row, int col) {
    if (col < n || row >= n) return;
    residual(row) += old_constraints_.valuePtr()[k] * eta(col - n);
  });
  system_.residual(state, ConstraintLevel::position, system_residual_);
  residual.tail(m) = system_residual_.tail(m);
  for (int i : system_.left_out()) residual(n + i) = eta(i);
}

void PositionShift::write_matrix(const Tangents& tangents, double dynamic_scale,
                                 double constraint_scale, System::Matrix& matrix) const {
  const int n = system_.coordinates();
  double* out = matrix.valuePtr();
  const double* with_v = tangents.with_v.valuePtr();
  for_each_entry(tangents.step, [&](std::size_t k, int row, int col) {
    const Slots& slots = slots_[k];
    out[slots.in_11] = tangents.step.valuePtr()[k];
    if (slots.in_12) {
      out[*slots.in_12] =
          (row < n ? dynamic_scale : constraint_scale) * tangents.with_q.valuePtr()[k];
    }
    if (slots.in_21) out[*slots.in_21] = with_v[k];
    if (!slots.in_22) return;
    if (col < n) {
      out[*slots.in_22] = row < n ? mechanism_.assembly_weight(row) : with_v[k];
    } else {
      out[*slots.in_22] = old_constraints_.valuePtr()[k];
    }
  });
}

void PositionShift::differentiate(const State& state, const Eigen::VectorXd& eta,
                                  const Eigen::MatrixXd& old_q, DerivativesOf of,
                                  Eigen::Ref<Eigen::MatrixXd> rhs) {
  const int n = system_.coordinates(), m = system_.multipliers();
  forces_.set(old_, eta);
  forces_.tangent(tangent_);
  columns_.setZero(n + m, old_q.cols());
  if (of == DerivativesOf::design) columns_ = forces_.design_derivative();
  columns_.noalias() += tangent_.leftCols(n) * old_q;
  rhs.topRows(n) = -columns_.topRows(n);
  rhs.bottomRows(m).setZero();
  if (of == DerivativesOf::old_state) return;
  system_.design_derivative(state, ConstraintLevel::position, columns_);
  rhs.bottomRows(m) = -columns_.bottomRows(m);
}

void PositionShift::differentiate_transposed(const State& state, const Eigen::VectorXd& eta,
                                             const ConstColumns& y, Columns old_q, Columns sums) {
  const int n = system_.coordinates(), m = system_.multipliers();
  mu_.setZero(n + m, y.cols());
  mu_.topRows(n) = -y.topRows(n);
  forces_.set(old_, eta);
  forces_.tangent(tangent_);
  old_q.noalias() += tangent_.leftCols(n).transpose() * mu_;
  forces_.add_parameter_adjoints(mu_, sums);
  mu_.topRows(n).setZero();
  mu_.bottomRows(m) = -y.bottomRows(m);
  system_.add_parameter_adjoints(state, ConstraintLevel::position, mu_, sums);
}

}  // namespace pleuel
