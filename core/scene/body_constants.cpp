#include "core/scene/body_constants.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/diameter.hpp"

namespace pleuel {

namespace {

/// Visits the numbers of two sets of constants of the same arrangement, block by block.
template <class First, class Second, class Visit>
void visit_both(First& a, Second& b, const Visit& visit) {
  visit(a.mass, b.mass);
  visit(a.first_moment, b.first_moment);
  visit(a.second_moment, b.second_moment);
  visit(a.shape, b.shape);
  visit(a.mixed, b.mixed);
  for (std::size_t i = 0; i < a.moments.size(); ++i) visit(a.moments[i], b.moments[i]);
  visit(a.mass_matrix, b.mass_matrix);
  visit(a.stiffness, b.stiffness);
  visit(a.damping, b.damping);
  for (std::size_t i = 0; i < a.places.size(); ++i) {
    visit(a.places[i].position, b.places[i].position);
    visit(a.places[i].displacement, b.places[i].displacement);
    visit(a.places[i].rotation, b.places[i].rotation);
  }
  if (a.stress) {
    visit(a.stress->strength, b.stress->strength);
    visit(a.stress->of_coordinates, b.stress->of_coordinates);
    visit(a.stress->of_accelerations, b.stress->of_accelerations);
    visit(a.stress->of_stretching, b.stress->of_stretching);
  }
  if (!a.stretching) return;
  visit(a.stretching->damping, b.stretching->damping);
  visit(a.stretching->displacements, b.stretching->displacements);
  for (std::size_t i = 0; i < a.stretching->elements.size(); ++i) {
    visit(a.stretching->elements[i].axial_stiffness, b.stretching->elements[i].axial_stiffness);
    visit(a.stretching->elements[i].slopes, b.stretching->elements[i].slopes);
  }
}

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
  visit_both(to, change,
             [factor](auto& number, const auto& derivative) { number += factor * derivative; });
}

bool is_zero(const BodyConstants& change) {
  double largest = 0.0;
  visit_both(change, change, [&](const auto& number, const auto&) {
    largest = std::max(largest, largest_of(number));
  });
  return largest == 0.0;
}

BodyConstants zero_constants(const BodyConstants& like) {
  BodyConstants zero = like;
  visit_both(zero, like, [](auto& number, const auto&) {
    using Number = std::remove_reference_t<decltype(number)>;
    if constexpr (std::is_same_v<Number, double>) {
      number = 0.0;
    } else {
      number.setZero();
    }
  });
  return zero;
}

int nearest_place(const BodyConstants& constants, const Eigen::Vector3d& point) {
  const auto distance = [&](const BodyPlace& place) { return (place.position - point).norm(); };
  const auto nearest = std::min_element(
      constants.places.begin(), constants.places.end(),
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
