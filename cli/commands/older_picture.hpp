#pragma once

#include <vector>

#include "cli/files/older_run.hpp"

namespace pleuel {

/// What is told of files that cannot be used.
using Notes = std::vector<std::string>;

/// What the page of an older run shows of its mechanism (run_picture()): its designs are simulated again
/// from the run card. Null of a run of several files.
/// @throws std::exception if that is not possible any more
Json picture_of_run(const OlderRun& run, Notes& notes);

}  // namespace pleuel
