#include "core/effects/make_body_equations.hpp"

#include <utility>

#include "core/effects/general_body_equations.hpp"
#include "core/effects/planar_body_equations.hpp"

namespace pleuel {

std::unique_ptr<BodyEquations> make_body_equations(const BodyFrame& frame,
                                                   const Invariants<double>& invariants) {
  if (frame.rotation == RotationCoordinates::angle) {
    return std::make_unique<PlanarBodyEquations>(frame, invariants);
  }
  if (frame.rotation == RotationCoordinates::none && invariants.size() == 0) {
    return std::make_unique<TranslatingBodyEquations>(frame, invariants.mass);
  }
  return std::make_unique<GeneralBodyEquations>(frame, invariants);
}

std::unique_ptr<DerivativeForces> make_derivative_forces(const BodyFrame& frame,
                                                         Invariants<double> derivative) {
  if (frame.rotation == RotationCoordinates::angle) {
    return std::make_unique<PlanarDerivativeForces>(frame, derivative);
  }
  return std::make_unique<GeneralDerivativeForces>(frame, std::move(derivative));
}

}  // namespace pleuel
