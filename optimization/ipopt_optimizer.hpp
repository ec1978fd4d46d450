#pragma once

#include <memory>

#include "optimization/optimizer.hpp"

namespace pleuel {

std::unique_ptr<Optimizer> make_ipopt(const BackendOptions& options);

}  // namespace pleuel
