#include "tests/random/random_scene.hpp"

namespace pleuel::test {

const unsigned first_seed = PLEUEL_FIRST_SEED, end_seed = PLEUEL_END_SEED;
const int least_scenes = PLEUEL_LEAST_SCENES;

}  // namespace pleuel::test
