#include <array>
#include <cctype>
#include <functional>
#include <set>

#include <fmt/ranges.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "cli/commands/commands.hpp"
#include "cli/files/output_file.hpp"
#include "cli/files/run_folder.hpp"
#include "cli/reports/optimum_document.hpp"
#include "cli/text/csv_table.hpp"
#include "cli/text/history_chart.hpp"
#include "core/base/find_named.hpp"
#include "core/scene/reading/suggestion.hpp"

/// Histories of a run as a drawing, and in the terminal.
namespace pleuel {

namespace {

/// A design whose histories the run folder has.
struct RunHistories {
  std::string design;  ///< "start", "optimum", "end"; empty of a run with one
  CsvTable table;
};

/// Files by what they begin with; of an optimization with load cases the name of the case follows.
std::vector<RunHistories> read_histories(const fs::path& folder) {
  if (!fs::is_directory(folder)) {
    throw InputError(fmt::format("{}: there is no such run folder", folder.string()));
  }
  const auto run = find_older_run(folder);
  const std::array<std::pair<std::string, std::string>, 4> known = {
      {{"trajectory-start", "start"},
       {"trajectory-optimum", name_of_end(run ? run->status() : "")},
       {"trajectory", ""},
       {"uncertainty", "mean"}}};
  std::set<fs::path, std::greater<>> files;  // the start first
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.is_regular_file() && entry.path().extension() == ".csv") files.insert(entry.path());
  }
  std::vector<RunHistories> histories;
  for (const fs::path& file : files) {
    const std::string stem = file.stem().string();
    for (const auto& [beginning, design] : known) {
      const bool is_of_case = !design.empty() && stem.starts_with(beginning + "-");
      if (stem != beginning && !is_of_case) continue;
      const std::string load_case = is_of_case ? " " + stem.substr(beginning.size() + 1) : "";
      histories.push_back({design + load_case, read_csv(file)});
    }
  }
  if (histories.empty()) {
    throw InputError(fmt::format(
        "{}: has no histories; `simulate`, `optimize`, `uncertainty` and `gradient --histories` "
        "write some",
        folder.string()));
  }
  for (const RunHistories& one : histories) {
    if (one.table.names.front() != "time" || one.table.columns.front().size() < 2) {
      throw InputError(
          fmt::format("{}: its histories are damaged: they have no time", folder.string()));
    }
  }
  return histories;
}

std::vector<std::string> known_names(const std::vector<RunHistories>& histories) {
  std::vector<std::string> names;
  for (const RunHistories& one : histories) {
    for (const std::string& name : one.table.names) {
      if (name == "time" || name.find(':') != std::string::npos) continue;
      if (std::ranges::find(names, name) == names.end()) names.push_back(name);
    }
  }
  return names;
}

/// On the history of a response, both signs where its magnitude is limited [SI].
std::vector<double> limits_on(const ProblemFile& problem, const std::string& name) {
  std::vector<double> limits;
  const ResponseSettings& response = find_response(problem, name);
  if (!limits_each_instant(response)) return limits;
  const bool has_signs = response.over_time == OverTime::max_abs && !response.is<StressResponse>();
  for (const ConstraintSettings& constraint : problem.constraints) {
    if (constraint.response != name) continue;
    if (constraint.lower) limits.push_back(*constraint.lower);
    if (constraint.upper) limits.push_back(*constraint.upper);
    if (constraint.upper && has_signs) limits.push_back(-*constraint.upper);
  }
  return limits;
}

