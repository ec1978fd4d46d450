#pragma once

namespace pleuel::test {

/// How coarse a simulation is: times the step and the elements of a file.
struct Coarseness {
  double step = 1.0, elements = 1.0;
};

}  // namespace pleuel::test
