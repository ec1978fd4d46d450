/// How good gradients are with derivatives of the invariants that are not exact: the slider-crank
/// with each choice and some steps, as a table (Markdown).
///
///     invariant_derivatives [ENDTIME in s, default 0.02]

#include <cstdlib>

#include <fmt/format.h>

#include "core/scene/problem_reader.hpp"
#include "sensitivity/sampled_gradients.hpp"

namespace pleuel::bench {
namespace {

ProblemFile slider_crank(double end_time) {
  ProblemFile problem =
      read_problem(PLEUEL_SOURCE_DIR "/problems/slider_crank.json", {}).complete();
  problem.simulation.end_time = end_time;
  return problem;
}

/// By relative changes of the variables.
Eigen::MatrixXd gradients_with(ProblemFile problem, const InvariantDifferentiation& choice) {
  problem.sensitivity.invariants = choice;
  const Eigen::VectorXd x = start_design(problem);
  const auto analysis = analyze(problem, x);
  return sampled_gradients(*analysis, response_values(*analysis), ExactMethod::direct) *
         x.asDiagonal();
}

/// The largest of all responses, each relative to its largest derivative.
double error_of(const Eigen::MatrixXd& found, const Eigen::MatrixXd& exact) {
  double worst = 0.0;
  for (Eigen::Index i = 0; i < exact.rows(); ++i) {
    worst = std::max(worst, (found - exact).row(i).lpNorm<Eigen::Infinity>() /
                                exact.row(i).lpNorm<Eigen::Infinity>());
  }
  return worst;
}

void print_table(double end_time) {
  using enum InvariantDerivatives;
  const ProblemFile problem = slider_crank(end_time);
  const Eigen::MatrixXd expected = gradients_with(problem, {exact});
  const auto error = [&](const InvariantDifferentiation& choice) {
    return error_of(gradients_with(problem, choice), expected);
  };
  fmt::print("| invariant_derivatives | step | error of the gradients |\n|---|---|---|\n");
  fmt::print("| complex-step | | {:.0e} |\n", error({complex_step}));
  for (const InvariantDerivatives choice : {central, forward}) {
    for (const double step : {1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-10, 0.0}) {
      const std::string text = step > 0.0 ? fmt::format("{:.0e}", step) : "default";
      fmt::print("| {} | {} | {:.0e} |\n", word_of(invariant_derivatives, choice), text,
                 error({choice, step}));
    }
  }
}

}  // namespace
}  // namespace pleuel::bench

int main(int argc, char** argv) {
  pleuel::bench::print_table(argc > 1 ? std::atof(argv[1]) : 0.02);
}
