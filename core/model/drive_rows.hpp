#pragma once

#include <vector>

#include "core/model/model.hpp"

namespace pleuel {

/// Multipliers of the drives of a model.
inline std::vector<int> drive_rows(const Model& model) {
  std::vector<int> rows;
  for (const JointModel& joint : model.joints) {
    if (joint.drive_row >= 0) rows.push_back(joint.drive_row);
  }
  return rows;
}

}  // namespace pleuel
