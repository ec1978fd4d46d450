#include "cli/trajectory_csv.hpp"

#include "cli/csv_file.hpp"

namespace pleuel {

void write_trajectory(const std::filesystem::path& path, const Analysis& analysis) {
  std::vector<std::string> header = {"time"};
  std::vector<Eigen::VectorXd> columns = {analysis.trajectory.time};
  for (std::size_t i = 0; i < analysis.responses.size(); ++i) {
    if (!analysis.responses[i].signal) continue;
    header.push_back(analysis.responses[i].name);
    columns.emplace_back(analysis.histories[i].colwise().maxCoeff().transpose());
  }
  CsvFile csv(path, header);
  for (Eigen::Index instant = 0; instant < columns.front().size(); ++instant) {
    for (const Eigen::VectorXd& column : columns) csv.add(column(instant));
    csv.end_row();
  }
}

}  // namespace pleuel
