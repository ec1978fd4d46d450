#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/response/analysis.hpp"
#include "core/trust/bent_beams.hpp"
#include "core/trust/check_list.hpp"
#include "core/trust/checks.hpp"
#include "tests/support/at_start.hpp"
#include "tests/support/one_beam.hpp"

namespace pleuel::test {

/// A problem, simulated at its start design, and what its findings are made from.
struct StartRun : AtStart {
  using AtStart::AtStart;
  Monitors monitors = monitor(analysis->model, analysis->trajectory);

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
  const auto [x, analysis] = started(problem);
  return check_run(problem, x, *analysis);
}

inline ProblemFile read_scene(const std::string& text,
                              const std::vector<std::string>& overrides = {}) {
  return problem_from(text, overrides);
}

/// What is said of a scene's bending and of its compression.
inline std::vector<Finding> buckling_findings_of(const std::string& text) {
  const ProblemFile problem = read_scene(text);
  std::vector<Finding> findings = findings_of(problem, check_sideways_buckling);
  for (const Finding& finding : findings_of(problem, check_stability)) findings.push_back(finding);
  return findings;
}

/// A crank-rocker of steel rods, with gravity and without.
inline std::string crank_rocker(const std::string& drive, const std::string& more_joints,
                                const std::string& gravity = "[0, 0, 0]") {
  const auto rod = [](const char* name, const char* from, const char* to) {
    return fmt::format(
        R"("{}": {{"type": "beam", "from": {}, "to": {}, "material": "steel", "rigid": true, "elements": 1,
            "section": {{"type": "circle", "diameter": "20 mm"}}}})",
        name, from, to);
  };
  return fmt::format(
      R"({{"scene": {{"gravity": {}, "bodies": {{{}, {}, {}}},
          "joints": {{"A": {{"type": "revolute", "bodies": ["ground", "crank"], "at": [0, 0, 0]{}}},
                      "B": {{"type": "revolute", "bodies": ["crank", "coupler"], "at": [0.1, 0, 0]}},
                      "C": {{"type": "revolute", "bodies": ["coupler", "rocker"], "at": [0.4, 0.2, 0]}}{}}}}},
          "simulation": {{"end_time": 0.05, "step": 0.001}},
          "responses": {{"m": {{"type": "mass"}},
                         "v": {{"type": "velocity", "body": "rocker", "at": 1, "direction": "magnitude",
                                "over_time": "max"}}}}}})",
      gravity, rod("crank", "[0, 0, 0]", "[0.1, 0, 0]"),
      rod("coupler", "[0.1, 0, 0]", "[0.4, 0.2, 0]"), rod("rocker", "[0.4, 0.2, 0]", "[0.4, 0, 0]"),
      drive, more_joints);
}
inline const std::string driven = R"(, "drive": {"type": "constant-speed", "speed": "300 rpm"})";
inline const std::string closed =
    R"(, "D": {"type": "revolute", "bodies": ["ground", "rocker"], "at": [0.4, 0, 0]})";

}  // namespace pleuel::test

/// Beams to which shear may matter, and what is told of them.

namespace pleuel::test::sheared_beam {

inline constexpr double nu = 0.3;

/// A beam of 1 m in equilibrium under a force of 1 N along y.
struct LoadedBeam {
  std::string section;
  bool is_pinned = false;  ///< at both ends, with the force in the middle; else a cantilever
  std::string frame = "tangent",
              response = R"({"type": "deflection", "body": "beam", "at": 1, "over_time": "max"})";
  int frames = 1, elements = 8;
  std::string more = "";  ///< further keys of the beam, with a comma in front
  std::string direction = "[0, 1, 0]";
  double load_at = 1.0;  ///< of a cantilever [m]

  ProblemFile problem() const {
    const double at = is_pinned ? 0.5 : load_at;
    return OneBeam{
        .section = section,
        .elements = elements,
        .more = fmt::format(R"("frames": {}, "frame": "{}"{})", frames, frame, more),
        .materials = plain_steel,
        .joints = is_pinned ? on_two_supports("beam") : "",
        .loads = fmt::format(R"("push": {{"type": "force", "body": "beam", "at": [{}, 0, 0],
                                         "direction": {}, "value": 1}})",
                             at, direction),
        .simulation = at_rest(2e-6, 1e-6),
        .responses = R"("asked": )" + response}
        .problem();
  }
};

struct ShearedBeam : StartRun {
  explicit ShearedBeam(const LoadedBeam& beam) : StartRun(beam.problem()) {}
  double share() const {
    return shear_share(problem, x, analysis->model, "beam", state_of(analysis->trajectory, 0));
  }
  std::vector<Finding> findings() const { return check_variants(run()); }
};

/// Of 50 mm.
inline std::string rectangle(double height) {
  return test::rectangle(0.05, height);
}

/// The number before " %".
inline double told_percent(const std::string& text) {
  const std::size_t percent = text.find(" %");
  return std::stod(text.substr(text.rfind(' ', percent - 1)));
}

}  // namespace pleuel::test::sheared_beam
