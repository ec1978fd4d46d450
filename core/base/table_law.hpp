#pragma once

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/base/time_law.hpp"

/// Functions of time through points (tᵢ, yᵢ), with d_i = (yᵢ₊₁ − yᵢ)/(tᵢ₊₁ − tᵢ).
namespace pleuel {

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
