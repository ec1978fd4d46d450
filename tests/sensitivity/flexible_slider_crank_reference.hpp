#pragma once

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>

/// The flexible slider-crank of the IVP Test Set (Simeon 1998), rigid crank at constant speed and a
/// rod with two sines in bending and a quadratic axial displacement, once more and without the code
/// under test: four coordinates without constraints, virtual power summed over points of the rod,
/// an explicit extrapolation method, and derivatives by the complex step.
namespace flexible_slider_crank {

/// A number whose imaginary part carries a derivative.
using Complex = std::complex<double>;

/// What the rod is made of: Young's modulus [Pa], density [kg/m³], height in the plane [m].
struct Rod {
  Complex young = 2e11, density = 7870.0, height = 0.008;
};

constexpr int modes = 4;
using Coordinates = std::array<Complex, modes>;

/// q and dq/dt: amplitudes of the two sines, axial displacement in the middle and at the end.
struct Motion {
  Coordinates q, v;
};

/// Legendre's points and weights on [0, 1].
template <std::size_t count>
struct GaussRule {
  std::array<double, count> point{}, weight{};

  GaussRule() {
    const auto n = static_cast<double>(count);
    for (std::size_t i = 0; i < count; ++i) {
      double x = std::cos(std::numbers::pi * (static_cast<double>(i) + 0.75) / (n + 0.5));
      double slope = 0.0;
      for (int iteration = 0; iteration < 50; ++iteration) {
        double before = 1.0, value = x;
        for (std::size_t k = 2; k <= count; ++k) {
          const auto degree = static_cast<double>(k);
          const double next = ((2 * degree - 1) * x * value - (degree - 1) * before) / degree;
          before = value;
          value = next;
        }
        slope = n * (x * value - before) / (x * x - 1.0);
        x -= value / slope;
      }
      point[i] = 0.5 * (1.0 + x);
      weight[i] = 1.0 / ((1.0 - x * x) * slope * slope);
    }
  }
};

class Mechanism {
 public:
  static constexpr double crank = 0.15, length = 0.3, width = 0.008, slider_mass = 0.075552;
  static constexpr double speed = 150.0;

  explicit Mechanism(const Rod& rod) : rod_(rod) {
    const GaussRule<point_count> gauss;
    for (std::size_t i = 0; i < point_count; ++i) {
      const double s = gauss.point[i], angle = std::numbers::pi * s;
      points_[i] = {gauss.weight[i] * length, s * length,          std::sin(angle),
                    std::sin(2 * angle),      4.0 * s * (1.0 - s), s * (2.0 * s - 1.0)};
    }
  }

