#pragma once

#include <string>

#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// A beam for which it may count what the model leaves out.
struct ConcernedBeam {
  std::string name;
  double indicator = 0.0;  ///< of how much, beside other beams
};

}  // namespace pleuel
