#pragma once

#include "cli/files/csv_file.hpp"
#include "optimization/design/design_problem.hpp"
#include "optimization/history.hpp"

namespace pleuel {

/// "values" or "gradients"
std::string to_string(Request request);

/// history.csv: a line for every evaluation as it happens [SI].
class HistoryCsv {
 public:
  HistoryCsv(const ResultFile& file, const DesignProblem& problem);
  void add(const EvaluationRecord& record);

 private:
  std::size_t constraints_;
  double objective_sign_;
  CsvFile csv_;
};

}  // namespace pleuel
