#pragma once

#include "cli/input/arguments.hpp"
#include "cli/reports/outcome.hpp"

/// The commands of the program, one file each. All throw InputError and SimulationError.
namespace pleuel {

Outcome run_accuracy(const Arguments& arguments);
Outcome run_uncertainty(const Arguments& arguments);
Outcome run_backends(const Arguments& arguments);
Outcome run_compare(const Arguments& arguments);
Outcome run_completion(const Arguments& arguments);
Outcome run_check(const Arguments& arguments);
Outcome run_export(const Arguments& arguments);
Outcome run_gradient(const Arguments& arguments);
Outcome run_invariants(const Arguments& arguments);
Outcome run_new(const Arguments& arguments);
Outcome run_optimize(const Arguments& arguments);
Outcome run_pareto(const Arguments& arguments);
Outcome run_plot(const Arguments& arguments);
Outcome run_prices(const Arguments& arguments);
Outcome run_reduce(const Arguments& arguments);
Outcome run_report(const Arguments& arguments);
Outcome run_runs(const Arguments& arguments);
Outcome run_schema(const Arguments& arguments);
Outcome run_show(const Arguments& arguments);
Outcome run_simulate(const Arguments& arguments);
Outcome run_stability(const Arguments& arguments);

}  // namespace pleuel
