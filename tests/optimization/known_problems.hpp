#pragma once

#include <cctype>
#include <complex>
#include <random>
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

/// The same problem with other variables: starts, bounds.
inline FunctionProblem with_variables(const FunctionProblem& problem,
                                      const std::vector<Variable>& variables) {
  return {variables, problem.constraints(),
          [problem = FunctionProblem(problem)](const Eigen::VectorXd& x, Request request) mutable {
            return problem.evaluate(x, request);
          }};
}

/// The same problem where each variable is changed before.
template <class Change>
FunctionProblem with_each_variable(const FunctionProblem& problem, Change change) {
  std::vector<Variable> variables = problem.variables();
  for (Variable& variable : variables) change(variable);
  return with_variables(problem, variables);
}

/// The same problem, started somewhere between its bounds, or between −4 and 4 where it has none.
inline FunctionProblem started_anywhere(const FunctionProblem& problem, std::mt19937& engine) {
  return with_each_variable(problem, [&](Variable& variable) {
    const double lower = std::isfinite(variable.lower) ? variable.lower : -4.0;
    const double upper = std::isfinite(variable.upper) ? variable.upper : 4.0;
    variable.start = std::lerp(lower, upper, double(engine()) / std::mt19937::max());
  });
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

/// The same with the start of the problem.
inline Verdict judge_anew(Problem& problem, const Eigen::VectorXd& x) {
  return judge_anew(problem, checked_start(problem), x);
}

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

/// (f, c₁, c₂, …) from its entries, for functions of any scalar.
template <typename... Scalars>
auto responses(const Scalars&... entries) {
  Vector<std::common_type_t<Scalars...>> result(sizeof...(entries));
  Eigen::Index row = 0;
  ((result[row++] = entries), ...);
  return result;
}

/// A problem of formulas x ↦ responses(f, c₁, c₂, …).
template <typename Responses>
FunctionProblem by_formulas(const std::vector<Variable>& variables,
                            const std::vector<Constraint>& constraints, Responses formulas) {
  return {variables, constraints, by_complex_step(std::move(formulas))};
}

/// A name as that of a test may be.
inline std::string letters_of(std::string name) {
  std::erase_if(name, [](unsigned char letter) { return std::isalnum(letter) == 0; });
  return name;
}

inline std::string name_of_backend(const testing::TestParamInfo<std::string>& tested) {
  return letters_of(tested.param);
}

}  // namespace pleuel::test
