#pragma once

#include <memory>
#include <utility>

#include "core/response/analysis.hpp"
#include "tests/support/problem_runs.hpp"

namespace pleuel::test {

/// The start of a problem, simulated.
struct Started {
  Eigen::VectorXd x;
  std::unique_ptr<Analysis> analysis;
};
inline Started started(const ProblemFile& problem) {
  const Eigen::VectorXd x = start_design(problem);
  return {x, analyze(problem, x)};
}

/// A problem with its start, simulated: what nearly every test of responses begins with.
struct AtStart {
  ProblemFile problem;
  Eigen::VectorXd x = start_design(problem);
  std::unique_ptr<Analysis> analysis = analyze(problem, x);

  explicit AtStart(ProblemFile file) : problem(std::move(file)) {}
  explicit AtStart(const std::string& text) : AtStart(problem_from(text)) {}

  Eigen::VectorXd values() const { return values_of(*analysis); }
  double value(const std::string& response) const {
    return values()(response_index(problem, response));
  }
  Eigen::VectorXd history(const std::string& response) const {
    return analysis->histories[response_index(problem, response)].row(0);
  }
};

/// A state of a trajectory.
inline State state_of(const Trajectory& trajectory, int step) {
  return trajectory.state_at(step);
}
inline State last_state(const Trajectory& trajectory) {
  return state_of(trajectory, trajectory.steps());
}

}  // namespace pleuel::test
