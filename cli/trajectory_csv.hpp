#pragma once

#include <filesystem>
#include <vector>

#include "cli/output_file.hpp"
#include "core/response/analysis.hpp"

namespace pleuel {

/// One line an instant: time, then each response's history (core/response/shown_history.hpp) [SI],
/// and `NAME:error`, the half-width of its error band.
/// @param bands  one a response; those that are empty are left out, as are all of none
void write_trajectory(const ResultFile& file, const Analysis& analysis,
                      const std::vector<Eigen::VectorXd>& bands = {});

/// The bands in such a file of the same simulation, one a response; none if it has none, or is of
/// another simulation.
std::vector<Eigen::VectorXd> read_bands(const std::filesystem::path& file,
                                        const Analysis& analysis);

}  // namespace pleuel
