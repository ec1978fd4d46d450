#pragma once

#include <vector>

#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// Displacements u v w θx θy θz of the nodes of an elastic beam (or of the places of an imported
/// body) against its frame, 6 × nodes; zero where there is no coordinate. Of a reduced beam those
/// that its modes make.
Eigen::MatrixXd nodal_displacements(const BodyModel& body, const State& state);

/// Δu of an element, with the shortening by bending where geometric stiffening is built [m].
double elongation_of(const BodyModel& body, const Eigen::MatrixXd& nodal, int element);

/// Takes the deformation of an elastic body at an instant into account. Of an imported body that is the
/// rotations of its places.
void record_deformation(const BodyModel& body, const State& state, int step,
                        LargestDeformation& largest);

/// One an elastic body of the model (others stay zero), in its order.
const std::vector<LargestDeformation>& largest_deformations(const TrustedRun& run);

}  // namespace pleuel
