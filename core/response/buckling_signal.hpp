#pragma once

#include <memory>
#include <vector>

#include "core/model/model.hpp"
#include "core/response/signal.hpp"

namespace pleuel {

/// Compressive axial force over the Euler load of the member as if pinned at both ends,
///     −N/P_E,   P_E = π² min(E I)/L²                                               [–]
/// at every node and quarter point of its elements: 0.5 is a load factor of 2 against buckling.
/// with P_E/(1 + P_E/(κGA)) in place of P_E where shear bends the beam (Engesser).
/// L is the length of the whole beam, E I the smallest bending stiffness of its sections, about
/// either axis, also where the motion is in a plane: a channel for each axis, so the larger counts.
/// That is safe for tapered members, and for members whose ends are held more firmly than by pins.
/// Where two sections (or both axes of one) have the same E I, the response has a kink.
std::unique_ptr<Signal> make_buckling_signal(const BodyModel& body, const Eigen::Vector3d& gravity);

/// −N [N], at the same places.
std::unique_ptr<Signal> make_compression_signal(const BodyModel& body,
                                                const Eigen::Vector3d& gravity);

/// P_E [N] for bending in one plane, and its derivatives with respect to all design variables.
struct EulerLoad {
  double value = 0.0;
  Eigen::VectorXd derivatives;
};

/// Those of a beam for both planes; one where they are equal.
std::vector<EulerLoad> euler_loads(const BodyModel& body, int variables);

}  // namespace pleuel
