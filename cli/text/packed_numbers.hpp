#pragma once

#include <Eigen/Core>

#include "cli/text/json.hpp"

namespace pleuel {

/// Many numbers in little room: {"rows": R, "f32": base64 of little-endian 32-bit floats, column by
/// column}. Seven digits: for what is drawn, not for what is computed with.
Json packed_numbers(const Eigen::MatrixXd& numbers);

}  // namespace pleuel
