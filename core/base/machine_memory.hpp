#pragma once

namespace pleuel {

/// What this machine, or the container that we are in, has of memory [byte]; infinite if nobody
/// knows.
double machine_memory();

/// What the states of a trajectory may take where nobody says otherwise: 4 GB, or a quarter of what
/// there is if that is less [byte].
double default_memory();

}  // namespace pleuel
