#include "core/system/system.hpp"

#include <algorithm>
#include <cassert>

#include "core/base/int_size.hpp"

namespace pleuel {

System::System(int coordinates, int multipliers, int variables,
               std::vector<std::unique_ptr<Term>> terms)
    : coordinates_(coordinates),
      multipliers_(multipliers),
      variables_(variables),
      terms_(std::move(terms)) {
  build_pattern();
}

void System::deactivate(const std::vector<int>& multipliers) {
  left_out_ = multipliers;
  build_pattern();
}

void System::build_pattern() {
  EntryList entries;
  first_entry_.clear();
  for (const auto& term : terms_) {
    first_entry_.push_back(entries.size());
    term->declare_entries(entries);
  }
  std::vector<Eigen::Triplet<double>> triplets;
  for (const auto& [row, col] : entries) triplets.emplace_back(row, col, 0.0);
  // The diagonal serves the initial state, which weighs the distance to the given coordinates.
  for (int i = 0; i < coordinates_; ++i) triplets.emplace_back(i, i, 0.0);
  for (int i : left_out_) triplets.emplace_back(coordinates_ + i, coordinates_ + i, 0.0);
  pattern_.resize(size(), size());
  pattern_.setFromTriplets(triplets.begin(), triplets.end());
  pattern_.makeCompressed();
  entry_count_ = entries.size();
  const auto none = int_size(entries);
  first_of_value_.assign(pattern_.nonZeros(), none);
  more_of_values_.clear();
  for (int entry = 0; entry < none; ++entry) {
    const auto [row, col] = entries[entry];
    const int* begin = pattern_.innerIndexPtr() + pattern_.outerIndexPtr()[col];
    const int* end = pattern_.innerIndexPtr() + pattern_.outerIndexPtr()[col + 1];
    const int* found = std::lower_bound(begin, end, row);
    assert(found != end && *found == row);
    const auto value = static_cast<int>(found - pattern_.innerIndexPtr());
    int& first = first_of_value_[value];
    if (first == none) {
      first = entry;
    } else {
      more_of_values_.emplace_back(value, entry);
    }
  }
}

void System::replace_left_out(const State& state, Eigen::VectorXd& residual) const {
  for (int i : left_out_) residual(coordinates_ + i) = state.lambda(i);
}

void System::replace_left_out(Matrix& matrix) const {
  if (left_out_.empty()) return;
  for (int col = 0; col < size(); ++col) {
    for (int k = matrix.outerIndexPtr()[col]; k < matrix.outerIndexPtr()[col + 1]; ++k) {
      const int row = matrix.innerIndexPtr()[k];
      if (std::ranges::binary_search(left_out_, row - coordinates_)) {
        matrix.valuePtr()[k] = row == col ? 1.0 : 0.0;
      }
    }
  }
}

void System::residual(const State& state, ConstraintLevel level, Eigen::VectorXd& residual) {
  residual.setZero(size());
  for (const auto& term : terms_) term->add_residual(state, level, residual);
  replace_left_out(state, residual);
}

void System::tangent(const State& state, const Weights& weights, ConstraintLevel level,
                     Matrix& matrix) {
  linearize(state, weights, level, unused_, matrix);
}

void System::linearize(const State& state, const Weights& weights, ConstraintLevel level,
                       Eigen::VectorXd& residual, Matrix& matrix) {
  linearize(state, WeightList{&weights, 1}, level, residual, std::span<Matrix>{&matrix, 1});
}

void System::linearize(const State& state, const WeightList& weights, ConstraintLevel level,
                       Eigen::VectorXd& residual, std::span<Matrix> matrices) {
  residual.setZero(size());
  const std::size_t stride = entry_count_ + 1;
  if (entries_.size() < stride * weights.size()) entries_.resize(stride * weights.size());
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    terms_[i]->linearize(state, weights, level, residual,
                         {entries_.data() + first_entry_[i], static_cast<std::ptrdiff_t>(stride)});
  }
  for (std::size_t k = 0; k < matrices.size(); ++k) {
    double* entries = entries_.data() + k * stride;
    entries[entry_count_] = 0.0;
    write_values(entries, matrices[k].valuePtr());
    replace_left_out(matrices[k]);
  }
  replace_left_out(state, residual);
}

void System::write_values(const double* entries, double* values) const {
  for (std::size_t i = 0; i < first_of_value_.size(); ++i) values[i] = entries[first_of_value_[i]];
  for (const auto& [value, entry] : more_of_values_) values[value] += entries[entry];
}

void System::design_derivative(const State& state, ConstraintLevel level,
                               Eigen::MatrixXd& columns) {
  columns.setZero(size(), variables_);
  for (const auto& term : terms_) term->add_design_derivative(state, level, columns);
  for (int i : left_out_) columns.row(coordinates_ + i).setZero();
}

int System::parameter_adjoint_count() const {
  int count = 0;
  for (const auto& term : terms_) count += term->parameter_adjoint_count();
  return count;
}

void System::add_parameter_adjoints(const State& state, ConstraintLevel level,
                                    const ConstColumns& mu, Columns sums) {
  if (!left_out_.empty()) {
    kept_mu_ = mu;
    for (int i : left_out_) kept_mu_.row(coordinates_ + i).setZero();
  }
  const ConstColumns kept = left_out_.empty() ? mu : ConstColumns(kept_mu_);
  Eigen::Index first = 0;
  for (const auto& term : terms_) {
    const Eigen::Index count = term->parameter_adjoint_count();
    if (count > 0) term->add_parameter_adjoints(state, level, kept, sums.middleRows(first, count));
    first += count;
  }
}

Eigen::MatrixXd System::design_gradients(const ConstColumns& sums) const {
  Eigen::MatrixXd gradients = Eigen::MatrixXd::Zero(variables_, sums.cols());
  Eigen::Index first = 0;
  for (const auto& term : terms_) {
    const Eigen::Index count = term->parameter_adjoint_count();
    if (count > 0) term->add_design_gradients(sums.middleRows(first, count), gradients);
    first += count;
  }
  return gradients;
}

void clear_dynamic_block(int coordinates, System::Matrix& matrix) {
  for (int col = 0; col < coordinates; ++col) {
    for (int i = matrix.outerIndexPtr()[col]; i < matrix.outerIndexPtr()[col + 1]; ++i) {
      if (matrix.innerIndexPtr()[i] >= coordinates) break;  // rows are sorted
      matrix.valuePtr()[i] = 0.0;
    }
  }
}

}  // namespace pleuel
