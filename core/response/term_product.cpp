#include "core/response/term_product.hpp"

#include <algorithm>
#include <array>

#include "core/base/eager_matrices.hpp"
#include "core/base/int_size.hpp"

namespace pleuel {

TermProduct::TermProduct(std::vector<Term*> terms, const System& system)
    : terms_(std::move(terms)),
      residual_(system.size()),
      design_(system.size(), system.variables()) {
  std::size_t largest = 0;
  for (const Term* term : terms_) {
    entries_.emplace_back();
    term->declare_entries(entries_.back());
    largest = std::max(largest, entries_.back().size());
  }
  values_.resize(3 * largest);
}

const Eigen::VectorXd& TermProduct::residual(const State& state, ConstraintLevel level) {
  residual_.setZero();
  for (Term* term : terms_) term->add_residual(state, level, residual_);
  return residual_;
}

void TermProduct::add_gradient(const State& state, ConstraintLevel level,
                               const Eigen::VectorXd& rows, SignalGradient& gradient) {
  static constexpr std::array<Weights, 3> by_q_v_a = {{{.q = 1.0}, {.v = 1.0}, {.a = 1.0}}};
  const auto n = int_size(state.q);
  residual_.setZero();
  design_.setZero();
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    const std::size_t count = entries_[i].size();
    terms_[i]->linearize(state, by_q_v_a, level, residual_,
                         {values_.data(), static_cast<std::ptrdiff_t>(count)});
    for (std::size_t k = 0; k < count; ++k) {
      const auto [row, col] = entries_[i][k];
      const double* value = values_.data() + k;
      if (col >= n) {
        gradient.lambda(col - n) += rows(row) * value[0];
        continue;
      }
      gradient.q(col) += rows(row) * value[0];
      gradient.v(col) += rows(row) * value[count];
      gradient.a(col) += rows(row) * value[2 * count];
    }
    terms_[i]->add_design_derivative(state, level, design_);
  }
  gradient.design += design_.transpose() * rows;
}

}  // namespace pleuel
