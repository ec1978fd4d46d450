#pragma once

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace pleuel {

/// The root of the checkout that the tests were built from. A function of one file, so that all other
/// files of tests are compiled alike wherever the checkout stands (ccache).
std::string source_folder();

}  // namespace pleuel

namespace pleuel::test {

/// An empty folder that goes with the object, and that no test run beside this one shares.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "pleuel-test-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code error;
    std::filesystem::remove_all(path_, error);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

using CsvRows = std::vector<std::vector<std::string>>;

/// Comma-separated values by RFC 4180: cells in quotes hold commas, line breaks, and quotes as two.
inline CsvRows parse_csv(const std::string& text) {
  CsvRows rows;
  std::string cell;
  bool is_quoted = false, has_row = false;
  const auto end_cell = [&] {
    if (!has_row) rows.emplace_back();
    has_row = true;
    rows.back().push_back(cell);
    cell.clear();
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (is_quoted) {
      if (c != '"') {
        cell += c;
      } else if (i + 1 < text.size() && text[i + 1] == '"') {
        cell += text[++i];
      } else {
        is_quoted = false;
      }
    } else if (c == '"') {
      is_quoted = true;
    } else if (c == ',') {
      end_cell();
    } else if (c == '\n') {
      end_cell();
      has_row = false;
    } else {
      cell += c;
    }
  }
  return rows;
}

}  // namespace pleuel::test
