#pragma once

#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/trust/bent_beams.hpp"
#include "tests/core/trust/findings_of.hpp"
#include "tests/support/bent_cantilever.hpp"
#include "tests/support/problem_runs.hpp"

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
    const std::string clamp =
        R"({"a": {"type": "fixed", "bodies": ["ground", "beam"], "at": [0, 0, 0]}})";
    const std::string pins =
        R"({"a": {"type": "revolute", "bodies": ["ground", "beam"], "at": [0, 0, 0]},
            "b": {"type": "point-on-line", "bodies": ["ground", "beam"], "at": [1, 0, 0],
                  "axis": [1, 0, 0]}})";
    return problem_from(fmt::format(R"({{"name": "stubby", "scene": {{"gravity": [0, 0, 0],
          "materials": {{"steel": {{"young": 2.1e11, "poisson": 0.3, "density": 7850}}}},
          "bodies": {{"beam": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0],
            "material": "steel", "section": {}, "elements": {}, "frames": {}, "frame": "{}"{}}}}},
          "joints": {}, "loads": {{"push": {{"type": "force", "body": "beam", "at": [{}, 0, 0],
            "direction": {}, "value": 1}}}}}},
        "simulation": {{"end_time": 2e-6, "step": 1e-6, "initial_state": "quasi-static"}},
        "responses": {{"asked": {}}}}})",
                                    section, elements, frames, frame, more,
                                    is_pinned ? pins : clamp, is_pinned ? 0.5 : load_at, direction,
                                    response));
  }
};

struct ShearedBeam : StartRun {
  explicit ShearedBeam(const LoadedBeam& beam) : StartRun(beam.problem()) {}
  double share() const {
    State state;
    analysis->trajectory.states->load(0, state);
    return shear_share(problem, x, analysis->model, "beam", state);
  }
  std::vector<Finding> findings() const { return check_variants(run()); }
};

inline std::string rectangle(double height) {
  return fmt::format(R"({{"type": "rectangle", "width": 0.05, "height": {}}})", height);
}

/// The number before " %".
inline double told_percent(const std::string& text) {
  const std::size_t percent = text.find(" %");
  return std::stod(text.substr(text.rfind(' ', percent - 1)));
}

}  // namespace pleuel::test::sheared_beam
