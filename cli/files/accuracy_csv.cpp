#include "cli/files/accuracy_csv.hpp"

#include <fmt/format.h>

namespace pleuel {

namespace {

std::vector<std::string> header(const ProblemFile& problem) {
  std::vector<std::string> titles = {
      "step",           "elements",           "steps",           "newton_iterations",
      "factorizations", "simulation_seconds", "gradient_seconds"};
  for (const char* kind : {"error:", "gradient_error:"}) {
    for (const ResponseSettings& response : problem.responses) {
      titles.push_back(kind + response.name);
    }
  }
  titles.push_back("failure");
  return titles;
}

}  // namespace

AccuracyCsv::AccuracyCsv(const ResultFile& file, const ProblemFile& problem)
    : csv_(file, header(problem)), responses_(problem.responses.size()) {}

void AccuracyCsv::add(const AccuracyRun& run) {
  csv_.add(run.settings.step);
  if (run.settings.elements > 0) {
    csv_.add(run.settings.elements);
  } else {
    csv_.add(fmt::format("×{:g}", run.settings.factor));
  }
  csv_.add(run.steps).add(run.newton_iterations).add(run.factorizations);
  csv_.add(run.simulation_seconds).add(run.gradient_seconds);
  add(run.errors);
  add(run.gradient_errors);
  csv_.add(run.failure);
  csv_.end_row();
}

/// Empty cells where nothing is known: after a failure, or without variables.
void AccuracyCsv::add(const Eigen::VectorXd& errors) {
  for (std::size_t i = 0; i < responses_; ++i) {
    if (errors.size() == 0) {
      csv_.add(std::string());
    } else {
      csv_.add(errors(i));
    }
  }
}

}  // namespace pleuel
