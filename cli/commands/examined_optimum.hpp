#pragma once

#include "cli/files/run_record.hpp"
#include "cli/reports/optimum_document.hpp"

namespace pleuel {

/// What is told of the first and the last design.
struct Examined {
  Json effects = Json::array();  ///< that are simulated
  std::string drives;            ///< what they need at both designs, for people
  bool is_whole = true;          ///< no interrupt has ended it
};

/// Simulates both designs in every load case, for their trajectory files, the picture of the page, and
/// what else is told of the optimum. An interrupt ends that, but not what was found.
Examined examine_optimum(RunRecord& record, Optimum& optimum, InfluenceTimes times);

}  // namespace pleuel