  /// d²q/dt²: Σ ∫ρA δr·r̈ dx + Θ δφ φ̈ + m₃ δx₃ ẍ₃ + δqᵀ K q = 0 with the rod's points at
  /// r = r₁ + A(φ) p, p = (x + u, v). Θ is the rotary inertia of a rigid rod's sections.
  Coordinates accelerations(double time, const Motion& motion) const {
    const Coordinates& q = motion.q;
    const Coordinates& v = motion.v;
    const Loop loop(time, motion);
    const double c1 = std::cos(speed * time), s1 = std::sin(speed * time);
    // Acceleration of the pin in the axes of the rod; the part of φ̈ without that of q.
    const double pull = -crank * speed * speed;
    const Complex pin_x = pull * (loop.cosine * c1 + loop.sine * s1);
    const Complex pin_y = pull * (loop.cosine * s1 - loop.sine * c1);
    const Complex turn = loop.turn, rate = loop.rate, rate2 = rate * rate;

    Complex mass44 = 0.0, mass14 = 0.0, mass24 = 0.0, mass34 = 0.0;
    double mass11 = 0.0, mass12 = 0.0, mass22 = 0.0, mass33 = 0.0;
    Coordinates force{};
    for (const Point& at : points_) {
      const Complex px = at.x + at.middle * q[2] + at.end * q[3];
      const Complex py = at.first * q[0] + at.second * q[1];
      const Complex px_rate = at.middle * v[2] + at.end * v[3];
      const Complex py_rate = at.first * v[0] + at.second * v[1];
      const Complex ax = pin_x - 2.0 * rate * py_rate - loop.free_acceleration * py - rate2 * px;
      const Complex ay = pin_y + 2.0 * rate * px_rate + loop.free_acceleration * px - rate2 * py;
      // What the fourth coordinate moves: the end, and the whole rod by the loop.
      const Complex bx = at.end - turn * py, by = turn * px;
      const double w = at.weight;
      mass11 += w * at.first * at.first;
      mass12 += w * at.first * at.second;
      mass22 += w * at.second * at.second;
      mass33 += w * at.middle * at.middle;
      mass14 += w * at.first * by;
      mass24 += w * at.second * by;
      mass34 += w * at.middle * bx;
      mass44 += w * (bx * bx + by * by);
      force[0] -= w * at.first * ay;
      force[1] -= w * at.second * ay;
      force[2] -= w * at.middle * ax;
      force[3] -= w * (bx * ax + by * ay);
    }
    const Complex line = rod_.density * width * rod_.height;  // mass a length
    const Complex turning = line * length * rod_.height * rod_.height / 12.0;
    for (Complex& f : force) f *= line;
    // The slider: δx₃ = δq₄/cos φ.
    const Complex along = 1.0 / loop.cosine;
    force[3] -= turning * turn * loop.free_acceleration + slider_mass * along * loop.slider(time);
    const Complex corner = line * mass44 + turning * turn * turn + slider_mass * along * along;
    add_elastic_forces(q, force);
    return solve({line * mass11, line * mass12, line * mass22, line * mass33, line * mass14,
                  line * mass24, line * mass34, corner},
                 force);
  }

  /// φ2, x3, q1 … q4.
  static std::array<Complex, 6> observed(double time, const Motion& motion) {
    const Loop loop(time, motion);
    const Coordinates& q = motion.q;
    const Complex x3 = crank * std::cos(speed * time) + (length + q[3]) * loop.cosine;
    return {std::asin(loop.sine), x3, q[0], q[1], q[2], q[3]};
  }
  /// dφ2/dt
  static Complex rod_rate(double time, const Motion& motion) { return Loop(time, motion).rate; }

 private:
  static constexpr std::size_t point_count = 16;

  /// Weight and place of a point [m], shape functions there.
  struct Point {
    double weight, x, first, second, middle, end;
  };

  /// The rod's angle from l₁ sin φ₁ + (l₂ + q₄) sin φ = 0, and what follows from its derivatives.
  struct Loop {
    Loop(double time, const Motion& motion)
        : end(length + motion.q[3]),
          end_rate(motion.v[3]),
          sine(-crank * std::sin(speed * time) / end),
          cosine(std::sqrt(1.0 - sine * sine)),
          turn(-sine / (end * cosine)),
          rate(-crank * speed * std::cos(speed * time) / (end * cosine) + turn * end_rate),
          free_acceleration(
              (crank * speed * speed * std::sin(speed * time) + end * rate * rate * sine) /
                  (end * cosine) -
              2.0 * end_rate * rate / end) {}
    /// ẍ₃ without the part of q̈.
    Complex slider(double time) const {
      return -crank * speed * speed * std::cos(speed * time) - 2.0 * end_rate * rate * sine -
             end * free_acceleration * sine - end * rate * rate * cosine;
    }
    Complex end, end_rate, sine, cosine;
    Complex turn;               ///< ∂φ/∂q₄
    Complex rate;               ///< dφ/dt
    Complex free_acceleration;  ///< d²φ/dt² where q̈ = 0
  };

  void add_elastic_forces(const Coordinates& q, Coordinates& force) const {
    const Complex area = width * rod_.height;
    const Complex bending = rod_.young * area * rod_.height * rod_.height / 12.0;
    const Complex axial = rod_.young * area / (3.0 * length);
    const double wave = std::numbers::pi / length;
    force[0] -= bending * (0.5 * length * std::pow(wave, 4)) * q[0];
    force[1] -= bending * (0.5 * length * std::pow(2.0 * wave, 4)) * q[1];
    force[2] -= axial * (16.0 * q[2] - 8.0 * q[3]);
    force[3] -= axial * (7.0 * q[3] - 8.0 * q[2]);
  }

