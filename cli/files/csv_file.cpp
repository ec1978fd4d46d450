#include "cli/files/csv_file.hpp"

#include <utility>

#include <fmt/format.h>

namespace pleuel {

namespace {

std::string text_cell(const std::string& text) {
  const bool is_formula = text.find_first_of("=+-@\t") == 0;
  const std::string cell = is_formula ? "'" + text : text;
  if (cell.find_first_of(",\"\r\n") == std::string::npos) return cell;
  std::string quoted = "\"";
  for (const char c : cell) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + '"';
}

std::string cell_of(const Json& value) {
  if (value.is_null()) return "";
  if (value.is_string()) return text_cell(value.get_ref<const std::string&>());
  return value.is_number_float() ? fmt::format("{}", value.get<double>()) : value.dump();
}

std::vector<std::string> titles_of(const std::vector<CsvColumn>& columns) {
  std::vector<std::string> titles;
  for (const CsvColumn& column : columns) titles.push_back(column.title);
  return titles;
}

}  // namespace

CsvFile::CsvFile(const ResultFile& file, const std::vector<std::string>& header) : file_(file) {
  for (const std::string& title : header) add(title);
  end_row();
}

CsvFile& CsvFile::add(const Json& value) {
  if (is_row_begun_) row_ += ',';
  is_row_begun_ = true;
  row_ += cell_of(value);
  return *this;
}

void CsvFile::end_row() {
  file_.write(row_ + "\n");
  row_.clear();
  is_row_begun_ = false;
}

DocumentCsv::DocumentCsv(const ResultFile& file, std::vector<CsvColumn> columns)
    : columns_(std::move(columns)), csv_(file, titles_of(columns_)) {}

void DocumentCsv::add(const Json& entry) {
  for (const CsvColumn& column : columns_) {
    csv_.add(entry.contains(column.place) ? entry.at(column.place) : Json());
  }
  csv_.end_row();
}

void write_histories(const ResultFile& file, const Eigen::VectorXd& time,
                     const std::vector<std::pair<std::string, Eigen::VectorXd>>& columns) {
  std::vector<std::string> header = {"time"};
  for (const auto& [name, values] : columns) header.push_back(name);
  CsvFile csv(file, header);
  for (Eigen::Index i = 0; i < time.size(); ++i) {
    csv.add(time(i));
    for (const auto& [name, values] : columns) csv.add(values(i));
    csv.end_row();
  }
}

}  // namespace pleuel
