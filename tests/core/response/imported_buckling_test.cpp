#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "core/base/eager_matrices.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/core/response/exchange.hpp"

/// Imported bodies under compression: buckling, and vibration about a stressed state.
namespace pleuel::test::imported_buckling_test {
namespace {

using testing::HasSubstr;

/// A steel column of 1 m, 20 mm wide and 30 mm high (weaker along z), held at one end and pressed by
/// 5 kN along its axis; E = 210 GPa.
Json column(const std::string& frame) {
  return Json::parse(fmt::format(R"({{
    "name": "column",
    "scene": {{
      "materials": {{"steel": {{"young": "210 GPa", "poisson": 0.3, "density": 7850}}}},
      "bodies": {{"rod": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "steel",
        "section": {{"type": "rectangle", "width": {{"variable": "width"}},
                     "height": {{"variable": "height"}}}},
        "elements": 6, "frame": "{}"}}}},
      "joints": {{"foot": {{"type": "fixed", "bodies": ["ground", "rod"], "at": [0, 0, 0]}}}},
      "loads": {{"press": {{"type": "force", "body": "rod", "at": [1, 0, 0],
                            "direction": [-1, 0, 0], "value": "5 kN"}}}}
    }},
    "simulation": {{"end_time": "1 ms", "step": "0.5 ms", "initial_state": "quasi-static"}},
    "effects": {{"spatial_motion": "on"}},
    "variables": {{"width": {{"start": "20 mm", "lower": "5 mm", "upper": "60 mm"}},
                   "height": {{"start": "30 mm", "lower": "5 mm", "upper": "60 mm"}}}},
    "responses": {{
      "buckling": {{"type": "buckling", "body": "rod", "over_time": "max"}},
      "slow": {{"type": "frequency", "mode": 1}},
      "next": {{"type": "frequency", "mode": 2}},
      "mass": {{"type": "mass"}}
    }},
    "objective": {{"minimize": "mass"}}
  }})",
                                 frame));
}

Json imported_column(const Json& document) {
  Json imported = document;
  imported["scene"]["bodies"]["rod"] = {
      {"type", "invariants"}, {"file", "rod.json"}, {"from", {0, 0, 0}}, {"to", {1, 0, 0}}};
  if (imported["responses"].contains("buckling")) {
    imported["responses"]["buckling"]["chord"] = {"foot", "press"};
  }
  return imported;
}

class ColumnFile : public Exchange {
 protected:
  Json imported(const Json& document) const {
    write(write_invariants(exported(read("original.json", document), "rod")));
    return imported_column(document);
  }
};

class Column : public ColumnFile, public testing::WithParamInterface<std::string> {};

/// Cubic shapes of six elements overestimate the load of a pinned column by (π/6)⁴/720 = 1.0e-4, and its
/// derivatives as much. The beam's is the closed form P_E = π² E I/L².
TEST_P(Column, BucklesUnderTheLoadOfTheBeam) {
  const Json document = column(GetParam());
  const ProblemFile original = read("original.json", document);
  const ProblemFile problem = read("imported.json", imported(document));
  const Eigen::VectorXd x = start_design(original);
  const auto a = analyze(original, x), b = analyze(problem, x);
  const double euler = std::numbers::pi * std::numbers::pi * 210e9 * 0.03 * std::pow(0.02, 3) / 12;
  EXPECT_NEAR(values_of(*a)(0), 5000.0 / euler, 1e-6 * 5000.0 / euler);
  const double expected = values_of(*a)(0) / (1.0 + std::pow(std::numbers::pi / 6.0, 4) / 720.0);
  EXPECT_NEAR(values_of(*b)(0), expected, 1e-5 * expected);
  for (const GradientMethod method : {GradientMethod::direct, GradientMethod::adjoint}) {
    const Eigen::RowVectorXd of_beam = gradients(original, x, *a, method).row(0);
    const Eigen::RowVectorXd found = gradients(problem, x, *b, method).row(0);
    EXPECT_LE((found - of_beam).norm(), 3e-4 * of_beam.norm());
  }
}

/// A quarter of the column's Euler load is taken from its stiffness: frequencies about that state are
/// those of the beam, and so are their derivatives. Round-off, as imported_body_test.
TEST_P(Column, VibratesUnderLoadAsTheBeam) {
  Json document = column(GetParam());
  document["responses"].erase("buckling");
  const ProblemFile original = read("original.json", document);
  const Differences differences = compare(original, read("imported.json", imported(document)));
  EXPECT_LE(differences.values, 1e-9);
  EXPECT_LE(differences.direct, 1e-7);
  // The load counts: without it the lowest frequency is another.
  document["scene"]["loads"]["press"]["value"] = 1.0;
  const ProblemFile free = read("free.json", document);
  const double loaded = values_of(*analyze(original, start_design(original)))(0);
  EXPECT_LT(loaded, 0.9 * values_of(*analyze(free, start_design(free)))(0));
}

INSTANTIATE_TEST_SUITE_P(Frames, Column, testing::Values("tangent", "chord"));

/// The same force in the same column, whatever its effects are.
TEST_F(ColumnFile, CountsItsForceWithoutStiffening) {
  Json document = imported(column("tangent"));
  const ProblemFile with = read("with.json", document);
  document["effects"]["geometric_stiffening"] = "off";
  const ProblemFile without = read("without.json", document);
  const Eigen::VectorXd x = start_design(with);
  EXPECT_NEAR(values_of(*analyze(without, x))(0), values_of(*analyze(with, x))(0), 1e-6);
}

TEST_F(ColumnFile, SaysWhatItsBucklingNeeds) {
  const Json document = imported(column("tangent"));
  Json edited = document;
  edited["responses"]["buckling"].erase("chord");
  EXPECT_THAT(complaint(edited), HasSubstr("/responses/buckling is missing the key \"chord\""));
  edited["responses"]["buckling"]["chord"] = {"foot", "node 3"};
  EXPECT_THAT(complaint(edited), HasSubstr("is not that of the line from \"foot\" to \"node 3\""));
  InvariantsFile file = read_invariants(path());
  file.design.clear();
  file.constants.stretching.reset();
  file.constants.stress.reset();
  write(write_invariants(file));
  EXPECT_THAT(complaint(document),
              HasSubstr("/responses/buckling/body names a body whose file rod.json has no block "
                        "\"stiffening\""));
}

}  // namespace
}  // namespace pleuel::test::imported_buckling_test
