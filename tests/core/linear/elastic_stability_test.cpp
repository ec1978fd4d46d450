#include "core/linear/elastic_stability.hpp"

#include "core/base/eager_matrices.hpp"
#include "tests/core/start/quasi_static_beam.hpp"
#include "tests/support/test.hpp"

/// Columns on springs and below what turns.

/// At what share of their loads members buckle, as it is told.

namespace pleuel::test::elastic_stability_test {
namespace {

using namespace quasi_static_beam;

/// A spring that presses a stiff column towards a point d beyond its tip pushes the tip aside, with
/// P w/d: a soft spring k at the foot holds it up to P L (1 + L/d) = k.
TEST(ElasticStability, OfAColumnThatASpringPressesAsideEndsEarlier) {
  const double k = 0.01 * stiffness, d = 0.5, K = 100.0;
  const double critical = k / (1.0 + 1.0 / d);
  for (const double share : {0.95, 1.05, 2.0, 4.0}) {
    std::string text = beam(joint("foot", "revolute", 0.0), 0.0, 0.0);
    const std::string loads = R"("loads": {)";
    text.replace(text.find(loads), loads.size(),
                 loads + fmt::format(
                             R"("k": {{"type": "joint", "joint": "foot", "stiffness": {}}},
                                "s": {{"type": "spring", "bodies": ["ground", "b"],
                                      "at": [[{}, 0, 0], [1, 0, 0]], "stiffness": {}, "free_length": {}}}, )",
                             k, 1.0 + d, K, d + share * critical / K));
    EXPECT_EQ(error_of(text).find("is unstable") != std::string::npos, share > 1.0) << share;
  }
}

/// A column that a spring of stiffness k holds at its foot buckles at P = u² EI/L² with u tan u = k L/EI
/// (Timoshenko & Gere, Theory of Elastic Stability, §2.3), between that of a rigid bar, P L = k, and
/// that of a clamped column.
TEST(ElasticStability, OfAColumnOnASpringEndsAtTheLoadOfBothTogether) {
  const std::string in_a_plane = "{}", in_space = R"({"spatial_motion": "on"})";
  for (const auto& spring :
       {std::pair(0.1, in_a_plane), std::pair(1.0, in_a_plane), std::pair(10.0, in_a_plane),
        std::pair(1000.0, in_a_plane), std::pair(1.0, in_space), std::pair(1000.0, in_space)}) {
    const double ratio = spring.first;
    const std::string& effects = spring.second;
    double low = 0.0, high = std::numbers::pi / 2;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (middle * std::tan(middle) < ratio ? low : high) = middle;
    }
    const double critical = low * low * stiffness;
    const auto on_spring = [&](double share) {
      std::string text = beam(joint("foot", "revolute", 0.0), -share * critical, 0.0, 8, effects);
      const std::string loads = R"("loads": {)";
      return text.replace(
          text.find(loads), loads.size(),
          loads + fmt::format(R"("k": {{"type": "joint", "joint": "foot", "stiffness": {}}}, )",
                              ratio * stiffness));
    };
    EXPECT_EQ(error_of(on_spring(0.98)), "") << ratio;
    EXPECT_THAT(error_of(on_spring(1.02)), HasSubstr("is unstable")) << ratio;
    // Beyond the load that the spring bears alone, too.
    EXPECT_THAT(error_of(on_spring(3.0)), HasSubstr("is unstable")) << ratio;
  }
}

/// A balanced wheel on the tip of that column, which a motor turns at any speed, neither holds it
/// nor sets it on its way.
TEST(ElasticStability, OfAColumnOnASpringIsThatOfTheColumnBelowAWheel) {
  // Of k L = EI: u tan u = 1.
  const double critical = 0.8603335890193798 * 0.8603335890193798 * stiffness;
  const auto below_a_wheel = [&](double share, double speed) {
    std::string text = beam(joint("foot", "revolute", 0.0), -share * critical, 0.0, 8);
    const auto add = [&](const std::string& before, const std::string& more) {
      text.replace(text.find(before), before.size(), before + more);
    };
    add(R"("loads": {)",
        fmt::format(R"("k": {{"type": "joint", "joint": "foot", "stiffness": {}}}, )", stiffness));
    add(R"("bodies": {)", fmt::format(R"("wheel": {{"type": "rigid", "at": [1, 0, 0], "mass": 0.2,
                                "inertia": [1e-4, 1e-4, 1e-4, 0, 0, 0], "angular_velocity": [0, 0, {}]}}, )",
                                      speed));
    add(R"("joints": {)", fmt::format(R"("motor": {{"type": "revolute", "bodies": ["b", "wheel"],
                                "at": [1, 0, 0], "drive": {{"type": "constant-speed", "speed": {}}}}}, )",
                                      speed));
    return text;
  };
  for (const double speed : {0.0, 1.0, 50.0, 300.0}) {
    EXPECT_EQ(error_of(below_a_wheel(0.98, speed)), "") << speed;
    EXPECT_THAT(error_of(below_a_wheel(1.02, speed)), HasSubstr("is unstable")) << speed;
    EXPECT_THAT(error_of(below_a_wheel(1.3, speed)), HasSubstr("is unstable")) << speed;
  }
}

