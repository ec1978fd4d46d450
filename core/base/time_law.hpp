#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "core/base/expression.hpp"

namespace pleuel {

/// What a law is a function of. A force element has a coordinate s (an angle, a displacement, an
/// elongation) with its rate ṡ.
enum class LawArgument { time, coordinate, rate };

/// A prescribed function whose parameters may be design variables: of time, or, in force elements,
/// of the coordinate that they act along or of its rate. What follows says "time" for its argument.
template <class Scalar>
struct TimeLaw {
  enum class Kind {
    polynomial,  ///< parameters cᵢ: Σ cᵢ tⁱ
    ramp,        ///< Ω, T: from rest to the rate Ω within T
    harmonic,    ///< amplitude, frequency ω [rad/s], phase, offset
    half_sine,  ///< amplitude, offset: offset + amplitude sin π(t − t₀)/(t₁ − t₀) between two knots
    formula,  ///< a value for each argument of `expression`; what is no design variable is not read
    friction,   ///< F, t₀: F tanh(t/t₀)
    clearance,  ///< lower end, upper end, stiffness k, rounding δ: clearance_at()
    // Through points; before the first and after the last of them the values there hold.
    step,    ///< values at the knots, each from its knot on
    linear,  ///< values at the knots
    cubic,   ///< values at the knots, then rates there
    quintic  ///< the same; accelerations at the knots are zero
  };
  Kind kind = Kind::polynomial;
  std::vector<Scalar> parameters;
  std::vector<double> knots;  ///< of what goes through points [s], ascending
  double period = 0.0;  ///< of what is repeated [s], at least last knot − first knot; 0: it is not
  LawArgument argument = LawArgument::time;
  std::shared_ptr<const Expression> expression = {};

  TimeValue<Scalar> at(double original) const {
    const double time = period > 0.0 ? within_period(original) : original;
    switch (kind) {
      case Kind::polynomial:
        return polynomial_at(time);
      case Kind::ramp:
        return ramp_at(time);
      case Kind::harmonic:
        return harmonic_at(time);
      case Kind::step:
        return step_at(time, original);
      case Kind::half_sine:
        return half_sine_at(time);
      case Kind::formula:
        return formula_at({Scalar(time), Scalar(1), Scalar(0)}, Scalar(0), Scalar(0));
      case Kind::friction:
        return friction_at(time);
      case Kind::clearance:
        return clearance_at(time);
      default:
        return between_knots_at(time);
    }
  }

  /// Its value in a force element, with the exact derivatives that s and ṡ carry.
  Scalar value_at(double time, const Scalar& s, const Scalar& s_dot) const {
    if (kind == Kind::formula) {
      return formula_at({Scalar(time), Scalar(0), Scalar(0)}, s, s_dot).value;
    }
    if (argument == LawArgument::time) return at(time).value;
    const Scalar& of = argument == LawArgument::coordinate ? s : s_dot;
    const TimeValue<Scalar> now = at(value_of(of));
    return now.value + now.rate * (of - value_of(of));
  }

  /// The same law with other numbers: function(parameter) for each of them.
  template <class To, class Function>
  TimeLaw<To> transformed(Function&& function) const {
    TimeLaw<To> law;
    law.kind = static_cast<typename TimeLaw<To>::Kind>(kind);
    law.knots = knots;
    law.period = period;
    law.argument = argument;
    law.expression = expression;
    for (const Scalar& parameter : parameters) law.parameters.push_back(function(parameter));
    return law;
  }

 private:
  /// The same place in the first period.
  double within_period(double time) const {
    const double whole = std::floor((time - knots.front()) / period);
    const double place = time - whole * period;
    return place >= knots.front() && place < knots.front() + period ? place : knots.front();
  }

  TimeValue<Scalar> formula_at(const TimeValue<Scalar>& t, const Scalar& s,
                               const Scalar& s_dot) const {
    const auto value_of_argument = [&](int i) -> TimeValue<Scalar> {
      using ArgumentKind = ExpressionArgument::Kind;
      switch (expression->arguments[i].kind) {
        case ArgumentKind::time:
          return t;
        case ArgumentKind::coordinate:
          return {s, Scalar(0), Scalar(0)};
        case ArgumentKind::rate:
          return {s_dot, Scalar(0), Scalar(0)};
        default:
          return {parameters[i], Scalar(0), Scalar(0)};
      }
    };
    return evaluate_formula<Scalar>(*expression, value_of_argument);
  }

