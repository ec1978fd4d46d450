#pragma once

#include <string>
#include <vector>

#include "cli/files/csv_file.hpp"
#include "studies/accuracy.hpp"

namespace pleuel {

/// accuracy.csv: a line for each run as it is done [SI].
class AccuracyCsv {
 public:
  AccuracyCsv(const ResultFile& file, const ProblemFile& problem);
  void add(const AccuracyRun& run);

 private:
  void add(const Eigen::VectorXd& errors);

  CsvFile csv_;
  std::size_t responses_;
};

}  // namespace pleuel
