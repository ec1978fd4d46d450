#pragma once

#include <string>
#include <vector>

#include "core/response/analysis.hpp"

namespace pleuel {

/// What is shown of a mechanism beside what the file asks for: efforts and powers of drives, forces
/// in joints, energies.
struct Companion {
  ResponseSettings settings;
  Eigen::VectorXd history;  ///< one value an instant; of efforts with sign [SI]
  double value = 0.0;       ///< the largest magnitude over time [SI]
  int peak = 0;             ///< index of the instant that has it
};

struct Companions {
  Eigen::VectorXd time;  ///< [s]
  std::vector<Companion> all;
};

/// Those that the responses of the file do not show already. At every step of a simulation of
/// moderate length, at evenly chosen ones of a longer one.
Companions find_companions(const ProblemFile& problem, const Analysis& analysis);

/// Efforts and powers of all drives, in their order; of each drive the effort first.
Companions find_drive_efforts(const ProblemFile& problem, const Analysis& analysis);

}  // namespace pleuel