  /// At the ends, where it has a kink, the rate is that of the side within.
  TimeValue<Scalar> half_sine_at(double time) const {
    const Scalar &amplitude = parameters[0], &offset = parameters[1];
    if (time < knots.front() || time > knots.back()) return {offset, Scalar(0), Scalar(0)};
    const double frequency = std::numbers::pi / (knots.back() - knots.front());
    const double phase = frequency * (time - knots.front());
    const Scalar wave = amplitude * std::sin(phase);
    return {Scalar(offset + wave), Scalar(amplitude * (frequency * std::cos(phase))),
            Scalar(-frequency * frequency * wave)};
  }

  TimeValue<Scalar> friction_at(double speed) const {
    using std::tanh;
    const Scalar &force = parameters[0], &scale = parameters[1];
    const Scalar share = tanh(speed / scale), slope = (1.0 - share * share) / scale;
    return {Scalar(force * share), Scalar(force * slope),
            Scalar(-2.0 * force * share * slope / scale)};
  }

  /// k r(s − upper) − k r(lower − s), where r(x) = 0 for x < 0, x²/2δ up to δ, x − δ/2 beyond: no
  /// force within the clearance, and a stiffness that rises to k within δ behind its ends.
  TimeValue<Scalar> clearance_at(double s) const {
    const Scalar &lower = parameters[0], &upper = parameters[1], &k = parameters[2];
    if (s > value_of(upper)) {
      const TimeValue<Scalar> r = ramp_of(Scalar(s - upper));
      return {Scalar(k * r.value), Scalar(k * r.rate), Scalar(k * r.acceleration)};
    }
    if (s < value_of(lower)) {
      const TimeValue<Scalar> r = ramp_of(Scalar(lower - s));
      return {Scalar(-k * r.value), Scalar(k * r.rate), Scalar(-k * r.acceleration)};
    }
    return {Scalar(0), Scalar(0), Scalar(0)};
  }
  TimeValue<Scalar> ramp_of(const Scalar& x) const {
    const Scalar& rounding = parameters[3];
    if (value_of(x) >= value_of(rounding))
      return {Scalar(x - 0.5 * rounding), Scalar(1), Scalar(0)};
    return {Scalar(x * x / (2.0 * rounding)), Scalar(x / rounding), Scalar(1.0 / rounding)};
  }

  TimeValue<Scalar> polynomial_at(double time) const {
    TimeValue<Scalar> result{Scalar(0), Scalar(0), Scalar(0)};
    for (std::size_t i = parameters.size(); i-- > 0;) {  // Horner's rule with derivatives
      result.acceleration = result.acceleration * time + 2.0 * result.rate;
      result.rate = result.rate * time + result.value;
      result.value = result.value * time + parameters[i];
    }
    return result;
  }

  ///     φ̈ = (Ω/T)(1 − cos 2πt/T),   φ̇ = Ω (t/T − sin(2πt/T)/2π),
  ///     φ = Ω (t²/2T + T (cos 2πt/T − 1)/4π²)          for t < T;      φ̇ = Ω afterwards
  TimeValue<Scalar> ramp_at(double time) const {
    using std::cos;
    using std::sin;
    constexpr double pi = std::numbers::pi;
    const Scalar &speed = parameters[0], &ramp = parameters[1];
    if (time >= value_of(ramp)) return {Scalar(speed * (time - ramp / 2.0)), speed, Scalar(0)};
    const Scalar phase = 2.0 * pi * time / ramp;
    return {
        Scalar(speed * (time * time / (2.0 * ramp) + ramp * (cos(phase) - 1.0) / (4.0 * pi * pi))),
        Scalar(speed * (time / ramp - sin(phase) / (2.0 * pi))),
        Scalar(speed / ramp * (1.0 - cos(phase)))};
  }

