#pragma once

#include "core/base/packed.hpp"
#include "core/scene/problem_file.hpp"

namespace pleuel {

/// A problem for other processes (core/base/packed.hpp), with all that was read from the files that
/// it names: what is unpacked has the same responses, to the last bit.
void transfer(Packer& archive, ProblemFile& problem);
void transfer(Unpacker& archive, ProblemFile& problem);

}  // namespace pleuel
