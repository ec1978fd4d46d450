#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/response/analysis.hpp"
#include "core/trust/checks.hpp"
#include "core/trust/model_variants.hpp"
#include "tests/support/problem_runs.hpp"

namespace pleuel::test {

/// A problem, simulated at its start design, and what its findings are made from.
struct StartRun {
  ProblemFile problem;
  Eigen::VectorXd x;
  std::unique_ptr<Analysis> analysis;
  Monitors monitors;

  explicit StartRun(ProblemFile file)
      : problem(std::move(file)),
        x(start_design(problem)),
        analysis(analyze(problem, x)),
        monitors(monitor(analysis->model, analysis->trajectory)) {}

  TrustedRun run() const { return {problem, x, *analysis, monitors}; }
};

using FindChecks = std::vector<Finding> (*)(const TrustedRun&);

/// What one kind of finding says of the start design of a problem.
inline std::vector<Finding> findings_of(const ProblemFile& problem, FindChecks find) {
  return find(StartRun(problem).run());
}

/// The one finding that there is.
inline Finding only(const std::vector<Finding>& findings) {
  EXPECT_EQ(findings.size(), 1u);
  return findings.empty() ? Finding{} : findings.front();
}

/// What variants of the model say, as one kind of finding.
inline std::vector<Finding> check_variants(const TrustedRun& run) {
  return compare_variants(run).findings;
}

/// What all kinds of findings say of it.
inline std::vector<Finding> findings_of(const ProblemFile& problem) {
  const Eigen::VectorXd x = start_design(problem);
  return check_run(problem, x, *analyze(problem, x));
}

inline ProblemFile read_scene(const std::string& text,
                              const std::vector<std::string>& overrides = {}) {
  return problem_from(text, overrides);
}

}  // namespace pleuel::test
