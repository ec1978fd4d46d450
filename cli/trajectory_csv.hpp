#pragma once

#include "cli/output_file.hpp"
#include "core/response/analysis.hpp"

namespace pleuel {

/// A response's history as one curve: the largest over places; of several that are reduced by
/// magnitude, the largest magnitude.
Eigen::VectorXd largest_channel(const Response& response, const Eigen::MatrixXd& history);

/// One line an instant: time, then each response's history (of several channels, such as the
/// points of a stress, the largest) [SI].
void write_trajectory(const ResultFile& file, const Analysis& analysis);

}  // namespace pleuel
