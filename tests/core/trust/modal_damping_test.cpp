#include <numbers>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "core/trust/neglected_effects.hpp"
#include "tests/core/trust/findings_of.hpp"

namespace pleuel::test::modal_damping_test {
namespace {

using testing::Contains;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// The first angular frequency of a steel cantilever of 400 × 20 × 8 mm, which a force at its tip
/// has.
constexpr double frequency = 262.48526926, ratio = 0.02;

ProblemFile shaken(double force, const std::string& damping) {
  return read_scene(fmt::format(
      R"({{"scene": {{"gravity": [0, 0, 0], "bodies": {{
            "beam": {{"type": "beam", "from": [0, 0, 0], "to": [0.4, 0, 0], "material": "steel",
              "elements": 8, "section": {{"type": "rectangle", "width": 0.02, "height": 0.008}},
              "reduction": {{"modes": 4}}, "damping": {}}}}},
          "joints": {{"wall": {{"type": "fixed", "bodies": ["ground", "beam"], "at": [0, 0, 0]}}}},
          "loads": {{"push": {{"type": "force", "body": "beam", "at": [0.4, 0, 0],
            "direction": [0, 1, 0],
            "value": {{"type": "harmonic", "amplitude": {}, "frequency": {}}}}}}}}},
          "simulation": {{"end_time": {}, "step": {}, "initial_state": "periodic"}},
          "responses": {{"tip": {{"type": "deflection", "body": "beam", "at": 1,
                                  "over_time": "max-abs"}}}}}})",
      damping, force, frequency, 2.0 * std::numbers::pi / frequency,
      2.0 * std::numbers::pi / frequency / 400.0));
}

double tip(const ProblemFile& problem) {
  return analyze(problem, start_design(problem))->reductions.front().value;
}

const std::string by_modes = fmt::format(R"({{"modal": {}}})", ratio);
/// The same ratio of the first mode: ζ = ω β/2.
const std::string by_stiffness = fmt::format(R"({{"stiffness": {}}})", 2.0 * ratio / frequency);

/// At its resonance the tip goes as far as damping lets it: by what the two differ, damping by
/// modes is too much. With a force of a tenth both are the same, and nothing is said.
TEST(ModalDamping, OfABeamThatBendsFarIsTold) {
  const std::vector<Finding> found = findings_of(shaken(8.0, by_modes), check_modal_damping);
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_THAT(found[0].text, HasSubstr("some 8 % too much"));
  EXPECT_THAT(findings_of(shaken(8.0, by_modes)),
              Contains(Field(&Finding::text, HasSubstr("some 8 % too much"))));
  EXPECT_NEAR(tip(shaken(8.0, by_stiffness)) / tip(shaken(8.0, by_modes)), 1.08, 0.01);
  EXPECT_THAT(findings_of(shaken(8.0, by_stiffness), check_modal_damping), IsEmpty());
  EXPECT_THAT(findings_of(shaken(0.8, by_modes), check_modal_damping), IsEmpty());
  EXPECT_NEAR(tip(shaken(0.8, by_stiffness)) / tip(shaken(0.8, by_modes)), 1.0, 2e-3);
}

}  // namespace
}  // namespace pleuel::test::modal_damping_test
