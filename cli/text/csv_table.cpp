#include "cli/text/csv_table.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>

#include <fmt/format.h>

#include "core/base/error.hpp"

namespace pleuel {

namespace {

/// Cells of a line, RFC 4180. An apostrophe before a sign of a formula is not part of a name.
std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  bool is_quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"' && is_quoted && i + 1 < line.size() && line[i + 1] == '"') {
      cells.back() += line[++i];
    } else if (c == '"') {
      is_quoted = !is_quoted;
    } else if (c == ',' && !is_quoted) {
      cells.emplace_back();
    } else if (c != '\r') {
      cells.back() += c;
    }
  }
  for (std::string& cell : cells) {
    const bool is_guarded =
        cell.size() > 1 && cell[0] == '\'' && std::string("=+-@\t").find(cell[1]) != cell.npos;
    if (is_guarded) cell.erase(0, 1);
  }
  return cells;
}

double number_of(const std::string& cell) {
  char* end = nullptr;
  const double number = std::strtod(cell.c_str(), &end);
  return cell.empty() || *end != '\0' ? std::nan("") : number;
}

}  // namespace

int CsvTable::find(const std::string& name) const {
  const auto found = std::ranges::find(names, name);
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

CsvTable read_csv(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string line;
  if (!stream) throw InputError(file.string() + ": cannot be read");
  if (!std::getline(stream, line)) throw InputError(file.string() + ": is empty");
  CsvTable table;
  table.names = cells_of(line);
  std::vector<std::vector<double>> columns(table.names.size());
  for (int number = 2; std::getline(stream, line); ++number) {
    const std::vector<std::string> cells = cells_of(line);
    if (cells.size() != columns.size()) {
      throw InputError(fmt::format("{}: is damaged: line {} has {} of {} columns", file.string(),
                                   number, cells.size(), columns.size()));
    }
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const double value = number_of(cells[i]);
      if (!std::isfinite(value)) {
        throw InputError(fmt::format("{}: is damaged: line {} has no number in the column \"{}\"",
                                     file.string(), number, table.names[i]));
      }
      columns[i].push_back(value);
    }
  }
  for (const std::vector<double>& column : columns) {
    table.columns.emplace_back(Eigen::Map<const Eigen::VectorXd>(column.data(), column.size()));
  }
  return table;
}

}  // namespace pleuel
