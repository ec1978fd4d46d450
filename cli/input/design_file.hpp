#pragma once

#include <filesystem>

#include <Eigen/Core>

#include "core/scene/problem_file.hpp"

namespace pleuel {

/// The design in a document with "variables": {NAME: {"value", …}}: the result.json of an
/// optimization, or the failed_design.json beside it. Values are numbers in SI, which read back
/// exactly, numbers with a "unit" beside them, or texts such as "12 mm". By hand it is shorter:
/// {NAME: "12 mm", …}. Of a folder it is the result.json inside.
/// @throws InputError if there is no such file, if it does not give every variable of the problem
///         and no other one a value within its bounds, or if a unit is not that of the variable
Eigen::VectorXd read_design(const std::filesystem::path& path, const ProblemFile& problem);

}  // namespace pleuel
