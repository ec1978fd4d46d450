#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace pleuel {

/// Columns of numbers with their names, as the program writes them (csv_file.hpp).
struct CsvTable {
  std::vector<std::string> names;
  std::vector<Eigen::VectorXd> columns;

  /// Index of a column; −1 if there is none.
  int find(const std::string& name) const;
};

/// @throws InputError that says what is wrong with the file, and in which line
CsvTable read_csv(const std::filesystem::path& file);

}  // namespace pleuel
