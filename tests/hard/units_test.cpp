#include <cmath>

#include "core/base/eager_matrices.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/hard/hard_problems.hpp"

/// The same mechanism in other numbers: whoever writes millimetres, tonnes and newtons gets the
/// digits of SI. Plain numbers are taken as they stand, so the file may be in any consistent units.
namespace pleuel::test::units_test {
namespace {

/// Powers of ten of a unit system: its unit of length and mass in SI; the unit of time is the
/// second.
struct Units {
  double metre;     ///< how many units of length a metre is
  double kilogram;  ///< how many units of mass a kilogram is
  double newton() const { return kilogram * metre; }
  double pascal() const { return newton() / (metre * metre); }
};

std::string problem_text(const Units& u, const std::string& formulation) {
  const auto scaled = [](double value, double unit) {
    return fmt::format("{:.17g}", value * unit);
  };
  const double m = u.metre, density = u.kilogram / (m * m * m);
  const std::string r = scaled(0.1, m), end = scaled(0.35, m);
  return R"({"scene": {"materials": {"steel": {"young": )" + scaled(2.1e11, u.pascal()) +
         R"(, "poisson": 0.3, "density": )" + scaled(7850, density) + R"(}},
  "bodies": {
    "crank": {"type": "beam", "from": [0, 0, 0], "to": [)" +
         r + R"(, 0, 0], "material": "steel",
      "elements": 2, "section": {"type": "rectangle", "width": )" +
         scaled(0.01, m) + R"(, "height": )" + scaled(0.02, m) + R"(}},
    "rod": {"type": "beam", "from": [)" +
         r + R"(, 0, 0], "to": [)" + end +
         R"(, 0, 0], "material": "steel", "elements": 3, "frame": "chord",
      "damping": {"stiffness": 1e-5},
      "section": {"type": "circle", "diameter": {"variable": "diameter"}}},
    "slider": {"type": "point-mass", "at": [)" +
         end + R"(, 0, 0], "mass": )" + scaled(0.5, u.kilogram) + R"(}},
  "joints": {
    "bearing": {"type": "revolute", "bodies": ["ground", "crank"], "at": [0, 0, 0],
      "drive": {"type": "ramp-to-speed", "speed": 100, "ramp": 0.02}},
    "crank_pin": {"type": "revolute", "bodies": ["crank", "rod"], "at": [)" +
         r + R"(, 0, 0]},
    "slider_pin": {"type": "revolute", "bodies": ["rod", "slider"], "at": [)" +
         end + R"(, 0, 0]},
    "guide": {"type": "point-on-line", "bodies": ["ground", "slider"], "at": [)" +
         end +
         R"(, 0, 0], "axis": [1, 0, 0]}}},
  "simulation": {"end_time": 0.05, "step": 1e-4, "formulation": ")" +
         formulation + R"("},
  "variables": {"diameter": {"start": )" +
         scaled(0.012, m) + R"(, "lower": )" + scaled(0.001, m) + R"(, "upper": )" +
         scaled(0.1, m) + R"(}},
  "responses": {
    "end": {"type": "position", "body": "slider", "direction": "x", "over_time": "final"},
    "bow": {"type": "deflection", "body": "rod", "at": 0.5, "over_time": "max-abs"},
    "stress": {"type": "stress", "body": "rod", "over_time": "max"},
    "torque": {"type": "drive-torque", "joint": "bearing", "over_time": "rms"},
    "acceleration": {"type": "acceleration", "body": "slider", "direction": "x", "over_time": "rms"},
    "force": {"type": "reaction-force", "joint": "guide", "direction": "y", "over_time": "rms"}}})";
}

/// Values of all responses, and their derivatives with respect to the logarithm of the diameter, in
/// SI.
Eigen::MatrixXd digits_in(const Units& u, const std::string& formulation) {
  const ProblemFile problem =
      read_problem_text(problem_text(u, formulation), "units.json").complete();
  const auto analysis = analyze(problem, start_design(problem));
  Eigen::VectorXd unit(6);
  unit << u.metre, u.metre, u.pascal(), u.newton() * u.metre, u.metre, u.newton();
  Eigen::MatrixXd digits(6, 2);
  digits.col(0) = values_of(*analysis).cwiseQuotient(unit);
  digits.col(1) = (direct_gradients(*analysis) * start_design(problem)).cwiseQuotient(unit);
  return digits;
}

class UnitsHardCase : public HardCase {};
PLEUEL_WITH_EACH_FORMULATION(UnitsHardCase);

/// Derivatives with respect to a logarithm have the unit of the value; where they nearly vanish,
/// the round-off of the value is what can be asked of them.
void expect_same_digits(const Eigen::MatrixXd& scaled, const Eigen::MatrixXd& si) {
  for (Eigen::Index i = 0; i < si.rows(); ++i) {
    const double size = si.row(i).cwiseAbs().maxCoeff();
    EXPECT_NEAR(scaled(i, 0), si(i, 0), 1e-9 * std::abs(si(i, 0))) << "value " << i;
    EXPECT_NEAR(scaled(i, 1), si(i, 1), 1e-9 * size) << "derivative " << i;
  }
}

TEST_P(UnitsHardCase, GivesTheSameDigitsInMillimetresTonnesAndNewtons) {
  expect_same_digits(digits_in({1e3, 1e-3}, GetParam()), digits_in({1.0, 1.0}, GetParam()));
}

TEST_P(UnitsHardCase, GivesTheSameDigitsInMicrometresAndGrams) {
  expect_same_digits(digits_in({1e6, 1e3}, GetParam()), digits_in({1.0, 1.0}, GetParam()));
}

}  // namespace
}  // namespace pleuel::test::units_test
