
#include "cli/commands/commands.hpp"
#include "optimization/backends.hpp"

namespace pleuel {

namespace {

/// When to choose which.
std::string advice(const std::string& name) {
  static const std::map<std::string, std::string> known = {
      {"nlopt-mma", "method of moving asymptotes: many variables, inequalities only"},
      {"nlopt-ccsaq", "conservative convex quadratic models: as MMA, simpler models"},
      {"nlopt-slsqp", "sequential quadratic programming: few variables, fastest near the optimum"},
      {"ipopt", "interior point: many constraints, equalities too"}};
  const auto found = known.find(name);
  return found == known.end() ? "" : found->second;
}

}  // namespace

Outcome run_backends(const Arguments&) {
  Table table({left_aligned("backend"), left_aligned("")});
  for (const std::string& name : optimizer_names()) table.add_row({name, advice(name)});
  return {ExitCode::done, {{"backends", optimizer_names()}}, table.text()};
}

}  // namespace pleuel