HistoryChart chart_of(const std::vector<RunHistories>& histories,
                      const std::optional<ProblemFile>& problem, const std::string& name) {
  HistoryChart chart;
  chart.title = name;
  ShownUnit unit{"", "1", 1.0};
  if (problem && find_named(problem->responses, name) != nullptr) {
    unit = history_unit(find_response(*problem, name));
    for (const double limit : limits_on(*problem, name)) chart.limits.push_back(unit.shown(limit));
  }
  chart.unit = problem ? unit.name : "SI";
  const double end = histories.front().table.columns.front().maxCoeff();
  const double second = end < 1.0 ? 1e-3 : 1.0;
  chart.time_unit = end < 1.0 ? "ms" : "s";
  for (const RunHistories& one : histories) {
    const int column = one.table.find(name);
    if (column < 0) continue;
    HistoryCurve curve{one.design, one.table.columns.front() / second,
                       one.table.columns[column] / unit.factor};
    for (const auto& [suffix, factor] : {std::pair{":error", 1.0}, std::pair{":deviation", 2.0}}) {
      const int band = one.table.find(name + suffix);
      if (band < 0) continue;
      curve.band = factor * one.table.columns[band] / unit.factor;
    }
    chart.curves.push_back(std::move(curve));
  }
  return chart;
}

/// "start: −3.2 … 12.1 N; optimum: …"
std::string range_text(const HistoryChart& chart) {
  std::string text;
  for (const HistoryCurve& curve : chart.curves) {
    const double size = curve.values.lpNorm<Eigen::Infinity>();
    const auto number = [&](double value) {
      return std::abs(value) <= 1e-12 * size ? std::string("0") : significant(value, 4);
    };
    text +=
        fmt::format("{}{}{} … {} {}", text.empty() ? "" : "; ",
                    curve.name.empty() ? "" : curve.name + ": ", number(curve.values.minCoeff()),
                    number(curve.values.maxCoeff()), chart.unit == "1" ? "" : chart.unit);
  }
  return text + "\n";
}

/// Of the terminal, at most 100 letters.
int text_width() {
  winsize size{};
  const bool is_known = ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return std::clamp(is_known ? static_cast<int>(size.ws_col) : 80, 40, 100);
}

fs::path drawing_path(const Arguments& arguments) {
  if (arguments.output) return *arguments.output;
  if (arguments.names.size() != 1) return arguments.file / "plot.svg";
  std::string name = arguments.names.front().substr(0, 60);
  for (char& c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '_' && c != '-') c = '-';
  }
  return arguments.file / fmt::format("plot-{}.svg", name);
}

Outcome list_of(const fs::path& folder, const std::vector<std::string>& names) {
  Outcome outcome;
  outcome.document = {{"histories", names}};
  outcome.text =
      wrapped(fmt::format("Histories in {}: {}\n", folder.string(), fmt::join(names, ", ")), "  ");
  return outcome;
}

}  // namespace

Outcome run_plot(const Arguments& arguments) {
  const fs::path& folder = arguments.file;
  const std::vector<RunHistories> histories = read_histories(folder);
  const std::vector<std::string> known = known_names(histories);
  if (arguments.names.empty()) return list_of(folder, known);
  std::optional<ProblemFile> problem = problem_on_card(folder);
  // Names of histories are those of a case.
  if (problem && problem->has_cases()) problem = ProblemFile(problem->cases.front());
  Outcome outcome;
  std::vector<HistoryChart> charts;
  for (const std::string& name : arguments.names) {
    if (std::ranges::find(known, name) == known.end()) {
      throw InputError(fmt::format("{}: no history is called \"{}\"{}", folder.string(), name,
                                   hint(name, known)));
    }
    charts.push_back(chart_of(histories, problem, name));
    outcome.text += to_braille(charts.back(), text_width()) + range_text(charts.back()) + "\n";
  }
  if (!problem) {
    outcome.text += "Units and limits are not known: the problem of the run card cannot be read.\n";
  }
  const fs::path drawing = drawing_path(arguments);
  if (arguments.output) require_free(drawing, arguments);
  outcome.document = {{"histories", arguments.names}};
  if (write_file({drawing, &outcome.unwritten}, to_svg(charts))) {
    outcome.document["drawing"] = drawing.string();
    outcome.text += fmt::format("Drawn in {}\n", drawing.string());
  }
  return outcome;
}

}  // namespace pleuel
