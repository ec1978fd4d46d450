#pragma once

#include "core/base/task_server.hpp"

namespace pleuel {

/// All work that other ranks can do.
WorkMakers work_makers();

}  // namespace pleuel
