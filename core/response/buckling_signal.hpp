#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/model/model.hpp"
#include "core/response/signal.hpp"

namespace pleuel {

/// P_E [N] for bending in one plane, and its derivatives with respect to all design variables.
struct EulerLoad {
  double value = 0.0;
  Eigen::VectorXd derivatives;
  std::string name;  ///< ", bending along y"; empty if there is no other one
};

/// Those of a beam for both planes; one where they are equal.
std::vector<EulerLoad> euler_loads(const BodyModel& body, int variables);

/// −N [N] at every node and quarter point of the elements of a beam.
std::unique_ptr<Signal> make_compression_signal(const BodyModel& body,
                                                const Eigen::Vector3d& gravity);

/// Compressive axial force over the Euler load of the member as if pinned at both ends,
///     −N/P_E,   P_E = π² min(E I)/L²                                               [–]
/// 0.5 is a load factor of 2 against buckling. L is the length of the whole beam, E I the smallest
/// bending stiffness of its sections about an axis. The places of the compression come once for each
/// of the loads, one load after the other, whether the motion is in a plane or not. Where shear bends
/// the beam, P_E/(1 + P_E/(κGA)) takes the place of P_E (Engesser; Timoshenko & Gere, Theory of
/// Elastic Stability, art. 2.17).
/// That is safe for tapered members, and for members whose ends are held more firmly than by pins.
/// Where two sections have the same E I about an axis, the response has a kink.
/// @param compression  of the whole beam
/// @param loads        at least one
std::unique_ptr<Signal> make_buckling_signal(std::unique_ptr<Signal> compression,
                                             std::vector<EulerLoad> loads);

}  // namespace pleuel
