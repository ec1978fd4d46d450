#pragma once

#include "cli/files/csv_file.hpp"
#include "optimization/history.hpp"
#include "optimization/problem.hpp"

namespace pleuel {

/// "values" or "gradients"
std::string to_string(Request request);

/// history.csv: a line for every evaluation as it happens [SI].
class HistoryCsv {
 public:
  HistoryCsv(const ResultFile& file, const Problem& problem);
  void add(const EvaluationRecord& record);

 private:
  std::size_t constraints_;
  CsvFile csv_;
};

}  // namespace pleuel
