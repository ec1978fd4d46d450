#pragma once

#include <utility>

#include "cli/files/output_file.hpp"
#include "cli/text/json.hpp"
#include "core/response/analysis.hpp"
#include "optimization/design/design_problem.hpp"
#include "optimization/result.hpp"

namespace pleuel {

/// Comma-separated values (RFC 4180), written line by line: whoever kills the run keeps them.
/// Spreadsheets run texts that begin with = + - or @ as formulas: such a text begins with an
/// apostrophe here.
class CsvFile {
 public:
  using Row = std::vector<Json>;
  CsvFile(const ResultFile& file, const Row& titles) : file_(file) { add(titles); }

  /// Numbers as the shortest text that reads back exactly; of null an empty cell.
  void add(const Row& cells);

 private:
  OutputFile file_;
};

/// A column whose cells stand at this place in entries of a document.
struct CsvColumn {
  std::string title;
  Json::json_pointer place;
};

/// Columns that are called as the last keys of their places.
std::vector<CsvColumn> columns_at(std::initializer_list<const char*> places);

/// Lines that are entries of a document; what an entry does not have is an empty cell.
class DocumentCsv {
 public:
  DocumentCsv(const ResultFile& file, std::vector<CsvColumn> columns)
      : columns_(std::move(columns)),
        csv_(file, list_of(columns_, &CsvColumn::title).get<CsvFile::Row>()) {}
  void add(const Json& entry);

 private:
  std::vector<CsvColumn> columns_;
  CsvFile csv_;
};

/// A line for each instant: time, and columns of as many numbers.
void write_histories(const ResultFile& file, const Eigen::VectorXd& time,
                     const std::vector<std::pair<std::string, Eigen::VectorXd>>& columns);

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

/// One line an instant: time, then each response's history (core/response/history_reduction.hpp) [SI],
/// and `NAME:error`, the half-width of its error band.
/// @param bands  one a response; those that are empty are left out, as are all of none
void write_trajectory(const ResultFile& file, const Analysis& analysis,
                      const std::vector<Eigen::VectorXd>& bands = {});

/// One line an instant: time, then each response's history and its derivatives with respect to all
/// variables, at the place where the response is taken [SI].
/// @throws SimulationError
void write_history_gradients(const ResultFile& file, const ProblemFile& problem,
                             Analysis& analysis);

/// What such a file of the same simulation says of the bands.
struct TrajectoryBands {
  std::vector<Eigen::VectorXd> bands;  ///< one a response; empty: the file has none
  std::string fault;                   ///< what is wrong with the file; empty: nothing
};

TrajectoryBands read_bands(const std::filesystem::path& file, const Analysis& analysis);

// What a history is beside the number that is made from it.

/// The unit of the history of a response: that of the number, but for an integral over time.
inline ShownUnit history_unit(const ResponseSettings& response) {
  if (response.over_time != OverTime::integral) return unit_of(response);
  ResponseSettings instant = response;
  instant.over_time = OverTime::max;
  instant.unit.clear();
  return unit_of(instant);
}

/// Whether a limit on the number is one on each instant of its history: so of peaks, but not of what
/// cycles of stress, a mean or an integral make of the history.
inline bool limits_each_instant(const ResponseSettings& response) {
  const bool is_peak = response.over_time == OverTime::max || response.over_time == OverTime::min ||
                       response.over_time == OverTime::max_abs;
  return is_peak && !response.is<FatigueResponse>();
}

}  // namespace pleuel
