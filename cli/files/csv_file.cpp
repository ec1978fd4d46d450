#include "cli/files/csv_file.hpp"

#include <fmt/format.h>

namespace pleuel {

CsvFile::CsvFile(const ResultFile& file, const std::vector<std::string>& header) : file_(file) {
  for (const std::string& title : header) add(title);
  end_row();
}

CsvFile& CsvFile::add(double value) {
  separate();
  row_ += fmt::format("{}", value);
  return *this;
}

CsvFile& CsvFile::add(int value) {
  separate();
  row_ += std::to_string(value);
  return *this;
}

CsvFile& CsvFile::add(const std::string& text) {
  separate();
  const bool is_formula = text.find_first_of("=+-@\t") == 0;
  const std::string cell = is_formula ? "'" + text : text;
  if (cell.find_first_of(",\"\r\n") == std::string::npos) {
    row_ += cell;
    return *this;
  }
  row_ += '"';
  for (const char c : cell) row_ += c == '"' ? "\"\"" : std::string(1, c);
  row_ += '"';
  return *this;
}

void CsvFile::end_row() {
  file_.write(row_ + "\n");
  row_.clear();
  is_row_begun_ = false;
}

void CsvFile::separate() {
  if (is_row_begun_) row_ += ',';
  is_row_begun_ = true;
}

}  // namespace pleuel
