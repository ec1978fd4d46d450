#include "cli/trajectory_csv.hpp"

#include "cli/csv_file.hpp"
#include "core/response/shown_history.hpp"

namespace pleuel {

void write_trajectory(const ResultFile& file, const Analysis& analysis,
                      const std::vector<Eigen::VectorXd>& bands) {
  std::vector<std::string> header = {"time"};
  std::vector<Eigen::VectorXd> columns = {analysis.trajectory.time};
  for (std::size_t i = 0; i < analysis.responses.size(); ++i) {
    if (!analysis.responses[i].signal) continue;
    header.push_back(analysis.responses[i].name);
    columns.emplace_back(shown_history(analysis.responses[i], analysis.histories[i]));
  }
  for (std::size_t i = 0; i < bands.size(); ++i) {
    if (bands[i].size() != analysis.trajectory.time.size()) continue;
    header.push_back(analysis.responses[i].name + ":error");
    columns.push_back(bands[i]);
  }
  CsvFile csv(file, header);
  for (Eigen::Index instant = 0; instant < columns.front().size(); ++instant) {
    for (const Eigen::VectorXd& column : columns) csv.add(column(instant));
    csv.end_row();
  }
}

}  // namespace pleuel
