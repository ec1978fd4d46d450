#pragma once

#include <array>
#include <vector>

#include "core/scene/reading/json_node.hpp"
#include "core/scene/units.hpp"

namespace pleuel {

/// Two columns of a file, in SI units, one entry a row.
struct TableColumns {
  std::vector<double> arguments;  ///< ascending, at least two
  std::vector<double> values;
};

/// Reads {"file": "gas_force.csv", "columns": ["angle", "force"], "units": ["deg", "N"]}: a text file
/// from the folder of the problem file on. Cells are separated by commas, semicolons, tabs or blanks;
/// decimals have a point; lines that begin with # are left out. Columns have names, which are those
/// of the first line, or numbers from 1. Units stand in the first line, "angle [deg]", or in "units".
/// @param node  has the keys "file" and "columns"
/// @throws InputError with the number of the line
TableColumns read_table_file(const JsonNode& node, const std::array<Quantity, 2>& quantities,
                             const UnitSystem& units);

}  // namespace pleuel
