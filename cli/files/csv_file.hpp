#pragma once

#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "cli/files/output_file.hpp"
#include "cli/text/json.hpp"

namespace pleuel {

/// Comma-separated values (RFC 4180), written line by line: whoever kills the run keeps them.
/// Spreadsheets run texts that begin with = + - or @ as formulas: such a text begins with an
/// apostrophe here.
class CsvFile {
 public:
  CsvFile(const ResultFile& file, const std::vector<std::string>& header);

  /// Numbers as the shortest text that reads back exactly; of null an empty cell.
  CsvFile& add(const Json& value);
  void end_row();

 private:
  OutputFile file_;
  std::string row_;
  bool is_row_begun_ = false;
};

/// A column whose cells stand at this place in entries of a document.
struct CsvColumn {
  std::string title;
  Json::json_pointer place;
};

/// Lines that are entries of a document; what an entry does not have is an empty cell.
class DocumentCsv {
 public:
  DocumentCsv(const ResultFile& file, std::vector<CsvColumn> columns);
  void add(const Json& entry);

 private:
  std::vector<CsvColumn> columns_;
  CsvFile csv_;
};

/// A line for each instant: time, and columns of as many numbers.
void write_histories(const ResultFile& file, const Eigen::VectorXd& time,
                     const std::vector<std::pair<std::string, Eigen::VectorXd>>& columns);

}  // namespace pleuel
