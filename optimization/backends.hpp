#pragma once

#include <memory>
#include <string>
#include <vector>

#include "optimization/optimizer.hpp"

namespace pleuel {

/// The names that make_optimizer() knows.
std::vector<std::string> optimizer_names();

/// nlopt-mma and nlopt-ccsaq (Svanberg 2002: conservative convex approximations; many variables,
/// inequalities only), nlopt-slsqp (Kraft 1988: sequential quadratic programming; few variables),
/// ipopt (Wächter & Biegler 2006: interior point, here with a limited-memory Hessian).
/// @throws InputError for an unknown name; the message lists the names there are.
std::unique_ptr<Optimizer> make_optimizer(const std::string& name, const BackendOptions& options);

}  // namespace pleuel
