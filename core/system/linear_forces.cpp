#include "core/system/linear_forces.hpp"

#include <algorithm>

#include "core/system/system.hpp"

namespace pleuel {

LinearForces::LinearForces(System& system, ConstraintLevel level)
    : system_(system),
      level_(level),
      with_(system.coordinates(), system.multipliers()),
      without_(with_),
      tangent_without_(system.make_matrix()) {}

void LinearForces::set(const State& place, const Eigen::VectorXd& a,
                       const Eigen::VectorXd& lambda) {
  with_.time = without_.time = place.time;
  with_.q = without_.q = place.q;
  with_.a = a;
  with_.lambda = lambda;
}

void LinearForces::set(const State& place, const Eigen::VectorXd& lambda) {
  set(place, without_.a, lambda);
}

const Eigen::VectorXd& LinearForces::residual() {
  system_.residual(with_, level_, residual_);
  system_.residual(without_, level_, residual_without_);
  residual_ -= residual_without_;
  return residual_;
}

void LinearForces::tangent(System::Matrix& matrix) {
  system_.tangent(with_, {.q = 1.0}, level_, matrix);
  system_.tangent(without_, {.q = 1.0}, level_, tangent_without_);
  // The columns of multipliers, which are the same in both, are F_λ.
  const Eigen::Index count = matrix.outerIndexPtr()[system_.coordinates()];
  matrix.coeffs().head(count) -= tangent_without_.coeffs().head(count);
}

const Eigen::MatrixXd& LinearForces::design_derivative() {
  system_.design_derivative(with_, level_, columns_);
  system_.design_derivative(without_, level_, columns_without_);
  columns_ -= columns_without_;
  return columns_;
}

void LinearForces::add_parameter_adjoints(const ConstColumns& mu, Columns sums) {
  system_.add_parameter_adjoints(with_, level_, mu, sums);
  minus_mu_ = -mu;
  system_.add_parameter_adjoints(without_, level_, minus_mu_, sums);
}

ConstraintTerms::ConstraintTerms(const System& system) : system_(system) {
  const int n = system.coordinates();
  const System::Matrix pattern = system.make_matrix();
  const std::vector<int>& left_out = system.left_out();
  Eigen::Index first_sum = 0;
  for (const auto& term : system.terms()) {
    EntryList entries;
    term->declare_entries(entries);
    const Eigen::Index sums = term->parameter_adjoint_count();
    const auto is_constraint = [n](const auto& entry) { return entry.first >= n; };
    if (std::ranges::any_of(entries, is_constraint)) {
      parts_.push_back({term.get(), slots_.size(), first_sum, sums});
      for (const auto& [row, col] : entries) {
        const bool is_left_out = std::ranges::binary_search(left_out, row - n);
        slots_.push_back(is_left_out ? -1 : slot_of(pattern, row, col));
      }
    }
    first_sum += sums;
  }
  for (const int i : left_out) ones_.push_back(slot_of(pattern, n + i, n + i));
  entries_.resize(slots_.size());
}

void ConstraintTerms::residual(const State& state, ConstraintLevel level,
                               Eigen::VectorXd& residual) {
  residual.setZero(system_.size());
  for (const Part& part : parts_) part.term->add_residual(state, level, residual);
  for (const int i : system_.left_out()) residual(system_.coordinates() + i) = 0.0;
}

void ConstraintTerms::tangent(const State& state, const Weights& weights, ConstraintLevel level,
                              System::Matrix& matrix) {
  unused_.setZero(system_.size());
  for (const Part& part : parts_) {
    part.term->linearize(state, {&weights, 1}, level, unused_,
                         {entries_.data() + part.first_entry, 0});
  }
  matrix.coeffs().setZero();
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    if (slots_[i] >= 0) matrix.valuePtr()[slots_[i]] += entries_[i];
  }
  for (const int slot : ones_) matrix.valuePtr()[slot] = 1.0;
}

void ConstraintTerms::design_derivative(const State& state, ConstraintLevel level,
                                        Eigen::MatrixXd& columns) {
  columns.setZero(system_.size(), system_.variables());
  for (const Part& part : parts_) part.term->add_design_derivative(state, level, columns);
  for (const int i : system_.left_out()) columns.row(system_.coordinates() + i).setZero();
}

void ConstraintTerms::add_parameter_adjoints(const State& state, ConstraintLevel level,
                                             const ConstColumns& mu, Columns sums) {
  for (const Part& part : parts_) {
    if (part.sums == 0) continue;
    part.term->add_parameter_adjoints(state, level, mu, sums.middleRows(part.first_sum, part.sums));
  }
}

}  // namespace pleuel
