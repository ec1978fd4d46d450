#include <numbers>

#include <Eigen/LU>

#include "core/base/eager_matrices.hpp"
#include "tests/hard/hard_problems.hpp"
#include "tests/hard/rigid_references.hpp"
#include "tests/support/convergence.hpp"
#include "tests/support/dense_algebra.hpp"

/// Newmark's scheme and implicit Euler in hard cases: what they damp, and that they are of first
/// order (Newmark's of second without damping).
namespace pleuel::test::damped_scheme_test {
namespace {

class DampedScheme : public HardCase {
 protected:
  static std::unique_ptr<Analysis> run_with(const std::string& scheme, const std::string& name,
                                            std::vector<std::string> overrides) {
    overrides.push_back("/simulation/scheme=" + scheme);
    return run(name, overrides);
  }
};
PLEUEL_WITH_EACH_FORMULATION(DampedScheme);

/// Of problems/hard/free_vibration.json.
constexpr double frequency = 2 * std::numbers::pi, damping = 1e-5, step = 0.05;

/// ln |λ| of the principal roots of one step of Newmark's scheme (1959) on
/// q̈ + 2ζω q̇ + ω² q = 0,
///     q⁺ = q + hv + h²(½−β) a + h²β a⁺,  v⁺ = v + h(1−γ) a + hγ a⁺
double newmark_decay(double radius) {
  const double alpha = (1 - radius) / (1 + radius), h = step;
  const double gamma = 0.5 + alpha, beta = 0.25 * (1 + alpha) * (1 + alpha);
  Eigen::Matrix3d implicit, explicit_;
  implicit << 1, 0, -h * h * beta,  //
      0, 1, -h * gamma,             //
      frequency * frequency, 2 * damping * frequency, 1;
  explicit_ << 1, h, h * h * (0.5 - beta),  //
      0, 1, h * (1 - gamma),                //
      0, 0, 0;
  const Eigen::VectorXcd roots = eigenvalues(implicit.inverse() * explicit_);
  Eigen::Index principal = 0;
  roots.imag().maxCoeff(&principal);
  return std::log(std::abs(roots(principal)));
}

/// The same of a history x_n = Re(c λⁿ), from D_n = x_{n+1} x_{n−1} − x_n², D_{n+1} = |λ|² D_n,
/// down to a hundred-thousandth of the amplitude.
double decay_of(const Eigen::RowVectorXd& x, double expected) {
  const auto determinant = [&](Eigen::Index n) { return x(n + 1) * x(n - 1) - x(n) * x(n); };
  const Eigen::Index first = 5;
  const Eigen::Index last =
      std::min(x.size() - 2, first + static_cast<Eigen::Index>(-std::log(1e5) / expected));
  return 0.5 * std::log(determinant(last) / determinant(first)) / static_cast<double>(last - first);
}

TEST_P(DampedScheme, OfNewmarkDampsAFreeVibrationAsItsEigenvaluesSay) {
  for (const double radius : {0.0, 0.5, 0.8, 0.99, 1.0}) {
    const auto analysis = run_with("newmark", "free_vibration",
                                   {fmt::format("/simulation/spectral_radius={:g}", radius)});
    const double expected = newmark_decay(radius);
    const double found = decay_of(history_of(*analysis, "end").array() - 1.1, expected);
    EXPECT_NEAR(found / expected, 1.0, 1e-6) << radius;
  }
}

/// q⁺ = q + h v⁺, v⁺ = v + h a⁺ has |λ|² = 1/(1 + 2ζωh + ω²h²): a tenth of the amplitude is left
/// after two and a half periods.
TEST_P(DampedScheme, OfEulerDampsAFreeVibrationAsItsEigenvaluesSay) {
  const auto analysis = run_with("implicit-euler", "free_vibration", {});
  const double square = frequency * frequency * step * step;
  const double expected = -0.5 * std::log(1 + 2 * damping * frequency * step + square);
  const double found = decay_of(history_of(*analysis, "end").array() - 1.1, expected);
  EXPECT_NEAR(found / expected, 1.0, 1e-6);
}

/// Against the energy of the one coordinate; Newmark's scheme with ρ∞ = 1 has no error of first
/// order, but index 3 is unstable with it.
TEST_P(DampedScheme, BringsTheSliderThroughItsDeadCentresInItsOrder) {
  const RigidSliderCrank reference = steel_slider_crank(1.5);
  const double end = 0.2, exact = reference.slider(reference.coasting_angle(40.0, end));
  struct Case {
    std::string scheme;
    double radius, order;
  };
  std::vector<Case> cases = {{"newmark", 0.8, 1.0}, {"implicit-euler", 0.0, 1.0}};
  if (GetParam() != "index-3") cases.push_back({"newmark", 1.0, 2.0});
  for (const Case& of : cases) {
    std::vector<double> steps, errors;
    for (const double h : {2e-4, 1e-4, 5e-5}) {
      const auto analysis = run_with(
          of.scheme, "dead_centres",
          {step_of(h), end_of(end), fmt::format("/simulation/spectral_radius={:g}", of.radius)});
      steps.push_back(h);
      errors.push_back(std::abs(value_of(*analysis, "slider_end") - exact));
    }
    EXPECT_NEAR(observed_order(steps, errors), of.order, 0.1) << of.scheme;
  }
}

/// Implicit Euler brings a cantilever under a sudden load F to rest at F L³/(3 E I): of its slowest
/// mode, ω = (1.8751/L)² √(EI/ρA), (1 + ω²h²)^(−n/2) is left after n steps.
TEST_P(DampedScheme, OfEulerEndsASuddenLoadInItsStaticDeflection) {
  const double h = 5e-3, end = 1.0, height = 0.02, width = 0.03;
  const double inertia = width * std::pow(height, 3) / 12;
  const double deflection = 20.0 / (3 * 2.1e11 * inertia);
  const double slowest =
      std::pow(1.87510407, 2) * std::sqrt(2.1e11 * inertia / (7850 * width * height));
  const double left = std::pow(1 + slowest * slowest * h * h, -0.5 * end / h);
  const auto analysis = run_with("implicit-euler", "sudden_load", {step_of(h), end_of(end)});
  EXPECT_LE(left, 1e-8);
  EXPECT_NEAR(value_of(*analysis, "tip_end") / -deflection, 1.0, 1e-6);
  // It hardly swings over: generalized-α has twice the static deflection.
  EXPECT_LE(value_of(*analysis, "tip_peak"), 1.5 * deflection);
}

}  // namespace
}  // namespace pleuel::test::damped_scheme_test
