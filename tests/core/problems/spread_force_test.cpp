#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/response/analysis.hpp"
#include "sensitivity/sampled_gradients.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/test.hpp"

/// Forces that are spread along a stretch, beside closed forms of beams.
namespace pleuel::test::spread_force_test {
namespace {

constexpr double young = 210e9, length = 0.8, side = 0.02, force = 30.0;
constexpr double bending_stiffness = young * side * side * side * side / 12.0;

/// A cantilever along (3, 4, 0)/5, loaded across from x = 0.3 to the variable `end` of its length, at rest.
constexpr const char* cantilever = R"({
  "variables": {"end": {"start": "0.5 m", "lower": "0.4 m", "upper": "0.7 m"},
                       "long": {"start": "0.8 m", "lower": "0.75 m", "upper": "1 m"}},
  "scene": {
    "materials": {"m": {"young": 210e9, "poisson": 0.3, "density": 7850}},
    "bodies": {"b": {"type": "beam", "from": [0, 0, 0], "to": ["= 0.6*long", "= 0.8*long", 0],
      "material": "m", "section": {"type": "rectangle", "width": 0.02, "height": 0.02}, "elements": 3,
      "damping": {"stiffness": "= 0 s/m * end"}}},
    "joints": {"f": {"type": "fixed", "bodies": ["ground", "b"], "at": [0, 0, 0]}},
    "loads": {"wind": {"type": "force", "body": "b", "at": ["= 0.225*long", "= 0.3*long", 0],
      "to": ["= 0.6*end", "= 0.8*end", 0], "direction": [-0.8, 0.6, 0], "value": 30}}
  },
    "simulation": {"end_time": 1e-3, "step": 1e-3, "initial_state": "quasi-static"},
  "effects": {"geometric_stiffening": "off"},
  "responses": {
    "tip": {"type": "deflection", "body": "b", "at": 1, "direction": "y", "over_time": "final"},
    "reaction": {"type": "reaction-force", "joint": "f", "direction": "magnitude", "over_time": "final"}
  }
})";

ProblemFile problem_of(const std::vector<std::string>& overrides) {
  return problem_from(cantilever, overrides);
}

double value(const ProblemFile& problem, const Eigen::VectorXd& x, std::size_t response) {
  return analyze(problem, x)->reductions[response].value;
}

/// Ends of the stretch that keep their shares of the beam, as several frames need it.
const std::string shares = R"(/scene/loads/wind/to=["= 0.375*long", "= 0.5*long", 0])";

double value(const std::vector<std::string>& overrides, std::size_t response = 0) {
  const ProblemFile problem = problem_of(overrides);
  return value(problem, start_design(problem), response);
}

/// F/(b − a) ∫ x² (3 L − x)/(6 EI) dx over the stretch: the sum of the tip's deflections by point forces
/// (Euler–Bernoulli).
double tip_by_points(double a, double b) {
  const auto integral = [](double x) { return x * x * x * length - x * x * x * x / 4.0; };
  return force / (b - a) * (integral(b) - integral(a)) / (6.0 * bending_stiffness);
}

TEST(SpreadForce, BendsACantileverAsInTheTextbook) {
  EXPECT_NEAR(value({}), tip_by_points(0.3, 0.5), 1e-9 * tip_by_points(0.3, 0.5));
  const std::vector<std::string> whole = {
      "/scene/loads/wind/at=[0, 0, 0]", R"(/scene/loads/wind/to=["= 0.6*long", "= 0.8*long", 0])"};
  const double tip = force * length * length * length / (8.0 * bending_stiffness);
  EXPECT_NEAR(value(whole), tip, 1e-9 * tip);
}

TEST(SpreadForce, IsTheSameFromItsOtherEnd) {
  EXPECT_NEAR(value({"/scene/loads/wind/at=[0.3, 0.4, 0]", "/scene/loads/wind/to=[0.18, 0.24, 0]"}),
              value({}), 1e-11 * value({}));
}

