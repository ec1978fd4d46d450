#pragma once

#include <cctype>
#include <cmath>
#include <functional>
#include <memory>

#include <Eigen/Core>

#include "core/response/analysis.hpp"
#include "core/response/monitors.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/test.hpp"

/// What the tests of hard cases share: the formulations that all of them run with, and short ways
/// to a history.

namespace pleuel::test {

/// The formulations of the constrained equations of motion that have to get everything right. Index
/// 1 drifts: see Index1 in scheme_test.cpp.
inline std::vector<std::string> formulations() {
  return {"index-3", "stabilized-index-2"};
}

/// A test that runs with each formulation.
class HardCase : public testing::TestWithParam<std::string> {
 protected:
  /// @param overrides  what differs from problems/hard/NAME.json
  static ProblemFile problem(const std::string& name, std::vector<std::string> overrides = {}) {
    overrides.push_back("/simulation/formulation=" + GetParam());
    return sample_problem("hard/" + name, overrides);
  }
  static std::unique_ptr<Analysis> run(const std::string& name,
                                       const std::vector<std::string>& overrides = {}) {
    return run(problem(name, overrides));
  }
  static std::unique_ptr<Analysis> run(const ProblemFile& problem) {
    return analyze(problem, start_design(problem));
  }
};

/// Of the one-channel history of a response, one number a step.
inline Eigen::RowVectorXd history_of(const Analysis& analysis, const std::string& response) {
  for (std::size_t i = 0; i < analysis.responses.size(); ++i) {
    if (analysis.responses[i].name == response) return analysis.histories[i].row(0);
  }
  throw std::runtime_error("no response " + response);
}

inline double value_of(const Analysis& analysis, const std::string& response) {
  for (std::size_t i = 0; i < analysis.responses.size(); ++i) {
    if (analysis.responses[i].name == response) return analysis.reductions[i].value;
  }
  throw std::runtime_error("no response " + response);
}

/// Largest violation of any constraint at any step [m] or [rad], of redundant ones that are left
/// out of the system, too.
inline double largest_violation(const Analysis& analysis) {
  return monitor(analysis.model, analysis.trajectory).position_drift;
}

inline std::string step_of(double seconds) {
  return fmt::format("/simulation/step={:.17g}", seconds);
}
inline std::string end_of(double seconds) {
  return fmt::format("/simulation/end_time={:.17g}", seconds);
}

inline std::string formulation_name(const testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;  // letters and digits only
  std::erase_if(name, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; });
  return name;
}

}  // namespace pleuel::test

/// Runs the tests of a fixture with each formulation.
#define PLEUEL_WITH_EACH_FORMULATION(fixture)                                 \
  INSTANTIATE_TEST_SUITE_P(Formulations, fixture,                             \
                           testing::ValuesIn(::pleuel::test::formulations()), \
                           ::pleuel::test::formulation_name)

/// Mechanisms of rigid bodies with one coordinate, computed without any constraint: what the
/// constrained equations must reproduce.

