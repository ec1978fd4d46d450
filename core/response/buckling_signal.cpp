#include "core/response/buckling_signal.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "core/response/section_stations.hpp"

namespace pleuel {

namespace {

/// Bending in the local x–y plane and in the x–z plane, whether the motion has both or not.
enum class Plane { y, z };

template <class Scalar>
const Scalar& shear_compliance(const BeamElement<Scalar>& element, Plane plane) {
  return plane == Plane::y ? element.shear_compliance_y : element.shear_compliance_z;
}

template <class Scalar>
Scalar inertia(const SectionProperties<Scalar>& section, Plane plane) {
  return plane == Plane::y ? section.inertia_z : section.inertia_y;
}

/// Whether all sections are as stiff along one axis as along the other, at neighbouring designs,
/// too.
bool is_equal_in_both(const BodyModel& body) {
  constexpr double round_off = 1e-12;
  const auto differ = [](double a, double b) { return std::abs(a - b) > round_off * std::abs(b); };
  for (const BeamElement<double>& element : body.beam.elements) {
    if (differ(element.section.inertia_y, element.section.inertia_z)) return false;
    if (differ(element.shear_compliance_y, element.shear_compliance_z)) return false;
  }
  const auto derivatives_differ = [&](const Dual& a, const Dual& b) {
    return differ(derivative_of(a), derivative_of(b));
  };
  for (const auto& [variable, beam] : body.beam_x) {
    for (const BeamElement<Dual>& element : beam.elements) {
      const SectionProperties<Dual>& s = element.section;
      if (derivatives_differ(s.inertia_y, s.inertia_z)) return false;
      if (derivatives_differ(element.shear_compliance_y, element.shear_compliance_z)) return false;
    }
  }
  return true;
}

class BucklingQuantity {
 public:
  using Point = Plane;

  explicit BucklingQuantity(const BodyModel& body)
      : planes_(is_equal_in_both(body) ? std::vector<Plane>{Plane::y}
                                       : std::vector<Plane>{Plane::y, Plane::z}) {}

  std::vector<Plane> points(const BodyModel&, const SectionProperties<double>&) const {
    return planes_;
  }

  std::string name(const SectionProperties<double>&, Plane plane) const {
    if (planes_.size() == 1) return "";
    return plane == Plane::y ? ", bending along y" : ", bending along z";
  }

  template <class Scalar, class Force>
  StressOf<Scalar, Force> evaluate(const Beam<Scalar>& beam, const SectionProperties<Scalar>&,
                                   const SectionForces<Force>& forces, Plane plane) const {
    return -forces.axial / euler_load(beam, plane);
  }

  const std::vector<Plane>& planes() const { return planes_; }

  /// Of the section with the least; with shear P/(1 + P/(κGA)) (Engesser; Timoshenko & Gere, Theory
  /// of Elastic Stability, art. 2.17).
  template <class Scalar>
  static Scalar euler_load(const Beam<Scalar>& beam, Plane plane) {
    constexpr double pi = std::numbers::pi;
    const Scalar length = beam.node_position(beam.node_count() - 1);
    Scalar least(std::numeric_limits<double>::infinity());
    for (const BeamElement<Scalar>& element : beam.elements) {
      const Scalar stiffness = element.young * inertia(element.section, plane);
      Scalar load = pi * pi * stiffness / (length * length);
      const Scalar& compliance = shear_compliance(element, plane);
      if (value_of(compliance) != 0.0) load = load / (1.0 + load * compliance);
      if (value_of(load) < value_of(least)) least = load;
    }
    return least;
  }

 private:
  std::vector<Plane> planes_;
};

class CompressionQuantity : public OneASection {
 public:
  template <class Scalar, class Force>
  StressOf<Scalar, Force> evaluate(const Beam<Scalar>&, const SectionProperties<Scalar>&,
                                   const SectionForces<Force>& forces, Point) const {
    return -forces.axial;
  }
};

}  // namespace

std::unique_ptr<Signal> make_buckling_signal(const BodyModel& body,
                                             const Eigen::Vector3d& gravity) {
  return make_section_signal(body, gravity, {}, BucklingQuantity(body));
}

std::unique_ptr<Signal> make_compression_signal(const BodyModel& body,
                                                const Eigen::Vector3d& gravity) {
  return make_section_signal(body, gravity, {}, CompressionQuantity());
}

std::vector<EulerLoad> euler_loads(const BodyModel& body, int variables) {
  std::vector<EulerLoad> loads;
  const BucklingQuantity quantity(body);
  for (const Plane plane : quantity.planes()) {
    EulerLoad load{BucklingQuantity::euler_load(body.beam, plane),
                   Eigen::VectorXd::Zero(variables)};
    for (const auto& [variable, beam] : body.beam_x) {
      load.derivatives(variable) = derivative_of(BucklingQuantity::euler_load(beam, plane));
    }
    loads.push_back(std::move(load));
  }
  return loads;
}

}  // namespace pleuel
