#include "cli/files/gradients_csv.hpp"

#include "cli/files/csv_file.hpp"
#include "sensitivity/history_gradients.hpp"

namespace pleuel {

void write_history_gradients(const ResultFile& file, const ProblemFile& problem,
                             Analysis& analysis) {
  const std::vector<HistoryGradients> histories = history_gradients(analysis);
  std::vector<std::string> header = {"time"};
  for (const HistoryGradients& history : histories) {
    const std::string& name = analysis.responses[history.response].name;
    header.push_back(name);
    for (const DesignVariable& variable : problem.variables) {
      header.push_back(name + ":" + variable.name);
    }
  }
  CsvFile csv(file, header);
  for (Eigen::Index instant = 0; instant < analysis.trajectory.time.size(); ++instant) {
    csv.add(analysis.trajectory.time(instant));
    for (const HistoryGradients& history : histories) {
      csv.add(history.values(instant));
      for (const double entry : history.gradients.row(instant)) csv.add(entry);
    }
    csv.end_row();
  }
}

}  // namespace pleuel