  TimeValue<Scalar> harmonic_at(double time) const {
    using std::cos;
    using std::sin;
    const Scalar &amplitude = parameters[0], &frequency = parameters[1];
    const Scalar phase = frequency * time + parameters[2];
    const Scalar oscillation = amplitude * sin(phase);
    return {Scalar(parameters[3] + oscillation), Scalar(amplitude * frequency * cos(phase)),
            Scalar(-frequency * frequency * oscillation)};
  }

  /// At a jump the mean of both sides, so that schemes of second order stay so where an instant
  /// lies on it; at t = 0, from where on there is only one, the side that follows.
  /// @param original  before it was moved into the first period, which rounds
  TimeValue<Scalar> step_at(double time, double original) const {
    const std::size_t last = knots.size() - 1;
    const double rounding =
        period > 0.0 ? 4.0 * std::numeric_limits<double>::epsilon() * std::abs(original) : 0.0;
    const auto above = std::ranges::upper_bound(knots, time + rounding);
    const std::size_t after = std::max<std::ptrdiff_t>(above - knots.begin(), 1);
    std::size_t now = after - 1;
    const bool is_at_knot = std::abs(knots[now] - time) <= rounding;
    if (period > 0.0 && now == last) now = 0;  // the last knot is the first of the next period
    Scalar value = parameters[now];
    if (!is_at_knot || original == 0.0) return {value, Scalar(0), Scalar(0)};
    if (now > 0) value = 0.5 * (parameters[now - 1] + value);
    if (now == 0 && period > 0.0) value = 0.5 * (parameters[last - 1] + value);
    return {value, Scalar(0), Scalar(0)};
  }

  TimeValue<Scalar> between_knots_at(double time) const {
    const std::size_t last = knots.size() - 1;
    if (time < knots.front()) return {parameters[0], Scalar(0), Scalar(0)};
    if (time >= knots.back()) return {parameters[last], Scalar(0), Scalar(0)};
    const auto above = std::ranges::upper_bound(knots, time);
    const std::size_t i = static_cast<std::size_t>(above - knots.begin()) - 1;
    const double h = knots[i + 1] - knots[i], s = (time - knots[i]) / h;
    const Scalar &y = parameters[i], rise = parameters[i + 1] - y;
    if (kind == Kind::linear) return {Scalar(y + s * rise), Scalar(rise / h), Scalar(0)};
    const Scalar before = h * parameters[last + 1 + i], after = h * parameters[last + 2 + i];
    // y + before s + c₂ s² + … ; the quintic has no c₂
    if (kind == Kind::cubic) {
      const Scalar c2 = 3.0 * rise - 2.0 * before - after, c3 = before + after - 2.0 * rise;
      return {Scalar(y + s * (before + s * (c2 + s * c3))),
              Scalar((before + s * (2.0 * c2 + 3.0 * s * c3)) / h),
              Scalar((2.0 * c2 + 6.0 * s * c3) / (h * h))};
    }
    const Scalar c3 = 10.0 * rise - 6.0 * before - 4.0 * after,
                 c4 = 8.0 * before + 7.0 * after - 15.0 * rise,
                 c5 = 6.0 * rise - 3.0 * (before + after);
    return {Scalar(y + s * (before + s * s * (c3 + s * (c4 + s * c5)))),
            Scalar((before + s * s * (3.0 * c3 + s * (4.0 * c4 + 5.0 * s * c5))) / h),
            Scalar(s * (6.0 * c3 + s * (12.0 * c4 + 20.0 * s * c5)) / (h * h))};
  }
};

// Functions of time through points (tᵢ, yᵢ), with d_i = (yᵢ₊₁ − yᵢ)/(tᵢ₊₁ − tᵢ).

/// What a table does at its ends.
enum class TableEnds {
  free,     ///< no second derivative of a spline
  resting,  ///< no rate: it comes from rest and goes to rest
  periodic  ///< the last point is the first of the next period
};

namespace table_detail {

template <class Scalar>
std::vector<Scalar> chord_rates(const std::vector<double>& knots,
                                const std::vector<Scalar>& values) {
  std::vector<Scalar> rates;
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    rates.push_back((values[i + 1] - values[i]) / (knots[i + 1] - knots[i]));
  }
  return rates;
}

template <class Scalar>
TimeLaw<Scalar> hermite(typename TimeLaw<Scalar>::Kind kind, std::vector<double> knots,
                        std::vector<Scalar> values, const std::vector<Scalar>& rates) {
  values.insert(values.end(), rates.begin(), rates.end());
  return {kind, std::move(values), std::move(knots)};
}

/// Rates at the knots from mean(before, after, …) of the chords, where both have one sign; else
/// zero, as at the ends of what is not repeated.
template <class Scalar, class Mean>
std::vector<Scalar> limited_rates(const std::vector<double>& knots,
                                  const std::vector<Scalar>& values, TableEnds ends,
                                  const Mean& mean) {
  const std::vector<Scalar> chords = chord_rates(knots, values);
  std::vector<Scalar> rates(knots.size(), Scalar(0));
  const auto rate = [&](std::size_t before, std::size_t after) {
    if (value_of(chords[before]) * value_of(chords[after]) <= 0.0) return Scalar(0);
    return Scalar(mean(chords[before], chords[after], knots[before + 1] - knots[before],
                       knots[after + 1] - knots[after]));
  };
  for (std::size_t i = 1; i + 1 < knots.size(); ++i) rates[i] = rate(i - 1, i);
  if (ends == TableEnds::periodic) rates.front() = rates.back() = rate(chords.size() - 1, 0);
  return rates;
}

}  // namespace table_detail

