#pragma once

#include <memory>
#include <string>

#include "core/response/analysis.hpp"

namespace pleuel {

/// The first steps of a simulation: for what is said before it.
struct FirstSteps {
  std::unique_ptr<Analysis> analysis;  ///< null: they fail
  std::string failure;                 ///< why
  double seconds = 0.0;                ///< that the whole simulation will take on this machine
};

/// Two runs, of some steps and of twice as many, tell the time of a step from that of the
/// beginning. They take a tenth of a second, or a third of a shorter simulation.
FirstSteps take_first_steps(const ProblemFile& problem, const Eigen::VectorXd& x);

/// "about 0.3 s": not known better than to a factor of two, since later steps may take more
/// iterations than the first ones.
std::string about_text(double seconds);

}  // namespace pleuel
