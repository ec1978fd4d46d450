#pragma once

namespace pleuel::test {

/// The seeds of the random scenes of this executable: [first_seed, end_seed).
extern const unsigned first_seed, end_seed;
/// So many of the seeds have to run, with margin for other compilers.
extern const int least_scenes;

}  // namespace pleuel::test
