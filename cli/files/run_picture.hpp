#pragma once

#include <string>
#include <vector>

#include "cli/reports/design_influence.hpp"
#include "cli/text/json.hpp"
#include "core/response/analysis.hpp"

/// What the report shows of simulated designs (docs/report.md) [SI].
namespace pleuel {

/// A design that is shown.
struct ShownDesign {
  std::string name;  ///< "start", "optimum"; for people, too
  Eigen::VectorXd x;
  const Analysis* analysis = nullptr;  ///< null: geometry only
  /// Of the histories (core/trust/error_bands.hpp); empty where none is known.
  std::vector<Eigen::VectorXd> bands{};
  const DesignInfluence* influence = nullptr;  ///< of the variables; null: not known
};

/// The mechanism of a problem at some designs: its geometry and, of simulated ones, motion, stress,
/// histories and what else is known of them; units and meaning of all numbers.
Json run_picture(const ProblemFile& problem, const std::vector<ShownDesign>& designs);

}  // namespace pleuel
