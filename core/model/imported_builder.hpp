#pragma once

#include "core/model/body_builder.hpp"

namespace pleuel {

/// A body that is known by its invariants.
/// @throws InputError where the constants are not those of the design, or an effect is asked for
///         that the file knows nothing of
void set_imported(const ImportedBody& imported, const Body& body, const BuildContext& context,
                  BodyModel& model);

/// Lines of the table of effects for a body that was built.
std::vector<EffectRecord> imported_records(const ImportedBody& imported,
                                           const EffectSettings& settings, const BodyModel& model);

/// What its file says of it, continued to a design.
/// @throws InputError      where the file holds for another design only
/// @throws SimulationError where it is no body any more
BodyConstants constants_at(const ImportedBody& imported, const Body& body,
                           const Design<double>& design);

/// Index of the place that a point of the scene is at.
int place_at(const ImportedBody& imported, const Point& point, const Design<double>& start);

/// Whether the body moves in a plane through its origin without forces across it.
/// @param normal  unit vector, in the axes of the body
bool is_symmetric(const BodyConstants& constants, const Eigen::Vector3d& normal);

}  // namespace pleuel