/// A mast of 1 m with a fan of four blades, which turns about its axis or across it and is pressed
/// by a share of the Euler load π² EI/4L² of the mast. Its first vibration has some 30 rad/s.
std::string fan_on_a_mast(const std::string& axis, double speed, double share) {
  const double press = share * std::pow(std::numbers::pi, 2) * 2.1e11 * 0.03 * 1e-6 / 12 / 4;
  const bool is_about_mast = axis == "[1, 0, 0]";
  const std::string turn = fmt::format(R"("angular_velocity": [{}, 0, {}])",
                                       is_about_mast ? speed : 0.0, is_about_mast ? 0.0 : speed);
  std::string blades, welds;
  for (int i = 0; i < 4; ++i) {
    const double way = i % 2 == 0 ? 0.3 : -0.3;
    const Eigen::Vector3d end =
        is_about_mast ? Eigen::Vector3d(1.0, i < 2 ? way : 0.0, i < 2 ? 0.0 : way)
                      : Eigen::Vector3d(1.0 + (i < 2 ? way : 0.0), i < 2 ? 0.0 : way, 0.0);
    blades += fmt::format(R"(, "blade{}": {{"type": "beam", "from": [1, 0, 0], "to": [{}, {}, {}],
                              "material": "m", "elements": 2, {},
                              "section": {{"type": "rectangle", "width": 0.01, "height": 0.01}}}})",
                          i, end(0), end(1), end(2), turn);
    welds += fmt::format(
        R"(, "weld{0}": {{"type": "fixed", "bodies": ["hub", "blade{0}"], "at": [1, 0, 0]}})", i);
  }
  return fmt::format(R"({{"scene": {{
      "materials": {{"m": {{"young": 2.1e11, "poisson": 0.3, "density": 7850}}}},
      "bodies": {{"mast": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "m",
                          "section": {{"type": "rectangle", "width": 0.03, "height": 0.01}}, "elements": 4}},
                 "hub": {{"type": "rigid", "at": [1, 0, 0], "mass": 0.2,
                         "inertia": [1e-4, 1e-4, 1e-4, 0, 0, 0], {}}}{}}},
      "joints": {{"root": {{"type": "fixed", "bodies": ["ground", "mast"], "at": [0, 0, 0]}},
                 "motor": {{"type": "revolute", "bodies": ["mast", "hub"], "at": [1, 0, 0], "axis": {},
                           "drive": {{"type": "constant-speed", "speed": {}}}}}{}}},
      "loads": {{"across": {{"type": "force", "body": "mast", "at": [1, 0, 0],
                           "direction": [0, 0, 1], "value": 1e-3}},
                "press": {{"type": "force", "body": "mast", "at": [1, 0, 0],
                          "direction": [-1, 0, 0], "value": {}}}}}}},
      "simulation": {{"end_time": 1e-4, "step": 1e-4, "initial_state": "quasi-static"}},
      "responses": {{"y": {{"type": "position", "body": "mast", "at": 1, "direction": "y", "over_time": "final"}},
                    "z": {{"type": "position", "body": "mast", "at": 1, "direction": "z",
                          "over_time": "final"}}}}}})",
                     turn, blades, axis, speed, welds, press);
}

/// What turns and what it turns on both deform: the fan is no reason to refuse the mast above its
/// resonance, nor to bear more than it does alone.
TEST(ElasticStability, OfAnElasticRotorOnAnElasticStandIsThatOfEach) {
  for (const std::string axis : {"[1, 0, 0]", "[0, 0, 1]"}) {
    for (const double speed : {0.0, 5.0, 60.0, 200.0}) {
      EXPECT_EQ(error_of(fan_on_a_mast(axis, speed, 0.9)), "") << axis << speed;
      if (speed <= 60.0) {
        EXPECT_THAT(error_of(fan_on_a_mast(axis, speed, 1.05)),
                    HasSubstr("\"mast\" buckles, at some 0.95"))
            << axis << speed;
      }
    }
  }
}

