#include <functional>

#include <fmt/ranges.h>

#include "core/base/eager_matrices.hpp"
#include "core/response/effect_measurement.hpp"
#include "core/trust/checks.hpp"
#include "optimization/design/design_problem.hpp"
#include "sensitivity/sampled_gradients.hpp"
#include "studies/derivative_check.hpp"
#include "tests/core/counted_allocations.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/test.hpp"

/// How the work of commands grows with what a file has many of: by the memory that is asked for on the
/// way, which no other work of the machine disturbs. The time loop asks for none (allocation_test.cpp).
namespace pleuel::test::growth_test {
namespace {

#ifdef PLEUEL_COUNTS_ALLOCATIONS

struct Work {
  const char* name;
  std::function<void(const ProblemFile&)> run;
};
using Family = std::function<ProblemFile(int count)>;

/// p of work ~ countᵖ, from the work with so many and with four times as many. What is done once in a
/// process (tables, the database of units) is done before.
double exponent(const Family& family, int count, const Work& work) {
  work.run(family(1));
  const auto bytes_of = [&](int size) {
    const ProblemFile problem = family(size);
    const double before = static_cast<double>(allocated_bytes());
    work.run(problem);
    return static_cast<double>(allocated_bytes()) - before;
  };
  return std::log(bytes_of(4 * count) / bytes_of(count)) / std::log(4.0);
}

ProblemFile read(const std::string& scene, const std::string& rest) {
  return problem_from(fmt::format(R"({{"scene": {{"materials": {{"steel": {{"young": "210 GPa",
                 "poisson": 0.3, "density": "7850 kg/m^3"}}}}, {}}},
                 "simulation": {{"end_time": "2 ms", "step": "0.2 ms"}}, {}}})",
                                  scene, rest));
}

std::string drive(const std::string& body, double x) {
  return fmt::format(
      R"("drive_{}": {{"type": "revolute", "bodies": ["ground", "{}"], "at": [{}, 0, 0],
          "axis": [0, 0, 1], "drive": {{"type": "ramp-to-speed", "speed": "20 rad/s", "ramp": "2 ms"}}}})",
      body, body, x);
}

std::string beam(const std::string& name, double x, const std::string& section) {
  return fmt::format(
      R"("{}": {{"type": "beam", "from": [{}, 0, 0], "to": [{}, 0.3, 0], "material": "steel", {}}})",
      name, x, x, section);
}

constexpr const char* by_diameter =
    R"("elements": 2, "section": {"type": "circle", "diameter": {"variable": "d"}})";
constexpr const char* diameter =
    R"("variables": {"d": {"start": "10 mm", "lower": "5 mm", "upper": "20 mm"}})";

/// Cranks side by side, all of one diameter.
ProblemFile many_bodies(int count) {
  std::vector<std::string> bodies, joints;
  for (int i = 0; i < count; ++i) {
    const std::string name = fmt::format("crank{}", i);
    bodies.push_back(beam(name, i, by_diameter));
    joints.push_back(drive(name, i));
  }
  return read(fmt::format(R"("bodies": {{{}}}, "joints": {{{}}})", fmt::join(bodies, ", "),
                          fmt::join(joints, ", ")),
              fmt::format(R"({}, "responses": {{"tip": {{"type": "deflection", "body": "crank0",
                  "at": 1, "over_time": "max-abs"}}}})",
                          diameter));
}

/// One crank, whose bow is asked for at many places.
ProblemFile many_responses(int count) {
  std::vector<std::string> responses;
  for (int i = 0; i < count; ++i) {
    responses.push_back(fmt::format(
        R"("bow{}": {{"type": "deflection", "body": "crank", "at": {}, "over_time": "max-abs"}})",
        i, (i + 1.0) / count));
  }
  return read(fmt::format(R"("bodies": {{{}}}, "joints": {{{}}})", beam("crank", 0.0, by_diameter),
                          drive("crank", 0.0)),
              fmt::format(R"({}, "responses": {{{}}})", diameter, fmt::join(responses, ", ")));
}

