#include "cli/files/trajectory_csv.hpp"

#include <string>

#include <fmt/format.h>

#include "cli/files/csv_file.hpp"
#include "cli/text/csv_table.hpp"
#include "core/base/error.hpp"
#include "core/response/shown_history.hpp"
#include "sensitivity/history_gradients.hpp"

namespace pleuel {

void write_trajectory(const ResultFile& file, const Analysis& analysis,
                      const std::vector<Eigen::VectorXd>& bands) {
  std::vector<std::pair<std::string, Eigen::VectorXd>> columns;
  for (std::size_t i = 0; i < analysis.responses.size(); ++i) {
    if (!analysis.responses[i].history()) continue;
    columns.emplace_back(analysis.responses[i].name,
                         shown_history(analysis.responses[i], analysis.histories[i]));
  }
  for (std::size_t i = 0; i < bands.size(); ++i) {
    if (bands[i].size() != analysis.trajectory.time.size()) continue;
    columns.emplace_back(analysis.responses[i].name + ":error", bands[i]);
  }
  write_histories(file, analysis.trajectory.time, columns);
}

void write_history_gradients(const ResultFile& file, const ProblemFile& problem,
                             Analysis& analysis) {
  std::vector<std::pair<std::string, Eigen::VectorXd>> columns;
  for (const HistoryGradients& history : history_gradients(analysis)) {
    const std::string& name = analysis.responses[history.response].name;
    columns.emplace_back(name, history.values);
    for (std::size_t j = 0; j < problem.variables.size(); ++j) {
      columns.emplace_back(name + ":" + problem.variables[j].name, history.gradients.col(j));
    }
  }
  write_histories(file, analysis.trajectory.time, columns);
}

TrajectoryBands read_bands(const std::filesystem::path& file, const Analysis& analysis) {
  CsvTable table;
  try {
    table = read_csv(file);
  } catch (const InputError& error) {
    return {{}, error.what()};
  }
  const auto fault = [&](const std::string& what) {
    return TrajectoryBands{{}, fmt::format("{}: {}", file.string(), what)};
  };
  const Eigen::VectorXd& time = analysis.trajectory.time;
  if (table.columns.front().size() != time.size()) {
    return fault(fmt::format("has {} instants, the simulation has {}", table.columns.front().size(),
                             time.size()));
  }
  TrajectoryBands found;
  found.bands.resize(analysis.responses.size());
  bool has_bands = false;
  for (std::size_t i = 0; i < analysis.responses.size(); ++i) {
    const std::string& name = analysis.responses[i].name;
    if (!analysis.responses[i].history()) continue;
    if (table.find(name) < 0) return fault(fmt::format("the column \"{}\" is missing", name));
    const int band = table.find(name + ":error");
    if (band < 0) continue;
    found.bands[i] = table.columns[band];
    has_bands = true;
  }
  if (!has_bands) found.bands.clear();
  return found;
}

}  // namespace pleuel