/// Never leaves the range of the values on either side, once differentiable: cubics whose rates are
/// harmonic means of the chords, weighted by the intervals (Fritsch & Butland 1984); zero at the
/// ends and wherever the values turn.
template <class Scalar>
TimeLaw<Scalar> monotone_cubic(std::vector<double> knots, std::vector<Scalar> values,
                               TableEnds ends = TableEnds::resting) {
  const auto rates = table_detail::limited_rates(
      knots, values, ends, [](const Scalar& before, const Scalar& after, double h0, double h1) {
        const double w0 = 2.0 * h1 + h0, w1 = h1 + 2.0 * h0;
        return Scalar((w0 + w1) * before * after / (w0 * after + w1 * before));
      });
  return table_detail::hermite(TimeLaw<Scalar>::Kind::cubic, std::move(knots), std::move(values),
                               rates);
}

/// The same twice differentiable, for drives: quintics without acceleration at the knots. They are
/// monotone where the rates at both ends of an interval sum up to at most 5/2 of its chord (their
/// Bernstein coefficients ascend; Dougherty, Edelman & Hyman 1989). Here each is a mean of the
/// chords that is at most 2^(1/4) of the smaller one: (2/(b⁻⁴ + a⁻⁴))^(1/4).
template <class Scalar>
TimeLaw<Scalar> monotone_quintic(std::vector<double> knots, std::vector<Scalar> values,
                                 TableEnds ends = TableEnds::resting) {
  const auto rates = table_detail::limited_rates(
      knots, values, ends, [](const Scalar& before, const Scalar& after, double, double) {
        using std::sqrt;
        const bool is_steeper = std::abs(value_of(after)) > std::abs(value_of(before));
        const Scalar& small = is_steeper ? before : after;
        const Scalar ratio = is_steeper ? before / after : after / before;  // in (0, 1]
        const Scalar square = ratio * ratio;
        return Scalar(small * sqrt(sqrt(2.0 / (1.0 + square * square))));
      });
  return table_detail::hermite(TimeLaw<Scalar>::Kind::quintic, std::move(knots), std::move(values),
                               rates);
}

/// The same with quintics that rest at every knot: neither rate nor acceleration.
template <class Scalar>
TimeLaw<Scalar> resting_quintic(std::vector<double> knots, std::vector<Scalar> values) {
  const std::vector<Scalar> rates(knots.size(), Scalar(0));
  return table_detail::hermite(TimeLaw<Scalar>::Kind::quintic, std::move(knots), std::move(values),
                               rates);
}