TEST(SpreadForce, IsTheSameInSpaceReducedAndInSeveralFrames) {
  const double tip = value({});
  EXPECT_NEAR(value({"/effects/spatial_motion=\"on\""}), tip, 1e-8 * tip);
  EXPECT_NEAR(value({"/scene/bodies/b/reduction={\"modes\": 6}"}), tip, 1e-3 * tip);
  // Small displacements: frames turn by 1e-4 and less.
  EXPECT_NEAR(value({shares, "/scene/bodies/b/frames=3", "/scene/loads/wind/value=3e-3"}),
              1e-4 * tip, 1e-9 * tip);
}

/// Against the sum of the reactions: what acts on all frames is the whole force.
TEST(SpreadForce, HasItsWholeValueOnSeveralFrames) {
  for (const char* frames : {"1", "2", "5"}) {
    EXPECT_NEAR(value({shares, "/scene/bodies/b/frames=" + std::string(frames)}, 1), force,
                1e-6 * force);
  }
}

TEST(SpreadForce, ActsInTheMiddleOfARigidBody) {
  const std::vector<std::string> rigid = {
      R"(/scene/bodies/b={"type": "beam", "from": [0, 0, 0], "to": ["= 0.6*long", "= 0.8*long", 0],
         "material": "m", "section": {"type": "rectangle", "width": 0.02, "height": 0.02}, "rigid": true, "elements": 1})",
      R"(/responses/tip={"type": "reaction-moment", "joint": "f", "direction": "z", "over_time": "final"})"};
  EXPECT_NEAR(std::abs(value(rigid)), 0.4 * force, 1e-9 * force);
}

/// Ends of the stretch and of the beam that move with the design.
TEST(SpreadForce, HasExactGradients) {
  for (const std::vector<std::string>& overrides : {std::vector<std::string>{},
                                                    {"/scene/bodies/b/shear=true"},
                                                    {shares, "/scene/bodies/b/frames=2"}}) {
    const ProblemFile problem = problem_of(overrides);
    const Eigen::VectorXd x = start_design(problem);
    const auto analysis = analyze(problem, x);
    const auto values = response_values(*analysis);
    for (const ExactMethod method : {ExactMethod::direct, ExactMethod::adjoint}) {
      const Eigen::MatrixXd gradients = sampled_gradients(*analysis, values, method);
      for (Eigen::Index j = 0; j < x.size(); ++j) {
        Eigen::VectorXd more = x, less = x;
        more(j) += 1e-4;
        less(j) -= 1e-4;
        const double difference = (value(problem, more, 0) - value(problem, less, 0)) / 2e-4;
        EXPECT_NEAR(gradients(0, j), difference, 1e-5 * std::abs(difference)) << j;
      }
    }
  }
}

/// The recovery knows forces at nodes only: the moment at the clamp is p l²/12 too small with elements of
/// the length l.
TEST(SpreadForce, MissesItsMomentWithinElements) {
  for (const int elements : {1, 2, 4}) {
    const double moment =
        value({"/scene/loads/wind/at=[0, 0, 0]",
               R"(/scene/loads/wind/to=["= 0.6*long", "= 0.8*long", 0])",
               "/scene/bodies/b/elements=" + std::to_string(elements),
               R"(/responses/tip={"type": "section-force", "body": "b", "part": "moment-z", "at": 0,
                                                    "over_time": "max-abs"})"});
    const double l = length / elements, load = force / length;
    EXPECT_NEAR(moment, 0.5 * force * length - load * l * l / 12.0, 1e-8 * force * length);
  }
}

TEST(SpreadForce, NeedsTwoPoints) {
  EXPECT_THROW(problem_of({"/scene/loads/wind/to=[0.18, 0.24, 0]"}), InputError);
  EXPECT_THROW(problem_of({"/scene/loads/wind/to=[0.18, 0.25, 0]"}), InputError);
}

}  // namespace
}  // namespace pleuel::test::spread_force_test
