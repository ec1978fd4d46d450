#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/files/output_file.hpp"
#include "core/response/analysis.hpp"

namespace pleuel {

/// One line an instant: time, then each response's history (core/response/shown_history.hpp) [SI],
/// and `NAME:error`, the half-width of its error band.
/// @param bands  one a response; those that are empty are left out, as are all of none
void write_trajectory(const ResultFile& file, const Analysis& analysis,
                      const std::vector<Eigen::VectorXd>& bands = {});

/// One line an instant: time, then each response's history and its derivatives with respect to all
/// variables, at the place where the response is taken [SI].
/// @throws SimulationError
void write_history_gradients(const ResultFile& file, const ProblemFile& problem,
                             Analysis& analysis);

/// What such a file of the same simulation says of the bands.
struct TrajectoryBands {
  std::vector<Eigen::VectorXd> bands;  ///< one a response; empty: the file has none
  std::string fault;                   ///< what is wrong with the file; empty: nothing
};

TrajectoryBands read_bands(const std::filesystem::path& file, const Analysis& analysis);

}  // namespace pleuel
