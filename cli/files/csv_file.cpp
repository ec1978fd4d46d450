#include "cli/files/csv_file.hpp"

#include <fmt/format.h>

#include "cli/text/csv_table.hpp"
#include "core/base/error.hpp"
#include "core/response/history_reduction.hpp"
#include "record/run_database.hpp"
#include "sensitivity/gradients.hpp"

namespace pleuel {

namespace {

std::string text_cell(const std::string& text) {
  const bool is_formula = text.find_first_of("=+-@\t") == 0;
  const std::string cell = is_formula ? "'" + text : text;
  if (cell.find_first_of(",\"\r\n") == std::string::npos) return cell;
  std::string quoted = "\"";
  for (const char c : cell) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + '"';
}

std::string cell_of(const Json& value) {
  if (value.is_null()) return "";
  if (value.is_string()) return text_cell(value.get_ref<const std::string&>());
  return value.is_number_float() ? fmt::format("{}", value.get<double>()) : value.dump();
}

CsvFile::Row titles_of(const Problem& problem) {
  CsvFile::Row titles = {"evaluation", "iteration",     "seconds", "purpose",
                         "request",    "max_violation", "step",    "objective"};
  for (const Constraint& one : problem.constraints()) titles.push_back("constraint:" + one.name);
  for (const Variable& one : problem.variables()) titles.push_back("variable:" + one.name);
  titles.insert(titles.end(), {"time_step", "elements", "failure"});
  return titles;
}

}  // namespace

void CsvFile::add(const Row& cells) {
  std::vector<std::string> texts;
  for (const Json& cell : cells) texts.push_back(cell_of(cell));
  file_.write(fmt::format("{}\n", fmt::join(texts, ",")));
}

std::vector<CsvColumn> columns_at(std::initializer_list<const char*> places) {
  std::vector<CsvColumn> columns;
  for (const char* text : places) {
    const Json::json_pointer place(text);
    columns.push_back({place.back(), place});
  }
  return columns;
}

void DocumentCsv::add(const Json& entry) {
  CsvFile::Row row;
  for (const CsvColumn& column : columns_) row.push_back(entry.value(column.place, Json()));
  csv_.add(row);
}

void write_histories(const ResultFile& file, const Eigen::VectorXd& time,
                     const std::vector<std::pair<std::string, Eigen::VectorXd>>& columns) {
  CsvFile::Row row = {"time"};
  for (const auto& [name, values] : columns) row.push_back(name);
  CsvFile csv(file, row);
  for (Eigen::Index i = 0; i < time.size(); ++i) {
    row = {time(i)};
    for (const auto& [name, values] : columns) row.push_back(values(i));
    csv.add(row);
  }
}

HistoryCsv::HistoryCsv(const ResultFile& file, const DesignProblem& problem)
    : constraints_(problem.constraints().size()),
      objective_sign_(problem.objective_sign()),
      csv_(file, titles_of(problem)) {}

void HistoryCsv::add(const EvaluationRecord& record) {
  const auto known = [&](double value) { return record.has_failed() ? Json() : Json(value); };
  CsvFile::Row row = {record.evaluation,
                      record.iteration,
                      record.seconds,
                      to_string(record.purpose),
                      request_name(record.request),
                      known(record.max_violation),
                      record.step,
                      known(objective_sign_ * record.objective)};
  for (std::size_t i = 0; i < constraints_; ++i) {
    row.push_back(record.has_failed() ? Json() : Json(record.constraints(i)));
  }
  row.insert(row.end(), record.x.begin(), record.x.end());
  row.insert(row.end(), {record.time_step, record.elements, record.failure});
  csv_.add(row);
}

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
