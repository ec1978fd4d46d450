#pragma once

#include "core/beam/beam_invariants.hpp"
#include "core/beam/elastic_basis.hpp"
#include "core/section/rectangle_section.hpp"
#include "core/section/round_section.hpp"
#include "tests/support/dense.hpp"

/// A uniform beam with a rectangular section, in any scalar type.
template <class Scalar>
pleuel::Beam<Scalar> uniform_beam(int elements, const Scalar& length,
                                  const pleuel::SectionProperties<Scalar>& section,
                                  const Scalar& young, const Scalar& density) {
  pleuel::Beam<Scalar> beam;
  pleuel::BeamElement<Scalar> element;
  element.length = length / double(elements);
  element.young = young;
  element.shear = young / 2.6;  // ν = 0.3
  element.density = density;
  element.section = section;
  beam.elements.assign(elements, element);
  return beam;
}

inline constexpr pleuel::NodalFlags all_active = {true, true, true, true, true, true};
inline constexpr pleuel::NodalFlags bending_y = {false, true, false, false, false, true};
inline constexpr pleuel::NodalFlags bending_z = {false, false, true, false, true, false};
inline constexpr pleuel::NodalFlags axial_only = {true, false, false, false, false, false};
inline constexpr pleuel::NodalFlags torsion_only = {false, false, false, true, false, false};

/// Circular frequencies of K φ = ω² M φ, ascending [rad/s].
inline Eigen::VectorXd frequencies(const pleuel::Invariants<double>& body) {
  const Eigen::MatrixXd stiffness = dense(body.pattern, body.stiffness);
  const Eigen::MatrixXd mass = dense(body.pattern, body.mass_matrix);
  return pleuel::natural_modes(stiffness, mass).lambda.cwiseMax(0.0).cwiseSqrt();
}
