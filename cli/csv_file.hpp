#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace pleuel {

/// Comma-separated values (RFC 4180), each line flushed: whoever kills the run keeps them.
class CsvFile {
 public:
  /// @throws InputError if the file cannot be written
  CsvFile(const std::filesystem::path& path, const std::vector<std::string>& header);

  CsvFile& add(double value);  ///< shortest text that reads back exactly
  CsvFile& add(int value);
  CsvFile& add(const std::string& text);
  void end_row();

 private:
  void separate();

  std::ofstream stream_;
  bool is_row_begun_ = false;
};

}  // namespace pleuel
