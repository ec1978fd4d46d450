#pragma once

#include <memory>

#include "optimization/optimizer.hpp"

/// The backends of Pleuel itself (backends.hpp).
namespace pleuel {

std::unique_ptr<Optimizer> make_nlopt_mma(const BackendOptions& options);
std::unique_ptr<Optimizer> make_nlopt_ccsaq(const BackendOptions& options);
std::unique_ptr<Optimizer> make_nlopt_slsqp(const BackendOptions& options);
std::unique_ptr<Optimizer> make_ipopt(const BackendOptions& options);

}  // namespace pleuel