/// One crank of segments, each with a diameter and a stress of its own.
ProblemFile many_segments(int count) {
  std::vector<std::string> segments, variables, responses;
  for (int i = 0; i < count; ++i) {
    segments.push_back(fmt::format(
        R"({{"elements": 1, "section": {{"type": "circle", "diameter": {{"variable": "d{}"}}}}}})",
        i));
    variables.push_back(
        fmt::format(R"("d{}": {{"start": "10 mm", "lower": "5 mm", "upper": "20 mm"}})", i));
    responses.push_back(fmt::format(
        R"("s{0}": {{"type": "stress", "body": "crank", "segment": {0}, "over_time": "max"}})", i));
  }
  const std::string sections = fmt::format(R"("segments": [{}])", fmt::join(segments, ", "));
  return read(fmt::format(R"("bodies": {{{}}}, "joints": {{{}}})", beam("crank", 0.0, sections),
                          drive("crank", 0.0)),
              fmt::format(R"("variables": {{{}}}, "responses": {{{}}})", fmt::join(variables, ", "),
                          fmt::join(responses, ", ")));
}

ProblemFile many_cases(int count) {
  std::vector<std::string> cases;
  for (int i = 0; i < count; ++i) {
    cases.push_back(fmt::format(
        R"("c{0}": {{"/scene/joints/drive_crank/drive/speed": "{1} rad/s"}})", i, 20 + i));
  }
  return read(
      fmt::format(R"("bodies": {{{}}}, "joints": {{{}}})", beam("crank", 0.0, by_diameter),
                  drive("crank", 0.0)),
      fmt::format(R"({}, "responses": {{"mass": {{"type": "mass"}}, "tip": {{"type": "deflection",
          "body": "crank", "at": 1, "over_time": "max-abs"}}}},
          "objective": {{"minimize": "mass"}},
          "constraints": {{"stiffness": {{"response": "tip", "upper": "1 mm"}}}},
          "cases": {{{}}})",
                  diameter, fmt::join(cases, ", ")));
}

const Work simulation{"simulation",
                      [](const ProblemFile& problem) { analyze(problem, start_design(problem)); }};
const Work gradient{"gradient", [](const ProblemFile& problem) {
                      const auto analysis = analyze(problem, start_design(problem));
                      sampled_gradients(*analysis, response_values(*analysis), ExactMethod::direct);
                    }};
const Work judgement{"judgement", [](const ProblemFile& problem) {
                       const Eigen::VectorXd x = start_design(problem);
                       check_run(problem, x, *analyze(problem, x));
                     }};
const Work derivative_check{"check of derivatives", [](const ProblemFile& problem) {
                              const Eigen::VectorXd x = start_design(problem);
                              check_derivatives(problem, x, *analyze(problem, x));
                            }};
const Work effects{"effects", [](const ProblemFile& problem) {
                     effect_influences(problem, start_design(problem));
                   }};
const Work evaluation{"evaluation", [](const ProblemFile& problem) {
                        DesignProblem design(problem);
                        design.evaluate(start_design(problem), Request::values_and_gradients);
                      }};

const Work room{"room for histories", [](const ProblemFile& problem) { require_memory(problem); }};

/// What is around the time loop grows a little faster than what there is more of, at most.
constexpr double nearly_linear = 1.5;

/// With fewer bodies their stability is judged by dense matrices, up to a size of the mechanism.
TEST(Growth, OfBodiesIsNearlyLinear) {
  for (const Work& work : {simulation, gradient, judgement, derivative_check, effects}) {
    EXPECT_LT(exponent(many_bodies, 40, work), nearly_linear) << work.name;
  }
}

TEST(Growth, OfResponsesIsNearlyLinear) {
  for (const Work& work : {simulation, gradient, judgement, derivative_check}) {
    EXPECT_LT(exponent(many_responses, 16, work), nearly_linear) << work.name;
  }
}

TEST(Growth, OfCasesIsNearlyLinear) {
  EXPECT_LT(exponent(many_cases, 4, evaluation), nearly_linear);
}

/// Before the first simulation nothing is differentiated.
TEST(Growth, OfReadingIsNearlyLinear) {
  EXPECT_LT(exponent(many_segments, 16, room), nearly_linear);
}

/// Elements, variables and responses at once: each of the gradients is elements × variables.
TEST(Growth, OfSegmentsIsAtMostTheirProduct) {
  for (const Work& work : {simulation, gradient, judgement, derivative_check}) {
    EXPECT_LT(exponent(many_segments, 8, work), 2.5) << work.name;
  }
}

#endif

}  // namespace
}  // namespace pleuel::test::growth_test
