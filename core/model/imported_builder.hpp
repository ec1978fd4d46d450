#pragma once

#include "core/model/build_context.hpp"
#include "core/model/model.hpp"

namespace pleuel {

/// A body that is known by its invariants.
/// @throws InputError where the constants are not those of the design, or an effect is asked for
///         that the file knows nothing of
void set_imported(const ImportedBody& imported, const Body& body, const BuildContext& context,
                  BodyModel& model);

/// Lines of the table of effects for a body that was built.
std::vector<EffectRecord> imported_records(const ImportedBody& imported,
                                           const EffectSettings& settings, const BodyModel& model);

}  // namespace pleuel
