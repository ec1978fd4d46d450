#pragma once

#include <vector>

#include "core/integration/simulate.hpp"
#include "core/model/model.hpp"

namespace pleuel {

/// Displacements u v w θx θy θz of the nodes of an elastic beam (or of the places of an imported
/// body) against its frame, 6 × nodes; zero where there is no coordinate. Of a reduced beam those
/// that its modes make.
Eigen::MatrixXd nodal_displacements(const BodyModel& body, const State& state);

/// Δu of an element, with the shortening by bending where geometric stiffening is built [m].
double elongation_of(const BodyModel& body, const Eigen::MatrixXd& nodal, int element);

/// Instants (steps of a trajectory) at which a beam is deformed most, and how far.
struct LargestDeformation {
  int bending_step = 0, twist_step = 0, strain_step = 0;
  double bending = 0.0;  ///< rotation against the frame, without twist [rad]
  double twist = 0.0;    ///< about the axis [rad]
  double strain = 0.0;   ///< |Δu|/ℓ of an element
};

struct TrustedRun;  // trusted_run.hpp

/// One an elastic body of the model (others stay zero), in its order. Of an imported body the
/// rotations of its places.
const std::vector<LargestDeformation>& largest_deformations(const TrustedRun& run);

}  // namespace pleuel
