#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/response/analysis.hpp"
#include "core/scene/problem_reader.hpp"
#include "core/trust/doubts.hpp"
#include "core/trust/model_variants.hpp"

namespace pleuel::test {

/// A problem, simulated at its start design, and what its doubts are made from.
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

using FindDoubts = std::vector<Doubt> (*)(const TrustedRun&);

/// What one kind of doubt says of the start design of a problem.
inline std::vector<Doubt> doubts_of(const ProblemFile& problem, FindDoubts find) {
  return find(StartRun(problem).run());
}

/// What variants of the model say, as one kind of doubt.
inline std::vector<Doubt> doubt_variants(const TrustedRun& run) {
  return compare_variants(run).doubts;
}

/// What all kinds of doubts say of it.
inline std::vector<Doubt> doubts_of(const ProblemFile& problem) {
  const Eigen::VectorXd x = start_design(problem);
  return find_doubts(problem, x, *analyze(problem, x));
}

inline ProblemFile read_scene(const std::string& text,
                              const std::vector<std::string>& overrides = {}) {
  return read_problem_text(text, "test.json", overrides).complete();
}

}  // namespace pleuel::test
