#include <string>

#include "core/trust/check_list.hpp"
#include "tests/core/trust/trust_scenes.hpp"
#include "tests/support/test.hpp"

/// What springs hold is a member of the mechanism: rigid links that buckle or flutter along a motion which
/// itself shows nothing.

namespace pleuel::test::spring_stability_test {
namespace {

/// Two rigid links in a row, each of length ℓ with its mass at its end, on springs k = 10 N m/rad at foot and knee
/// (Ziegler, Die Stabilitätskriterien der Elastomechanik, 1952).
struct TwoLinks {
  std::string load;         ///< keys of a force at the end, along the links
  double damping = 0.0;     ///< of both joints [N m s/rad]
  double stiffness = 10.0;  ///< [N m/rad]
  std::string gravity = "[0, 0, 0]";
};

constexpr double length = 0.1;  // [m]

std::vector<Finding> findings_of(const TwoLinks& links) {
  const auto body = [](const std::string& name, double at, double mass) {
    return fmt::format(R"("{}": {{"type": "rigid", "at": [{}, 0, 0], "mass": {},
                                 "inertia": [1e-9, 1e-9, 1e-9, 0, 0, 0]}})",
                       name, at, mass);
  };
  const auto joint = [](const std::string& name, const std::string& bodies, double at) {
    return fmt::format(R"("{}": {{"type": "revolute", "bodies": [{}], "at": [{}, 0, 0]}})", name,
                       bodies, at);
  };
  const auto spring = [&](const std::string& name) {
    return fmt::format(
        R"("{0} spring": {{"type": "joint", "joint": "{0}", "stiffness": {1}, "damping": {2}}})",
        name, links.stiffness, links.damping);
  };
  return test::findings_of(
      read_scene(fmt::format(
          R"({{"scene": {{"gravity": {}, "bodies": {{{}, {}}}, "joints": {{{}, {}}},
                          "loads": {{{}, {}{}}}}},
               "simulation": {{"end_time": 1.5, "step": 1e-3}},
               "responses": {{"mass": {{"type": "mass"}}}}}})",
          links.gravity, body("lower", length, 0.2), body("upper", 2.0 * length, 0.1),
          joint("foot", R"("ground", "lower")", 0.0), joint("knee", R"("lower", "upper")", length),
          spring("foot"), spring("knee"), links.load)),
      check_stability);
}

/// At the end of the upper link, as it lies at the start.
std::string force(const std::string& value, const std::string& more = "") {
  return fmt::format(R"(, "press": {{"type": "force", "body": "upper", "at": [0.2, 0, 0],
                          "direction": [-1, 0, 0], "value": {}{}}})",
                     value, more);
}

/// After 0.3 s such a multiple of k/ℓ.
std::string late(double share) {
  const double load = share * 10.0 / length;
  return fmt::format(R"({{"type": "table", "interpolation": "monotone", "times": [0, 0.2, 0.3, 9],
                          "values": [0, 0, {0}, {0}]}})",
                     load);
}

constexpr const char* follows = R"(, "follows": true)";

TEST(SpringStability, OfLinksUnderADeadLoadThatComesLate) {
  const double critical = (3.0 - std::sqrt(5.0)) / 2.0;  // of (Pℓ/k)² − 3 Pℓ/k + 1 = 0
  EXPECT_THAT(findings_of({force(late(0.97 * critical))}), IsEmpty());
  const Finding beyond = only(findings_of({force(late(1.03 * critical))}));
  EXPECT_TRUE(beyond.is_serious);
  EXPECT_THAT(beyond.text, HasSubstr("buckles"));
}

/// Without damping they flutter beyond (7/2 − √2) k/ℓ, with a little of it in both joints beyond 41/28 k/ℓ
/// already (Ziegler).
TEST(SpringStability, OfLinksUnderALoadThatFollowsAndComesLate) {
  const double critical = 3.5 - std::sqrt(2.0);
  EXPECT_THAT(findings_of({force(late(0.97 * critical), follows)}), IsEmpty());
  const Finding beyond = only(findings_of({force(late(1.03 * critical), follows)}));
  EXPECT_TRUE(beyond.is_serious);
  EXPECT_THAT(beyond.text, HasSubstr("flutter"));
  const double damped = 41.0 / 28.0, damping = 0.02;
  EXPECT_THAT(findings_of({force(late(0.95 * damped), follows), damping}), IsEmpty());
  // Roots of det(s² M + s C + K) with real parts 1.22/s and 2.81/s: by 4.3 and by 29 in 1.2 s.
  EXPECT_FALSE(only(findings_of({force(late(1.15 * damped), follows), damping})).is_serious);
  EXPECT_TRUE(only(findings_of({force(late(1.25 * damped), follows), damping})).is_serious);
}

TEST(SpringStability, OfLinksThatArePressedForAShortTimeIsMentioned) {
  const Finding finding = only(findings_of(
      {force(R"({"type": "half-sine", "amplitude": 60, "duration": 0.01, "begin": 0.2})")}));
  EXPECT_FALSE(finding.is_serious) << finding.text;
}

/// Their own motion goes where disturbances grow.
TEST(SpringStability, OfPendulumsThatSwingIsNoMatter) {
  for (const double stiffness : {0.02, 0.05, 0.3}) {
    EXPECT_THAT(findings_of({.load = "", .stiffness = stiffness, .gravity = "[0, -9.81, 0]"}),
                IsEmpty())
        << stiffness;
    EXPECT_THAT(findings_of({.load = "", .stiffness = stiffness, .gravity = "[-9.8, 0.3, 0]"}),
                IsEmpty())
        << stiffness;
  }
}

}  // namespace
}  // namespace pleuel::test::spring_stability_test
