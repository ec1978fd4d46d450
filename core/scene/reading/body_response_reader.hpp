#pragma once

#include "core/scene/reading/response_keys.hpp"

/// Responses that are observed at one body: what each asks of a beam, another body or one of a
/// file. Everything throws InputError.
namespace pleuel {

void read_stress(const JsonNode& node, const ResponseContext& context, ResponseSettings& response);

/// Utilization by a cycle: a criterion and what it needs of the materials, no `over_time`.
void read_fatigue(const JsonNode& node, const ResponseContext& context, ResponseSettings& response);

/// Of shear forces and torsion, over one beam or several.
void read_shear_stress(const JsonNode& node, const ResponseContext& context,
                       ResponseSettings& response);

/// N, M, T or Q at a place of a beam.
void read_section_force(const JsonNode& node, const ResponseContext& context,
                        ResponseSettings& response);

void read_turning(const JsonNode& node, const ResponseContext& context, ResponseSettings& response);

void read_deflection(const JsonNode& node, const ResponseContext& context,
                     ResponseSettings& response);

void read_buckling(const JsonNode& node, const ResponseContext& context,
                   ResponseSettings& response);

/// Position, velocity or acceleration. The magnitude of a position would depend on the origin.
void read_motion(const JsonNode& node, const ResponseContext& context, ResponseSettings& response);

}  // namespace pleuel
