#pragma once

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/base/time_law.hpp"

/// Functions of time through points (tᵢ, yᵢ), with d_i = (yᵢ₊₁ − yᵢ)/(tᵢ₊₁ − tᵢ).
namespace pleuel {

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

/// Rates at the inner knots from mean(before, after, …) of the chords, where both have one sign;
/// else, and at the ends, zero.
template <class Scalar, class Mean>
std::vector<Scalar> limited_rates(const std::vector<double>& knots,
                                  const std::vector<Scalar>& values, const Mean& mean) {
  const std::vector<Scalar> chords = chord_rates(knots, values);
  std::vector<Scalar> rates(knots.size(), Scalar(0));
  for (std::size_t i = 1; i + 1 < knots.size(); ++i) {
    if (value_of(chords[i - 1]) * value_of(chords[i]) <= 0.0) continue;
    rates[i] = mean(chords[i - 1], chords[i], knots[i] - knots[i - 1], knots[i + 1] - knots[i]);
  }
  return rates;
}

}  // namespace table_detail

/// Never leaves the range of the values on either side, once differentiable: cubics whose rates are
/// harmonic means of the chords, weighted by the intervals (Fritsch & Butland 1984); zero at the
/// ends and wherever the values turn.
template <class Scalar>
TimeLaw<Scalar> monotone_cubic(std::vector<double> knots, std::vector<Scalar> values) {
  const auto rates = table_detail::limited_rates(
      knots, values, [](const Scalar& before, const Scalar& after, double h0, double h1) {
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
TimeLaw<Scalar> monotone_quintic(std::vector<double> knots, std::vector<Scalar> values) {
  const auto rates = table_detail::limited_rates(
      knots, values, [](const Scalar& before, const Scalar& after, double, double) {
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

/// What a cubic spline does at its ends.
enum class SplineEnds {
  natural,  ///< no second derivative
  clamped   ///< no rate: it comes from rest and goes to rest
};

/// Twice differentiable between its ends; leaves the range of the values where they turn. The rates
/// rᵢ at the knots solve, with hᵢ = tᵢ₊₁ − tᵢ,
///     hᵢ rᵢ₋₁ + 2(hᵢ₋₁ + hᵢ) rᵢ + hᵢ₋₁ rᵢ₊₁ = 3 (hᵢ dᵢ₋₁ + hᵢ₋₁ dᵢ)
/// and at the ends  r = 0  or  2 r₀ + r₁ = 3 d₀.
template <class Scalar>
TimeLaw<Scalar> cubic_spline(std::vector<double> knots, std::vector<Scalar> values,
                             SplineEnds ends) {
  const std::size_t n = knots.size();
  const std::vector<Scalar> chords = table_detail::chord_rates(knots, values);
  const bool is_natural = ends == SplineEnds::natural;
  // Rows: below, diagonal, above; eliminated downwards.
  std::vector<double> diagonal(n, is_natural ? 2.0 : 1.0), above(n, is_natural ? 1.0 : 0.0);
  std::vector<Scalar> rates(n, Scalar(0));
  if (is_natural) rates[0] = 3.0 * chords[0];
  for (std::size_t i = 1; i < n; ++i) {
    double below = is_natural ? 1.0 : 0.0;
    if (i + 1 < n) {
      const double before = knots[i] - knots[i - 1], after = knots[i + 1] - knots[i];
      below = after;
      diagonal[i] = 2.0 * (before + after);
      above[i] = before;
      rates[i] = 3.0 * (after * chords[i - 1] + before * chords[i]);
    } else if (is_natural) {
      rates[i] = 3.0 * chords[i - 1];
    }
    const double factor = below / diagonal[i - 1];
    diagonal[i] -= factor * above[i - 1];
    rates[i] -= factor * rates[i - 1];
  }
  rates[n - 1] = rates[n - 1] / diagonal[n - 1];
  for (std::size_t i = n - 1; i-- > 0;) {
    rates[i] = (rates[i] - above[i] * rates[i + 1]) / diagonal[i];
  }
  return table_detail::hermite(TimeLaw<Scalar>::Kind::cubic, std::move(knots), std::move(values),
                               rates);
}

}  // namespace pleuel
