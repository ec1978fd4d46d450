#pragma once

#include <filesystem>

#include <Eigen/Core>

#include "core/scene/problem_file.hpp"

namespace pleuel {

/// The design in a document with "variables": {NAME: {"value", …}} [SI]: the result.json of an
/// optimization, or the failed_design.json beside it. Numbers read back exactly.
/// @throws InputError if there is no such file, if it does not give every variable of the problem
///         and no other one a value within its bounds, or if a unit is not that of the variable
Eigen::VectorXd read_design(const std::filesystem::path& path, const ProblemFile& problem);

}  // namespace pleuel