  struct Mass {
    Complex m11, m12, m22, m33, m14, m24, m34, m44;
  };
  /// Elimination of the coordinates 1, 2, 3, of which 3 couples with 4 only.
  static Coordinates solve(const Mass& m, const Coordinates& f) {
    const Complex determinant = m.m11 * m.m22 - m.m12 * m.m12;
    const auto bending = [&](const Complex& a, const Complex& b) -> std::array<Complex, 2> {
      return {(m.m22 * a - m.m12 * b) / determinant, (m.m11 * b - m.m12 * a) / determinant};
    };
    const auto free = bending(f[0], f[1]), coupled = bending(m.m14, m.m24);
    const Complex pivot = m.m44 - m.m34 * m.m34 / m.m33 - m.m14 * coupled[0] - m.m24 * coupled[1];
    const Complex a4 = (f[3] - m.m34 * f[2] / m.m33 - m.m14 * free[0] - m.m24 * free[1]) / pivot;
    return {free[0] - coupled[0] * a4, free[1] - coupled[1] * a4, (f[2] - m.m34 * a4) / m.m33, a4};
  }

  Rod rod_;
  std::array<Point, point_count> points_{};
};

/// The test set's start; the same for every rod.
inline Motion start() {
  return {{0.0, 0.0, 0.103339863e-4, 0.169327969e-4},
          {0.444896105, 0.463434311e-2, -0.178591076e-5, -0.268938672e-5}};
}

/// Steps of the modified midpoint rule, extrapolated in h² (Hairer, Nørsett & Wanner, Solving
/// Ordinary Differential Equations I, §II.9): order 12 with 2, 4 … 12 substeps.
class Extrapolation {
 public:
  explicit Extrapolation(const Rod& rod) : mechanism_(rod), motion_(start()) {}

  double time() const { return time_; }
  const Motion& motion() const { return motion_; }

  void advance(double step) {
    for (std::size_t row = 0; row < rows; ++row) {
      table_[row] = midpoint(step, 2 * (static_cast<int>(row) + 1));
      for (std::size_t column = row; column-- > 0;) {
        const double ratio = static_cast<double>(row + 1) / static_cast<double>(column + 1);
        const double factor = 1.0 / (ratio * ratio - 1.0);
        for (std::size_t i = 0; i < modes; ++i) {
          table_[column].q[i] =
              table_[column + 1].q[i] + factor * (table_[column + 1].q[i] - table_[column].q[i]);
          table_[column].v[i] =
              table_[column + 1].v[i] + factor * (table_[column + 1].v[i] - table_[column].v[i]);
        }
      }
    }
    motion_ = table_[0];
    time_ += step;
  }

  /// To a time in so many equal steps.
  void advance_to(double time, int steps) {
    const double begin = time_;
    for (int i = 1; i <= steps; ++i) advance(begin + (time - begin) * i / steps - time_);
    time_ = time;
  }

 private:
  static constexpr std::size_t rows = 6;

  Motion derivative(double time, const Motion& motion) const {
    return {motion.v, mechanism_.accelerations(time, motion)};
  }
  static Motion moved(const Motion& motion, const Motion& rate, double step) {
    Motion result = motion;
    for (std::size_t i = 0; i < modes; ++i) {
      result.q[i] += step * rate.q[i];
      result.v[i] += step * rate.v[i];
    }
    return result;
  }
  Motion midpoint(double step, int count) const {
    const double h = step / count;
    Motion before = motion_;
    Motion now = moved(before, derivative(time_, before), h);
    for (int i = 1; i < count; ++i) {
      const Motion next = moved(before, derivative(time_ + i * h, now), 2.0 * h);
      before = now;
      now = next;
    }
    return now;
  }

  Mechanism mechanism_;
  Motion motion_;
  double time_ = 0.0;
  std::array<Motion, rows> table_{};
};

}  // namespace flexible_slider_crank
