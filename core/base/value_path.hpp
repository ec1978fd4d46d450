#pragma once

#include <vector>

/// Values in a row as a smooth function of their number: what lies between the sizes of a list.
namespace pleuel {

struct PathPoint {
  double value = 0.0, slope = 0.0;
};

/// The value at 0, 1, 2 … and, between them, a cubic that never leaves the range of the two values
/// beside it; once differentiable. Slopes at the inner values are harmonic means of the differences
/// before and after, zero where these differ in sign (Fritsch & Butland 1984); at the ends those of
/// the parabola through three values, kept from overshooting (Fritsch & Carlson 1980). Beyond the
/// ends it goes on straight.
/// @param values  at least one; a single one is constant
/// @param at      from 0 to the number of values less one
PathPoint path_point(const std::vector<double>& values, double at);

}  // namespace pleuel
