#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/scene/problem_reader.hpp"
#include "tests/support/files.hpp"

/// A problem from its text, with overrides.
inline pleuel::ProblemFile problem_from(const std::string& text,
                                        const std::vector<std::string>& overrides = {}) {
  return pleuel::read_problem_text(text, "problem.json", overrides).complete();
}

/// A problem file of the repository, with overrides.
inline pleuel::ProblemFile sample_problem(const std::string& name,
                                          const std::vector<std::string>& overrides = {}) {
  return pleuel::read_problem(pleuel::source_folder() + "/problems/" + name + ".json", overrides)
      .complete();
}

inline Eigen::Index response_index(const pleuel::ProblemFile& problem, const std::string& name) {
  for (std::size_t i = 0; i < problem.responses.size(); ++i) {
    if (problem.responses[i].name == name) return static_cast<Eigen::Index>(i);
  }
  throw std::runtime_error("no response " + name);
}
