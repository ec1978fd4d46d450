#include "cli/csv_file.hpp"

#include <fmt/format.h>

#include "core/base/error.hpp"

namespace pleuel {

CsvFile::CsvFile(const std::filesystem::path& path, const std::vector<std::string>& header)
    : stream_(path) {
  if (!stream_) throw InputError(fmt::format("{} cannot be written", path.string()));
  for (const std::string& title : header) add(title);
  end_row();
}

CsvFile& CsvFile::add(double value) {
  separate();
  stream_ << fmt::format("{}", value);
  return *this;
}

CsvFile& CsvFile::add(int value) {
  separate();
  stream_ << value;
  return *this;
}

CsvFile& CsvFile::add(const std::string& text) {
  separate();
  if (text.find_first_of(",\"\r\n") == std::string::npos) {
    stream_ << text;
    return *this;
  }
  stream_ << '"';
  for (const char c : text) stream_ << (c == '"' ? "\"\"" : std::string(1, c));
  stream_ << '"';
  return *this;
}

void CsvFile::end_row() {
  stream_ << '\n' << std::flush;
  is_row_begun_ = false;
}

void CsvFile::separate() {
  if (is_row_begun_) stream_ << ',';
  is_row_begun_ = true;
}

}  // namespace pleuel