namespace pleuel::test {

/// y' = f(t, y) by the classical Runge–Kutta method, error O(h⁴).
template <class Vector>
Vector runge_kutta(const std::function<Vector(double, const Vector&)>& f, Vector y, double end,
                   int steps) {
  const double h = end / steps;
  for (int i = 0; i < steps; ++i) {
    const double t = i * h;
    const Vector k1 = f(t, y), k2 = f(t + h / 2, y + h / 2 * k1);
    const Vector k3 = f(t + h / 2, y + h / 2 * k2), k4 = f(t + h, y + h * k3);
    y += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  return y;
}

/// A slider-crank of rigid bodies, crank bearing in the origin, slider on the x axis:
///     T = ½ J(φ) φ̇²,   sin ψ = r/l sin φ (the rod turns by −ψ)
struct RigidSliderCrank {
  double crank = 0.1, rod = 0.25;  ///< lengths r, l [m]
  double crank_inertia = 0.0;      ///< about its bearing [kg m²]
  double rod_mass = 0.0;           ///< centre in the middle [kg]
  double rod_inertia = 0.0;        ///< about its centre [kg m²]
  double slider_mass = 0.0;        ///< [kg]

  double rod_angle(double phi) const { return std::asin(crank / rod * std::sin(phi)); }
  double slider(double phi) const { return crank * std::cos(phi) + rod * std::cos(rod_angle(phi)); }
  double rod_rate(double phi) const {  // dψ/dφ
    return crank * std::cos(phi) / (rod * std::cos(rod_angle(phi)));
  }
  double slider_rate(double phi) const {  // dx/dφ
    return -crank * std::sin(phi) - rod * std::sin(rod_angle(phi)) * rod_rate(phi);
  }
  /// J(φ)
  double inertia(double phi) const {
    const double psi = rod_angle(phi), psi_rate = rod_rate(phi);
    const double x = -crank * std::sin(phi) - 0.5 * rod * std::sin(psi) * psi_rate;
    const double y = 0.5 * crank * std::cos(phi);
    const double slide = slider_rate(phi);
    return crank_inertia + rod_inertia * psi_rate * psi_rate + rod_mass * (x * x + y * y) +
           slider_mass * slide * slide;
  }
  /// dJ/dφ by a difference of fourth order: error 1e-12 of J.
  double inertia_rate(double phi) const {
    const double d = 1e-3;
    return (8 * (inertia(phi + d) - inertia(phi - d)) -
            (inertia(phi + 2 * d) - inertia(phi - 2 * d))) /
           (12 * d);
  }
  /// What a drive exerts: J φ̈ + ½ J' φ̇².
  double torque(double phi, double rate, double acceleration) const {
    return inertia(phi) * acceleration + 0.5 * inertia_rate(phi) * rate * rate;
  }
  /// φ at the end of a motion without drive: the energy ½ J φ̇² stays.
  double coasting_angle(double start_rate, double end) const {
    using Vector = Eigen::Matrix<double, 1, 1>;
    const double energy = inertia(0.0) * start_rate * start_rate;
    const auto rate = [&](double, const Vector& phi) {
      return Vector(std::sqrt(energy / inertia(phi(0))));
    };
    return runge_kutta<Vector>(rate, Vector::Zero(), end, static_cast<int>(end * 2e4))(0);
  }
};

/// A rigid beam of steel with a rectangular section of height h in the plane, as beams have it:
/// rotary inertia of the sections included.
struct SteelBar {
  double length, width, height;
  double mass() const { return 7850.0 * length * width * height; }
  double central_inertia() const { return mass() * (length * length + height * height) / 12; }
  double end_inertia() const { return mass() * (length * length / 3 + height * height / 12); }
};

/// That of problems/hard/dead_centres.json and heavy_slider.json.
inline RigidSliderCrank steel_slider_crank(double slider_mass, double rod_length = 0.25) {
  const SteelBar crank{0.1, 0.02, 0.02}, rod{rod_length, 0.01, 0.02};
  return {crank.length,          rod.length, crank.end_inertia(), rod.mass(),
          rod.central_inertia(), slider_mass};
}

/// N four-bars of links of 1 m and 1 kg, all uprights parallel: the angle θ of the uprights from
/// the vertical, to the right, at an instant; θ(0) = 0, θ̇(0) = 1 rad/s.
///     T = ½ ((N+1)/3 + N) θ̇²,   V = ((N+1)/2 + N) g cos θ
inline double four_bar_angle(int count, double end) {
  const double inertia = (count + 1) / 3.0 + count, weight = ((count + 1) / 2.0 + count) * 9.81;
  const auto rate = [&](double, const Eigen::Vector2d& y) {
    return Eigen::Vector2d(y(1), weight / inertia * std::sin(y(0)));
  };
  return runge_kutta<Eigen::Vector2d>(rate, {0.0, 1.0}, end, 200000)(0);
}

}  // namespace pleuel::test
