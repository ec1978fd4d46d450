#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/scene/problem_file.hpp"
#include "core/scene/units.hpp"

namespace pleuel {

/// What a response measures: mass [kg], stress [Pa], deflection and position [m], drive torque
/// [N m]; an integral over time multiplies by [s]. `.unit` is the SI unit of values and limits.
Quantity quantity_of(const ResponseSettings& response);

/// The same at an instant, before it is reduced over time.
Quantity instant_quantity(const ResponseSettings& response);

/// The quantity of the integral over time of what a response measures: "Pa s".
Quantity times_time(const Quantity& quantity);

/// In which unit people see a quantity. JSON and CSV stay in SI.
struct ShownUnit {
  std::string si;       ///< "m"
  std::string name;     ///< "mm"
  double factor = 1.0;  ///< SI value of one shown unit: 0.001

  double shown(double value) const { return value / factor; }

  /// What stands behind a number: " mm", or nothing for pure numbers.
  std::string suffix() const { return name == "1" ? "" : " " + name; }
};

/// The unit that mechanical engineers use: mm, MPa, else SI.
ShownUnit engineering_unit(std::string_view si);

/// Of all design variables: the unit that the user wrote, else the engineering unit. Reads the
/// database of units: ask once, not in a loop.
std::vector<ShownUnit> variable_units(const ProblemFile& problem);

/// "4 to 60 mm": the bounds of a variable, in the unit that the user wrote.
std::string bounds_text(const DesignVariable& variable);

ShownUnit unit_of(const ResponseSettings& response);
/// Of a response, or of the first variable of a linear constraint.
ShownUnit unit_of(const ProblemFile& problem, const ConstraintSettings& constraint);

const ResponseSettings& find_response(const ProblemFile& problem, const std::string& name);

}  // namespace pleuel
