#include "picture/companions.hpp"

#include <algorithm>

#include <gmock/gmock.h>

#include "tests/picture/picture_problems.hpp"

namespace pleuel::test::companions_test {
namespace {

const Companion& find(const Companions& companions, const std::string& name) {
  const auto found = std::find_if(companions.all.begin(), companions.all.end(),
                                  [&](const Companion& one) { return one.settings.name == name; });
  if (found == companions.all.end()) throw std::runtime_error("no companion " + name);
  return *found;
}

/// A ball on a circle needs m ω² r; the arm at constant speed has ½ (m_arm (L²/3 + h²/12) + m r²)
/// ω². The scheme is of second order: of relative size (ωh)² = 1e-6 here, times ten.
TEST(Companions, AreForcesAndEnergiesOfTheMechanism) {
  const ProblemFile problem = turning_arm(R"("rigid": true)", {"/simulation/step=5e-5"});
  const auto analysis = analyze(problem, start_design(problem));
  const Companions companions = find_companions(problem, *analysis);
  const double mass = 7850.0 * 0.4 * 0.01 * 0.02, speed = 20.0, tolerance = 1e-5;
  const double force = 0.3 * speed * speed * 0.4;
  const double energy =
      0.5 * (mass * (0.16 / 3.0 + 0.02 * 0.02 / 12.0) + 0.3 * 0.16) * speed * speed;
  EXPECT_NEAR(find(companions, "force in the joint end").value, force, tolerance * force);
  EXPECT_NEAR(find(companions, "kinetic energy").value, energy, tolerance * energy);
  EXPECT_NEAR(find(companions, "torque of the drive hub").value, 0.0, tolerance * energy);
}

TEST(Companions, DoNotRepeatWhatTheFileAsksFor) {
  const ProblemFile problem = turning_arm(
      R"("frame": "tangent")",
      {R"(/responses/hub_force={"type": "reaction-force", "joint": "hub", "direction": "magnitude", "over_time": "max"})"});
  const auto analysis = analyze(problem, start_design(problem));
  for (const Companion& one : find_companions(problem, *analysis).all) {
    EXPECT_NE(one.settings.name, "force in the joint hub");
    EXPECT_EQ(one.value, std::abs(one.history(one.peak)));
  }
}

}  // namespace
}  // namespace pleuel::test::companions_test
