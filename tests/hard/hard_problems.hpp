#pragma once

#include <cctype>
#include <memory>

#include "core/response/analysis.hpp"
#include "core/response/monitors.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/test.hpp"

/// What the tests of hard cases share: the formulations that all of them run with, and short ways
/// to a history.
namespace pleuel::test {

/// The formulations of the constrained equations of motion that have to get everything right. Index
/// 1 drifts: see Index1 in scheme_test.cpp.
inline std::vector<std::string> formulations() {
  return {"index-3", "stabilized-index-2"};
}

/// A test that runs with each formulation.
class HardCase : public testing::TestWithParam<std::string> {
 protected:
  /// @param overrides  what differs from problems/hard/NAME.json
  static ProblemFile problem(const std::string& name, std::vector<std::string> overrides = {}) {
    overrides.push_back("/simulation/formulation=" + GetParam());
    return sample_problem("hard/" + name, overrides);
  }
  static std::unique_ptr<Analysis> run(const std::string& name,
                                       const std::vector<std::string>& overrides = {}) {
    return run(problem(name, overrides));
  }
  static std::unique_ptr<Analysis> run(const ProblemFile& problem) {
    return analyze(problem, start_design(problem));
  }
};

/// Of the one-channel history of a response, one number a step.
inline Eigen::RowVectorXd history_of(const Analysis& analysis, const std::string& response) {
  for (std::size_t i = 0; i < analysis.responses.size(); ++i) {
    if (analysis.responses[i].name == response) return analysis.histories[i].row(0);
  }
  throw std::runtime_error("no response " + response);
}

inline double value_of(const Analysis& analysis, const std::string& response) {
  for (std::size_t i = 0; i < analysis.responses.size(); ++i) {
    if (analysis.responses[i].name == response) return analysis.reductions[i].value;
  }
  throw std::runtime_error("no response " + response);
}

/// Largest violation of any constraint at any step [m] or [rad], of redundant ones that are left
/// out of the system, too.
inline double largest_violation(const Analysis& analysis) {
  return monitor(analysis.model, analysis.trajectory).position_drift;
}

inline std::string step_of(double seconds) {
  return fmt::format("/simulation/step={:.17g}", seconds);
}
inline std::string end_of(double seconds) {
  return fmt::format("/simulation/end_time={:.17g}", seconds);
}

inline std::string formulation_name(const testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;  // letters and digits only
  std::erase_if(name, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; });
  return name;
}

}  // namespace pleuel::test

/// Runs the tests of a fixture with each formulation.
#define PLEUEL_WITH_EACH_FORMULATION(fixture)                                 \
  INSTANTIATE_TEST_SUITE_P(Formulations, fixture,                             \
                           testing::ValuesIn(::pleuel::test::formulations()), \
                           ::pleuel::test::formulation_name)
