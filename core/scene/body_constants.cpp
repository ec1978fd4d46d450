#include "core/scene/body_constants.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/diameter.hpp"
#include "core/base/find_named.hpp"
#include "core/base/int_size.hpp"
#include "core/scene/kind_table.hpp"
#include "core/scene/visit_constants.hpp"

namespace pleuel {

namespace {

double largest_of(double number) {
  return std::abs(number);
}
double largest_of(const SparseMatrix& matrix) {
  return matrix.nonZeros() > 0 ? matrix.coeffs().abs().maxCoeff() : 0.0;
}
template <class Derived>
double largest_of(const Eigen::MatrixBase<Derived>& matrix) {
  return matrix.size() > 0 ? matrix.cwiseAbs().maxCoeff() : 0.0;
}

}  // namespace

void add_constants(BodyConstants& to, double factor, const BodyConstants& change) {
  const auto add = [factor](const ConstantsBlock&, auto& number, const auto& derivative) {
    number += factor * derivative;
  };
  visit_constants(add, to, change);
}

bool is_zero(const BodyConstants& change) {
  double largest = 0.0;
  const auto look_at = [&](const ConstantsBlock&, const auto& number) {
    largest = std::max(largest, largest_of(number));
  };
  visit_constants(look_at, change);
  return largest == 0.0;
}

BodyConstants zero_constants(const BodyConstants& like) {
  BodyConstants zero = like;
  const auto set_zero = [](const ConstantsBlock&, auto& number) {
    using Number = std::remove_reference_t<decltype(number)>;
    if constexpr (std::is_same_v<Number, double>) {
      number = 0.0;
    } else {
      number.setZero();
    }
  };
  visit_constants(set_zero, zero);
  return zero;
}

std::vector<int> named_points(const StressRecovery& stress, const std::string& name) {
  if (const PointGroup* group = find_named(stress.groups, name)) return group->points;
  std::vector<int> points;
  for (int i = 0; i < int_size(stress.points); ++i) {
    if (stress.points[i] == name) points.push_back(i);
  }
  return points;
}

std::vector<std::string> point_names(const StressRecovery& stress) {
  std::vector<std::string> names = names_of(stress.groups);
  names.insert(names.end(), stress.points.begin(), stress.points.end());
  return names;
}

int nearest_place(const BodyConstants& constants, const Eigen::Vector3d& point) {
  const auto distance = [&](const BodyPlace& place) { return (place.position - point).norm(); };
  const auto nearest = std::ranges::min_element(
      constants.places,
      [&](const BodyPlace& a, const BodyPlace& b) { return distance(a) < distance(b); });
  return nearest == constants.places.end() ? -1
                                           : static_cast<int>(nearest - constants.places.begin());
}

double size_of(const BodyConstants& constants) {
  std::vector<Eigen::Vector3d> points = {Eigen::Vector3d::Zero()};
  for (const BodyPlace& place : constants.places) points.push_back(place.position);
  return diameter(points);
}

}  // namespace pleuel
