#pragma once

#include "cli/files/output_file.hpp"
#include "core/response/analysis.hpp"

namespace pleuel {

/// One line an instant: time, then each response's history and its derivatives with respect to all
/// variables, at the place where the response is taken [SI].
/// @throws SimulationError
void write_history_gradients(const ResultFile& file, const ProblemFile& problem,
                             Analysis& analysis);

}  // namespace pleuel
