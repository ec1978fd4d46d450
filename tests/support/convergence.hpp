#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

/// Least-squares slope of log(error) over log(size): the order at which errors fall.
inline double observed_order(const std::vector<double>& sizes, const std::vector<double>& errors) {
  double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const double a = std::log(sizes[i]), b = std::log(errors[i]);
    x += a;
    y += b;
    xx += a * a;
    xy += a * b;
  }
  const auto n = static_cast<double>(sizes.size());
  return (n * xy - x * y) / (n * xx - x * x);
}
