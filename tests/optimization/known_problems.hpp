#pragma once

#include <string>
#include <vector>

#include "optimization/problem.hpp"
#include "optimization/verdict.hpp"

namespace pleuel::test {

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

}  // namespace pleuel::test
