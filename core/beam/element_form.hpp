#pragma once

#include "core/base/dual.hpp"
#include "core/beam/beam.hpp"

namespace pleuel {

/// What shapes an element between its nodes: its length, and how far shear bends it.
///
/// Timoshenko's beam without loads between its nodes has a cubic deflection v, and a shear angle
/// γ = v' − θ that is the same all along, with θ the rotation of the sections. EI θ'' + κGA γ = 0 and
/// the cubic with the slopes θ₁ + γ and θ₂ + γ at its ends give
///     γ = s ((v₂ − v₁)/ℓ − (θ₁ + θ₂)/2),   s = Φ/(1 + Φ),   Φ = 12 EI/(κGA ℓ²)
/// (Przemieniecki, Theory of Matrix Structural Analysis, 1968, §5.6; Friedman & Kosmatka 1993). So the
/// shapes are Euler and Bernoulli's, of end slopes that differ from the rotations of the sections by
/// γ. Without shear s = 0.
template <class Scalar>
struct ElementForm {
  Scalar length;                                    ///< ℓ [m]
  Scalar shear_y = Scalar(0), shear_z = Scalar(0);  ///< s of deflections along y and z [–]
};

template <class Scalar>
ElementForm<Scalar> form_of(const BeamElement<Scalar>& element) {
  const Scalar& length = element.length;
  const auto share = [&](const Scalar& inertia, const Scalar& compliance) {
    if (value_of(compliance) == 0.0) return Scalar(0);
    const Scalar phi = 12.0 * element.young * inertia * compliance / (length * length);
    return Scalar(phi / (1.0 + phi));
  };
  return {length, share(element.section.inertia_z, element.shear_compliance_y),
          share(element.section.inertia_y, element.shear_compliance_z)};
}

}  // namespace pleuel