/// The load that it buckles at is that of linear buckling, whatever rides on it without being
/// pressed.
TEST(ElasticStability, TheLoadOfBucklingIsThatOfTheMastBelowItsArms) {
  EXPECT_THAT(error_of(fan_on_a_mast("[0, 0, 1]", 0.0, 2.0)),
              HasSubstr("at some 0.5 of these loads"));
}

/// Euler's load of two pins, π² EI/L², and of a cantilever, a quarter of it, whatever the frame of
/// the body is that the load turns with, and however many there are.
TEST(ElasticStability, TheLoadOfBucklingIsThatOfEveryFrame) {
  const std::string pins =
      joint("a", "revolute", 0.0) + ", " + joint("b", "point-on-line", 1.0, "[1, 0, 0]");
  for (const std::string frame : {"tangent", "chord", "tangent-end", "mean-axis"}) {
    for (const double share : {1.1, 1.5, 3.0}) {
      const double euler = std::numbers::pi * std::numbers::pi * stiffness;
      const std::string at = fmt::format("buckles, at some {:.3g} of", 1.0 / share);
      EXPECT_THAT(error_of(beam(pins, -share * euler, 0.0, 8, "{}", frame)), HasSubstr(at))
          << frame << share;
      EXPECT_THAT(error_of(beam(clamp, -0.25 * share * euler, 0.0, 8, "{}", frame)), HasSubstr(at))
          << frame << share;
    }
  }
}

/// The factor that a refusal tells; 0 if there is none.
double told_factor(const std::string& error) {
  const std::string before = "buckles, at some ";
  const std::size_t at = error.find(before);
  return at == std::string::npos ? 0.0 : std::stod(error.substr(at + before.size()));
}

std::string with(std::string text, const std::string& place, const std::string& more) {
  return text.replace(text.find(place), place.size(), more + place);
}

/// In frames it is that of the whole.
TEST(ElasticStability, TheLoadOfBucklingIsThatOfDividedBeams) {
  const double euler = 0.25 * std::numbers::pi * std::numbers::pi * stiffness;
  EXPECT_THAT(error_of(with(beam(clamp, -1.5 * euler, 0.0), R"("elements":)", R"("frames": 4, )")),
              HasSubstr("buckles, at some 0.667 of"));
}

std::string text_of(const Eigen::Vector3d& vector) {
  return fmt::format("[{}, {}, {}]", vector(0), vector(1), vector(2));
}

/// A clamped column that stands along one axis, thin along another one, under so many times the weight
/// that buckles it, q L³/EI = 7.837 (Timoshenko & Gere, Theory of Elastic Stability, art. 2.12). A
/// force across says which plane it moves in. Its frame turns with it, and so with its weight.
std::string heavy_column(const Eigen::Vector3d& up, const Eigen::Vector3d& across, double share) {
  const double weight = share * 7.837 * stiffness / (7850 * width * height);
  return fmt::format(R"({{"scene": {{
      "materials": {{"m": {{"young": 2.1e11, "poisson": 0.3, "density": 7850}}}},
      "bodies": {{"b": {{"type": "beam", "from": [0, 0, 0], "to": {0}, "reference": {1},
                       "section": {{"type": "rectangle", "width": 0.02, "height": 0.002}},
                       "material": "m", "elements": 8, "frame": "chord"}}}},
      "joints": {{"c": {{"type": "fixed", "bodies": ["ground", "b"], "at": [0, 0, 0]}}}},
      "loads": {{"w": {{"type": "force", "body": "b", "at": {0}, "direction": {1}, "value": 1e-6}}}},
      "gravity": {2}}},
      "effects": {{"spatial_motion": "off"}},
      "simulation": {{"end_time": 0.001, "step": 0.001, "initial_state": "quasi-static"}},
      "responses": {{
        "x": {{"type": "position", "body": "b", "at": 1, "direction": "x", "over_time": "final"}},
        "y": {{"type": "position", "body": "b", "at": 1, "direction": "y", "over_time": "final"}}}}}})",
                     text_of(up), text_of(across), text_of(-weight * up));
}

/// In every plane of motion.
TEST(ElasticStability, TheLoadOfBucklingUnderWeightIsThatOfEveryPlane) {
  const Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  for (const int up : {0, 1, 2}) {
    for (const int across : {(up + 1) % 3, (up + 2) % 3}) {
      const auto error = [&](double share) {
        return error_of(heavy_column(axes.col(up), axes.col(across), share));
      };
      EXPECT_EQ(error(0.98), "") << up << across;
      EXPECT_NEAR(told_factor(error(2.0)), 0.5, 0.005) << up << across;
    }
  }
}

}  // namespace
}  // namespace pleuel::test::elastic_stability_test
