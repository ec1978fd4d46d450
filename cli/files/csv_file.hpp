#pragma once

#include <string>
#include <vector>

#include "cli/files/output_file.hpp"

namespace pleuel {

/// Comma-separated values (RFC 4180), written line by line: whoever kills the run keeps them.
/// Spreadsheets run texts that begin with = + - or @ as formulas: such a text begins with an
/// apostrophe here.
class CsvFile {
 public:
  CsvFile(const ResultFile& file, const std::vector<std::string>& header);

  CsvFile& add(double value);  ///< shortest text that reads back exactly
  CsvFile& add(int value);
  CsvFile& add(const std::string& text);
  void end_row();

 private:
  void separate();

  OutputFile file_;
  std::string row_;
  bool is_row_begun_ = false;
};

}  // namespace pleuel
