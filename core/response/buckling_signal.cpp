#include "core/response/buckling_signal.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/response/section_force_signal.hpp"

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

/// Of the section with the least.
template <class Scalar>
Scalar euler_load(const Beam<Scalar>& beam, Plane plane) {
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

}  // namespace

std::unique_ptr<Signal> make_buckling_signal(std::unique_ptr<Signal> compression,
                                             const std::vector<DesignFactor>& loads) {
  std::vector<DesignFactor> inverses;
  for (const DesignFactor& load : loads) inverses.push_back(load.inverse());
  return std::make_unique<ScaledSignal>(std::move(compression), std::move(inverses));
}

std::unique_ptr<Signal> make_compression_signal(const BodyModel& body,
                                                const Eigen::Vector3d& gravity) {
  std::vector<SignalSum::Part> parts;
  parts.push_back({-1.0, make_section_force_signal(body, gravity, SectionForcePart::axial, {})});
  return std::make_unique<SignalSum>(std::move(parts));
}

std::vector<DesignFactor> euler_loads(const BodyModel& body, int variables) {
  std::vector<DesignFactor> loads;
  const auto add = [&](Plane plane, const char* name) {
    DesignFactor load{euler_load(body.beam, plane), Eigen::VectorXd::Zero(variables), name};
    for (const auto& [variable, beam] : body.beam_x) {
      load.derivatives(variable) = derivative_of(euler_load(beam, plane));
    }
    loads.push_back(std::move(load));
  };
  if (body.bends_alike) {
    add(Plane::y, "");
  } else {
    add(Plane::y, ", bending along y");
    add(Plane::z, ", bending along z");
  }
  return loads;
}

}  // namespace pleuel
