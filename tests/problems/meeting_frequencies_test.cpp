#include <numbers>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/scene/problem_reader.hpp"
#include "optimization/backends.hpp"
#include "optimization/design/design_solve.hpp"

/// The lightest cantilever with a limit on its lowest frequency is square: both planes tie.
namespace pleuel::test::meeting_frequencies_test {
namespace {

constexpr double length = 0.5, limit = 2.0 * std::numbers::pi * 60.0;

ProblemFile mast(const std::string& responses_and_limits) {
  return read_problem_text(R"j({"scene": {"bodies": {"mast": {"type": "beam", "from": [0, 0, 0],
    "to": [0.5, 0, 0], "elements": 6, "section": {"type": "rectangle", "width": "= w", "height": "= h"},
    "material": "plain"}}, "materials": {"plain": {"young": "210 GPa", "poisson": 0.3, "density": 7850}},
    "joints": {"root": {"type": "fixed", "bodies": ["ground", "mast"], "at": [0, 0, 0]}}},
  "simulation": {"end_time": "2 ms", "step": "1 ms", "resolution_check": false},
  "variables": {"w": {"start": "12 mm", "lower": "5 mm", "upper": "60 mm"},
                "h": {"start": "20 mm", "lower": "5 mm", "upper": "60 mm"}},
  "objective": {"minimize": "m"},
  "responses": {"m": {"type": "mass"}, )j" +
                               responses_and_limits + "}",
                           "mast.json")
      .complete();
}

Result optimized(const ProblemFile& file, const std::string& backend = "nlopt-slsqp") {
  DesignProblem design(file);
  SolveOptions options;
  options.backend = backend;
  return solve_design(design, options);
}

/// ω = 3.516/L² √(E s²/12ρ) of a square of side s, but for rotary inertia (3e-4).
const double side = limit * length * length / 3.516015268500151 * std::sqrt(12.0 * 7850.0 / 2.1e11);

/// @param owner  a key of the response: the body, or none for the whole mechanism
std::string limited_along_both_axes(const std::string& owner) {
  return fmt::format(R"j("y": {{"type": "frequency", "direction": "y"{0}}},
                         "z": {{"type": "frequency", "direction": "z"{0}}}}},
  "constraints": {{"stiff": {{"response": "= min(y, z)", "lower": "60 Hz"}}}})j",
                     owner);
}

TEST(MeetingFrequencies, AreVerifiedByTheirDirections) {
  for (const char* owner : {R"(, "body": "mast")", ""}) {
    for (const std::string& backend : optimizer_names()) {
      const Result result = optimized(mast(limited_along_both_axes(owner)), backend);
      EXPECT_EQ(result.status, Status::verified) << backend << ": " << result.message;
      EXPECT_NEAR(result.x(0), side, 1e-3 * side) << backend;
      EXPECT_NEAR(result.x(1), side, 1e-3 * side) << backend;
    }
  }
}

TEST(MeetingFrequencies, WithoutADirectionAreAdvisedToTakeOne) {
  const Result result = optimized(mast(R"("f": {"type": "frequency"}},
  "constraints": {"stiff": {"response": "f", "lower": "60 Hz"}})"));
  EXPECT_EQ(result.status, Status::stalled);
  EXPECT_NEAR(result.x(0), side, 2e-3 * side);
  EXPECT_THAT(result.message, testing::HasSubstr("f coincides with the frequency of another mode"));
  EXPECT_THAT(result.message, testing::Not(testing::HasSubstr("windows")));
}

}  // namespace
}  // namespace pleuel::test::meeting_frequencies_test
