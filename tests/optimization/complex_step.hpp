#pragma once

#include <complex>
#include <utility>

#include "optimization/problem.hpp"

namespace pleuel::test {

template <typename Scalar>
using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;

/// Evaluation of a generic function object x ↦ (f, c₁, c₂, …), with gradients by the complex step
/// ∂φ/∂xᵢ = Im φ(x + i h eᵢ) / h, exact to rounding (Squire & Trapp 1998).
template <typename Responses>
FunctionProblem::Function by_complex_step(Responses responses) {
  return [responses = std::move(responses)](const Eigen::VectorXd& x, Request request) {
    constexpr double step = 1e-30;
    const Eigen::VectorXd values = responses(x);
    Evaluation evaluation;
    evaluation.objective = values[0];
    evaluation.constraints = values.tail(values.size() - 1);
    if (request == Request::values) return evaluation;
    Eigen::MatrixXd jacobian(values.size(), x.size());
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      Vector<std::complex<double>> moved = x.cast<std::complex<double>>();
      moved[i] += std::complex<double>(0.0, step);
      jacobian.col(i) = responses(moved).imag() / step;
    }
    evaluation.objective_gradient = jacobian.row(0);
    evaluation.constraint_jacobian = jacobian.bottomRows(values.size() - 1);
    return evaluation;
  };
}

}  // namespace pleuel::test
