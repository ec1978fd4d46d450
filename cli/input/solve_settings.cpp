#include "cli/input/solve_settings.hpp"

#include "core/base/error.hpp"
#include "optimization/backends.hpp"

namespace pleuel {

SolveOptions solve_options(const ProblemFile& problem, const Arguments& arguments) {
  SolveOptions options;
  options.backend = arguments.backend.value_or(problem.optimizer.backend);
  if (!arguments.backend && !problem.optimizer.names_backend) {
    options.other_backends = {"nlopt-mma", "ipopt", "nlopt-ccsaq"};
  }
  options.tolerance = problem.optimizer.tolerance;
  options.checks_numbers = arguments.scrutiny != Scrutiny::none;
  options.max_iterations = problem.optimizer.max_iterations;
  try {
    make_optimizer(options.backend, {options.tolerance});
  } catch (const InputError& error) {
    throw InputError((arguments.backend ? "--backend: " : "/optimizer/backend: ") +
                     std::string(error.what()));
  }
  return options;
}

Json options_document(const SolveOptions& options, const ProblemFile& problem) {
  return {{"backend", options.backend},
          {"other_backends", options.other_backends},
          {"method", to_string(problem.sensitivity.method)},
          {"tolerance", options.tolerance},
          {"max_iterations", options.max_iterations},
          {"max_restarts", options.max_restarts},
          {"max_escapes", options.max_escapes},
          {"max_consecutive_failures", options.max_consecutive_failures},
          {"max_polishes", options.max_polishes},
          {"polish_iterations", options.polish_iterations},
          {"patience", options.patience},
          {"verdict",
           {{"kkt_residual", options.verdict.kkt_residual},
            {"variable_residual", options.verdict.variable_residual},
            {"violation", options.verdict.violation},
            {"gradient", options.verdict.gradient},
            {"gain", options.verdict.gain}}}};
}

}  // namespace pleuel
