#include "cli/trajectory_csv.hpp"

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

#include "cli/csv_file.hpp"
#include "core/response/shown_history.hpp"

namespace pleuel {

void write_trajectory(const ResultFile& file, const Analysis& analysis,
                      const std::vector<Eigen::VectorXd>& bands) {
  std::vector<std::string> header = {"time"};
  std::vector<Eigen::VectorXd> columns = {analysis.trajectory.time};
  for (std::size_t i = 0; i < analysis.responses.size(); ++i) {
    if (!analysis.responses[i].history()) continue;
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

std::vector<Eigen::VectorXd> read_bands(const std::filesystem::path& file,
                                        const Analysis& analysis) {
  std::ifstream stream(file);
  std::string line;
  if (!std::getline(stream, line)) return {};
  std::vector<std::size_t> shown;  // the responses with histories, whose columns come in this order
  for (std::size_t i = 0; i < analysis.responses.size(); ++i) {
    if (analysis.responses[i].history()) shown.push_back(i);
  }
  const Eigen::Index instants = analysis.trajectory.time.size();
  std::vector<Eigen::VectorXd> bands(analysis.responses.size());
  for (const std::size_t i : shown) bands[i].resize(instants);
  for (Eigen::Index row = 0; row < instants; ++row) {
    if (!std::getline(stream, line)) return {};
    std::istringstream cells(line);
    std::string cell;
    std::vector<double> numbers;
    while (std::getline(cells, cell, ',')) numbers.push_back(std::strtod(cell.c_str(), nullptr));
    if (numbers.size() != 1 + 2 * shown.size()) return {};
    for (std::size_t k = 0; k < shown.size(); ++k) {
      bands[shown[k]](row) = numbers[1 + shown.size() + k];
    }
  }
  return bands;
}

}  // namespace pleuel
