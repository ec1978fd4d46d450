#pragma once

namespace pleuel {

/// What a load does to a point of a body.
enum class LoadKind { force, torque };

}  // namespace pleuel
