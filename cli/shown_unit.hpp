#pragma once

#include <string>
#include <string_view>

#include "core/scene/problem_file.hpp"

namespace pleuel {

/// In which unit people see a quantity. JSON and CSV stay in SI.
struct ShownUnit {
  std::string si;       ///< "m"
  std::string name;     ///< "mm"
  double factor = 1.0;  ///< SI value of one shown unit: 0.001

  double shown(double value) const { return value / factor; }
};

/// The unit that mechanical engineers use: mm, MPa, else SI.
ShownUnit engineering_unit(std::string_view si);

/// The unit that the user wrote, else the engineering unit.
ShownUnit unit_of(const ProblemFile& problem, std::size_t variable);
ShownUnit unit_of(const ResponseSettings& response);
ShownUnit unit_of(const ProblemFile& problem, const ConstraintSettings& constraint);

const ResponseSettings& find_response(const ProblemFile& problem, const std::string& name);

}  // namespace pleuel
