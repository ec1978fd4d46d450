#pragma once

#include <complex>
#include <string>
#include <utility>
#include <vector>

#include "optimization/problem.hpp"
#include "optimization/result.hpp"
#include "optimization/verdict.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test {

/// What a search found; a test failure if it is not verified.
inline Result verified(const Result& result) {
  EXPECT_EQ(result.status, Status::verified) << result.message;
  return result;
}

/// The same problem where something happens to its evaluations.
/// @param change  of a design and its evaluation; may throw
template <class Change>
FunctionProblem changed(const FunctionProblem& problem, Change change) {
  return {problem.variables(), problem.constraints(),
          [problem = FunctionProblem(problem), change](const Eigen::VectorXd& x,
                                                       Request request) mutable {
            Evaluation evaluation = problem.evaluate(x, request);
            change(x, evaluation);
            return evaluation;
          }};
}

/// A problem with published optimum.
struct KnownProblem {
  std::string name;
  FunctionProblem problem;
  double optimum;  ///< f*
};

/// Hock & Schittkowski, Test Examples for Nonlinear Programming Codes, 1981, nos. 35, 43, 71, 100.
KnownProblem hs035();
KnownProblem hs043();
KnownProblem hs071();
KnownProblem hs100();

/// Svanberg, The method of moving asymptotes, 1987: a cantilever of five hollow squares under a tip
/// load. f* = 0.0624 S^{4/3} d^{−1/3} with S = Σ aᵢ^{1/4}, by the stationarity of the Lagrangian.
/// @param limit  d, of the tip deflection Σ aᵢ / xᵢ³.
KnownProblem cantilever(double limit = 1.0);

/// Three bars, two loads, stress limits (Nowacki 1974). f* = 100 (2√2 x₁ + x₂), only the first
/// stress is active.
KnownProblem three_bar_truss();

/// Arora, Introduction to Optimum Design, 1989: the lightest spring under a tension load.
KnownProblem tension_spring();

/// Ten bars under stress limits (Haftka & Gürdal, Elements of Structural Optimization, 1992). A
/// small finite element model of the bars is solved at every evaluation.
KnownProblem ten_bar_truss();

std::vector<KnownProblem> all_known_problems();

/// The verdict on any design, as if a run from this start had ended there.
Verdict judge_anew(Problem& problem, const Eigen::VectorXd& start, const Eigen::VectorXd& x);

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

/// "nlopt-mma" as the name of a test: letters and digits only.
inline std::string name_of_backend(const testing::TestParamInfo<std::string>& tested) {
  std::string name = tested.param;
  std::erase(name, '-');
  return name;
}

}  // namespace pleuel::test
