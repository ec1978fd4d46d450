#include <cmath>

#include <gtest/gtest.h>

#include "core/scene/problem_reader.hpp"
#include "optimization/design/design_solve.hpp"

/// A limit on lateral buckling decides an optimum.
namespace pleuel::test {
namespace {

constexpr double length = 1.2, height = 0.04, force = 10.0, young = 2.1e11, shear = 8.0e10,
                 density = 7850.0;

/// A flat bar on edge, clamped at one end, with a force across at the other.
ProblemFile flat_bar() {
  return read_problem_text(
      R"j({"scene": {
    "materials": {"steel": {"young": "210 GPa", "poisson": 0.3125, "density": 7850,
                            "strength": "235 MPa"}},
    "bodies": {"bar": {"type": "beam", "from": [0, 0, 0], "to": [1.2, 0, 0], "material": "steel",
      "section": {"type": "rectangle", "width": {"variable": "b"}, "height": "40 mm"},
      "elements": 16}},
    "joints": {"wall": {"type": "fixed", "bodies": ["ground", "bar"], "at": [0, 0, 0]}},
    "loads": {"f": {"type": "force", "body": "bar", "at": [1.2, 0, 0], "direction": [0, -1, 0],
                    "value": "10 N"}}},
  "effects": {"geometric_stiffening": "off"},
  "simulation": {"end_time": "2 ms", "step": "1 ms", "initial_state": "quasi-static",
                 "resolution_check": false},
  "variables": {"b": {"start": "5 mm", "lower": "0.5 mm", "upper": "20 mm"}},
  "responses": {"mass": {"type": "mass"},
    "stress": {"type": "stress", "body": "bar", "part": "utilization", "over_time": "max"},
    "sideways": {"type": "lateral-buckling", "body": "bar", "over_time": "max"}},
  "objective": {"minimize": "mass"},
  "constraints": {"stress": {"response": "stress", "upper": 0.5},
                  "sideways": {"response": "sideways", "upper": 0.5}}})j",
      "flat_bar.json");
}

/// F/F_cr with F_cr = 4.0126 √(EI GJ)/L² (Timoshenko & Gere, §6.3), J = hb³/3 (1 − 0.63 b/h), over
/// √(1 − EI/EI_bending).
double closed_form(double b) {
  const double cube = height * b * b * b;
  const double lateral = young * cube / 12, twisting = shear * cube / 3 * (1 - 0.63 * b / height);
  const double held = std::sqrt(1 - b * b / (height * height));
  return force * held * length * length / (4.0126 * std::sqrt(lateral * twisting));
}

/// The share falls as b⁻³: an error of 1e-3 of sixteen elements is a third of that in b. Stress alone
/// would be content with 0.4 mm.
TEST(LateralLimit, SizesAFlatBar) {
  DesignProblem design(flat_bar());
  const Result result = solve_design(design, SolveOptions());
  EXPECT_EQ(result.status, Status::verified) << result.message;
  double low = 1e-4, high = 0.02;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (closed_form(middle) > 0.5 ? low : high) = middle;
  }
  EXPECT_NEAR(result.x(0) / low, 1.0, 1e-3);
  EXPECT_NEAR(result.evaluation.objective, density * height * result.x(0) * length, 1e-9);
  const double stress = force * length / (result.x(0) * height * height / 6);
  EXPECT_LT(stress, 0.5 * 235e6);
}

}  // namespace
}  // namespace pleuel::test
