#include "cli/files/csv_file.hpp"

#include <string>
#include <utility>

#include <fmt/format.h>

#include "cli/text/csv_table.hpp"
#include "core/base/error.hpp"
#include "core/response/history_reduction.hpp"
#include "sensitivity/history_gradients.hpp"

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

std::vector<std::string> titles_of(const std::vector<CsvColumn>& columns) {
  std::vector<std::string> titles;
  for (const CsvColumn& column : columns) titles.push_back(column.title);
  return titles;
}

}  // namespace

CsvFile::CsvFile(const ResultFile& file, const std::vector<std::string>& header) : file_(file) {
  for (const std::string& title : header) add(title);
  end_row();
}

CsvFile& CsvFile::add(const Json& value) {
  if (is_row_begun_) row_ += ',';
  is_row_begun_ = true;
  row_ += cell_of(value);
  return *this;
}

void CsvFile::end_row() {
  file_.write(row_ + "\n");
  row_.clear();
  is_row_begun_ = false;
}

DocumentCsv::DocumentCsv(const ResultFile& file, std::vector<CsvColumn> columns)
    : columns_(std::move(columns)), csv_(file, titles_of(columns_)) {}

void DocumentCsv::add(const Json& entry) {
  for (const CsvColumn& column : columns_) {
    csv_.add(entry.contains(column.place) ? entry.at(column.place) : Json());
  }
  csv_.end_row();
}

void write_histories(const ResultFile& file, const Eigen::VectorXd& time,
                     const std::vector<std::pair<std::string, Eigen::VectorXd>>& columns) {
  std::vector<std::string> header = {"time"};
  for (const auto& [name, values] : columns) header.push_back(name);
  CsvFile csv(file, header);
  for (Eigen::Index i = 0; i < time.size(); ++i) {
    csv.add(time(i));
    for (const auto& [name, values] : columns) csv.add(values(i));
    csv.end_row();
  }
}

namespace {

std::vector<std::string> header(const Problem& problem) {
  std::vector<std::string> titles = {"evaluation", "iteration",     "seconds", "purpose",
                                     "request",    "max_violation", "step",    "objective"};
  for (const Constraint& constraint : problem.constraints()) {
    titles.push_back("constraint:" + constraint.name);
  }
  for (const Variable& variable : problem.variables()) {
    titles.push_back("variable:" + variable.name);
  }
  titles.insert(titles.end(), {"time_step", "elements", "failure"});
  return titles;
}

}  // namespace

std::string to_string(Request request) {
  return request == Request::values ? "values" : "gradients";
}

HistoryCsv::HistoryCsv(const ResultFile& file, const DesignProblem& problem)
    : constraints_(problem.constraints().size()),
      objective_sign_(problem.objective_sign()),
      csv_(file, header(problem)) {}

void HistoryCsv::add(const EvaluationRecord& record) {
  const bool has_failed = record.has_failed();
  const auto add_value = [&](double value) {
    has_failed ? csv_.add(std::string()) : csv_.add(value);
  };
  csv_.add(record.evaluation).add(record.iteration).add(record.seconds);
  csv_.add(to_string(record.purpose)).add(to_string(record.request));
  add_value(record.max_violation);
  csv_.add(record.step);
  add_value(objective_sign_ * record.objective);
  for (std::size_t i = 0; i < constraints_; ++i) {
    add_value(has_failed ? 0.0 : record.constraints(i));
  }
  for (const double value : record.x) csv_.add(value);
  csv_.add(record.time_step).add(record.elements).add(record.failure);
  csv_.end_row();
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