namespace table_detail {

/// Solves rows with three entries each (Thomas' algorithm).
template <class Scalar>
std::vector<Scalar> solve_tridiagonal(const std::vector<double>& below,
                                      std::vector<double> diagonal,
                                      const std::vector<double>& above, std::vector<Scalar> right) {
  const std::size_t n = diagonal.size();
  for (std::size_t i = 1; i < n; ++i) {
    const double factor = below[i] / diagonal[i - 1];
    diagonal[i] -= factor * above[i - 1];
    right[i] -= factor * right[i - 1];
  }
  right[n - 1] = right[n - 1] / diagonal[n - 1];
  for (std::size_t i = n - 1; i-- > 0;)
    right[i] = (right[i] - above[i] * right[i + 1]) / diagonal[i];
  return right;
}

/// Rates of a periodic spline. The matrix has two more entries, in its corners: it is tridiagonal
/// but for u wᵀ with u = (−d₀, 0 …, c)ᵀ, w = (1, 0 …, −b/d₀)ᵀ (Sherman & Morrison 1950).
template <class Scalar>
std::vector<Scalar> periodic_rates(const std::vector<double>& knots,
                                   const std::vector<Scalar>& chords) {
  const std::size_t n = chords.size();  // the last knot is the first
  if (n == 1) return {Scalar(0), Scalar(0)};
  const auto h = [&](std::size_t i) { return knots[i % n + 1] - knots[i % n]; };
  std::vector<double> below(n), diagonal(n), above(n), u(n, 0.0);
  std::vector<Scalar> right(n, Scalar(0));
  for (std::size_t i = 0; i < n; ++i) {
    const double before = h(i + n - 1), after = h(i);
    below[i] = after;
    diagonal[i] = 2.0 * (before + after);
    above[i] = before;
    right[i] = 3.0 * (after * chords[(i + n - 1) % n] + before * chords[i]);
  }
  const double gamma = -diagonal[0], first_corner = below[0], last_corner = above[n - 1];
  const double ratio = first_corner / gamma;
  u[0] = gamma;
  u[n - 1] = last_corner;
  diagonal[0] -= gamma;
  diagonal[n - 1] -= last_corner * ratio;
  std::vector<Scalar> rates = solve_tridiagonal(below, diagonal, above, right);
  const std::vector<double> z = solve_tridiagonal(below, diagonal, above, u);
  const Scalar share = (rates[0] + ratio * rates[n - 1]) / (1.0 + z[0] + ratio * z[n - 1]);
  for (std::size_t i = 0; i < n; ++i) rates[i] -= share * z[i];
  rates.push_back(rates[0]);
  return rates;
}

}  // namespace table_detail

/// Twice differentiable between its ends; leaves the range of the values where they turn. The rates
/// rᵢ at the knots solve, with hᵢ = tᵢ₊₁ − tᵢ,
///     hᵢ rᵢ₋₁ + 2(hᵢ₋₁ + hᵢ) rᵢ + hᵢ₋₁ rᵢ₊₁ = 3 (hᵢ dᵢ₋₁ + hᵢ₋₁ dᵢ)
/// and at the ends  r = 0  or  2 r₀ + r₁ = 3 d₀; what is periodic has this row at its ends, too.
template <class Scalar>
TimeLaw<Scalar> cubic_spline(std::vector<double> knots, std::vector<Scalar> values,
                             TableEnds ends) {
  const std::size_t n = knots.size();
  const std::vector<Scalar> chords = table_detail::chord_rates(knots, values);
  std::vector<Scalar> rates;
  if (ends == TableEnds::periodic) {
    rates = table_detail::periodic_rates(knots, chords);
  } else {
    const bool is_free = ends == TableEnds::free;
    const double beside = is_free ? 1.0 : 0.0;
    std::vector<double> below(n, beside), diagonal(n, is_free ? 2.0 : 1.0), above(n, beside);
    rates.assign(n, Scalar(0));
    if (is_free) {
      rates[0] = 3.0 * chords[0];
      rates[n - 1] = 3.0 * chords[n - 2];
    }
    for (std::size_t i = 1; i + 1 < n; ++i) {
      above[i] = knots[i] - knots[i - 1];
      below[i] = knots[i + 1] - knots[i];
      diagonal[i] = 2.0 * (below[i] + above[i]);
      rates[i] = 3.0 * (below[i] * chords[i - 1] + above[i] * chords[i]);
    }
    rates = table_detail::solve_tridiagonal(below, diagonal, above, rates);
  }
  return table_detail::hermite(TimeLaw<Scalar>::Kind::cubic, std::move(knots), std::move(values),
                               rates);
}

}  // namespace pleuel
