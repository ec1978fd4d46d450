#pragma once

#include <algorithm>
#include <set>

#include <Eigen/Core>

#include "core/scene/number.hpp"

namespace pleuel {

/// Whether it depends on design variables.
inline bool is_bound(const Point& point) {
  return std::any_of(point.begin(), point.end(),
                     [](const Number& number) { return number.is_bound(); });
}

/// Adds the design variables that it depends on.
inline void add_variables_of(const Point& point, std::set<int>& variables) {
  for (const Number& number : point) {
    for (const int variable : number.variables()) variables.insert(variable);
  }
}

/// [m], global axes
template <class Scalar>
Eigen::Matrix<Scalar, 3, 1> resolve_point(const Point& point, const Design<Scalar>& design) {
  return {resolve(point[0], design), resolve(point[1], design), resolve(point[2], design)};
}

}  // namespace pleuel
