#include "cli/trajectory_csv.hpp"

#include "cli/csv_file.hpp"

namespace pleuel {

Eigen::VectorXd largest_channel(const Response& response, const Eigen::MatrixXd& history) {
  const bool by_magnitude = response.over_time == OverTime::max_abs && history.rows() > 1;
  if (by_magnitude) return history.cwiseAbs().colwise().maxCoeff().transpose();
  return history.colwise().maxCoeff().transpose();
}

void write_trajectory(const ResultFile& file, const Analysis& analysis) {
  std::vector<std::string> header = {"time"};
  std::vector<Eigen::VectorXd> columns = {analysis.trajectory.time};
  for (std::size_t i = 0; i < analysis.responses.size(); ++i) {
    if (!analysis.responses[i].signal) continue;
    header.push_back(analysis.responses[i].name);
    columns.emplace_back(largest_channel(analysis.responses[i], analysis.histories[i]));
  }
  CsvFile csv(file, header);
  for (Eigen::Index instant = 0; instant < columns.front().size(); ++instant) {
    for (const Eigen::VectorXd& column : columns) csv.add(column(instant));
    csv.end_row();
  }
}

}  // namespace pleuel
