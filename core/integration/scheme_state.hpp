#pragma once

#include "core/system/term.hpp"

namespace pleuel {

/// All that the next step of a scheme depends on.
struct SchemeState : State {
  Eigen::VectorXd w;  ///< algorithmic acceleration of the scheme (n)
};

}  // namespace pleuel
