#pragma once

#include <vector>

#include "core/base/int_size.hpp"
#include "core/base/strengths.hpp"
#include "core/section/section_properties.hpp"

namespace pleuel {

/// One element between two nodes: Timoshenko's, or Euler and Bernoulli's where nothing shears.
template <class Scalar>
struct BeamElement {
  Scalar length;        ///< ℓ [m]
  Scalar young, shear;  ///< E, G [Pa]
  Scalar density;       ///< ρ [kg/m³]
  SectionProperties<Scalar> section;
  /// 1/(κ G A) of shear forces along y and z [1/N]; 0: shear does not bend it.
  Scalar shear_compliance_y = Scalar(0), shear_compliance_z = Scalar(0);
  Strengths<Scalar> strengths = {};
};

/// A straight chain of elements along local x; node i is the start of element i.
template <class Scalar>
struct Beam {
  std::vector<BeamElement<Scalar>> elements;
  Scalar mass_damping = Scalar(0);       ///< α [1/s] of D = α S_ff + β K
  Scalar stiffness_damping = Scalar(0);  ///< β [s]

  int node_count() const { return int_size(elements) + 1; }

  /// Local x of a node [m].
  Scalar node_position(int node) const {
    Scalar x(0);
    for (int i = 0; i < node; ++i) x += elements[i].length;
    return x;
  }
};

}  // namespace pleuel
