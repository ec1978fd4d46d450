#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "cli/reports/accuracy_report.hpp"
#include "cli/text/wrapped_text.hpp"
#include "core/base/number_text.hpp"
#include "core/scene/shown_unit.hpp"

namespace pleuel {

namespace {

/// Milliseconds against percent.
constexpr double ms = 1e3, hundred = 100.0;

/// A fitted order below this is none.
constexpr double disorder = 0.3;

/// What a chart shows of a run.
struct Measure {
  const char* what;
  const char* work;
  Eigen::VectorXd AccuracyRun::*errors;
  double (*seconds)(const AccuracyRun& run);
};

const Measure of_values{"responses", "simulation", &AccuracyRun::errors,
                        [](const AccuracyRun& run) { return run.simulation_seconds; }};
const Measure of_gradients{"gradients", "simulation with gradients", &AccuracyRun::gradient_errors,
                           [](const AccuracyRun& run) { return run.seconds(); }};

std::string step_text(const Discretization& settings) {
  return fmt::format("{:.4g} ms", 1e3 * settings.step);
}

ChartPoint point_of(const AccuracyStudy& study, const AccuracyRun& run, const Measure& measure,
                    const std::string& name) {
  ChartPoint point;
  point.name = name;
  point.has_failed = run.has_failed();
  if (run.has_failed()) {
    point.name += ": " + run.failure;
    return point;
  }
  point.x = hundred * study.counted_error(run.*measure.errors);
  point.y = ms * measure.seconds(run);
  point.name += fmt::format(": {:.2g} %, {}", point.x, milliseconds(measure.seconds(run)));
  return point;
}

ChartSeries& series_named(const std::string& name, std::vector<ChartSeries>& all) {
  const auto found =
      std::ranges::find_if(all, [&](const ChartSeries& one) { return one.name == name; });
  if (found != all.end()) return *found;
  all.push_back({name, {}});
  return all.back();
}

/// A joined row for each number of elements, a mark for each knob.
std::vector<ChartSeries> series_of(const AccuracyStudy& study, const Measure& measure) {
  std::vector<ChartSeries> all;
  for (const AccuracyRun& run : study.runs) {
    ChartSeries& series = series_named(division_text(run.settings), all);
    series.is_joined = true;
    series.points.push_back(point_of(study, run, measure, setting_text(run.settings)));
    series.points.back().label = step_text(run.settings);
  }
  for (const VariedRun& one : study.knobs) {
    series_named(words_of(one.variation.knob), all)
        .points.push_back(point_of(study, one.run, measure, variation_text(one.variation)));
  }
  return all;
}

std::string order_text(const AccuracyStudy& study, const Measure& measure) {
  const std::optional<double> order = fitted_order(study, measure.errors);
  if (!order) return "No order could be fitted.";
  if (*order < disorder) return "Errors do not fall with the step in order.";
  return fmt::format("Fitted order of the error in the step: {:.1f}.", *order);
}

/// "what is minimized or limited", "gradients of what is minimized or limited", "gradients"
std::string counted_text(const ProblemFile& problem, const AccuracyStudy& study,
                         const std::string& what) {
  if (study.counted.size() == problem.responses.size()) return what;
  const std::string counted = "what is minimized or limited";
  return what == "responses" ? counted : what + " of " + counted;
}

LogLogChart study_chart(const ProblemFile& problem, const AccuracyStudy& study,
                        const Measure& measure) {
  LogLogChart chart;
  chart.title = fmt::format("{}: what accurate {} cost", problem.name, measure.what);
  chart.notes = {order_text(study, measure)};
  if (!study.knobs.empty()) {
    chart.notes.front() +=
        fmt::format(" Other knobs at {}.", setting_text(study.runs[*study.base].settings));
  }
  chart.x_label =
      fmt::format("largest relative error of {} [%]", counted_text(problem, study, measure.what));
  chart.y_label = fmt::format("processor time of a {} [ms]", measure.work);
  chart.series = series_of(study, measure);
  const double floor = study.counted_error(study.reference.*measure.errors);
  if (floor > 0.0) chart.floor = hundred * floor;
  chart.floor_name = "error of the reference";
  return chart;
}

}  // namespace

LogLogChart value_chart(const ProblemFile& problem, const AccuracyStudy& study) {
  return study_chart(problem, study, of_values);
}

LogLogChart gradient_chart(const ProblemFile& problem, const AccuracyStudy& study) {
  return study_chart(problem, study, of_gradients);
}

LogLogChart optimum_chart(const ProblemFile& problem, const OptimumStudy& optima) {
  const ResponseSettings& objective = find_response(problem, problem.objective->response);
  const ShownUnit unit = unit_of(objective);
  LogLogChart chart;
  chart.title = fmt::format("{}: what an accurate optimum costs", problem.name);
  chart.notes = {fmt::format("Each mark is a whole optimization; the optimum is {} {}.",
                             significant(unit.shown(optima.reference.objective), 5), unit.name)};
  chart.x_label = fmt::format("relative error of the optimum of {} [%]", objective.name);
  chart.y_label = "processor time of an optimization [s]";
  for (const OptimumRun& run : optima.runs) {
    ChartPoint point{hundred * optima.relative_error(run), run.seconds, setting_text(run.settings),
                     step_text(run.settings), run.has_failed()};
    point.name += run.has_failed() ? ": " + run.failure
                                   : fmt::format(": {}, {}, {}", change_text(objective, run.change),
                                                 duration(run.seconds), to_string(run.status));
    ChartSeries& series = series_named(division_text(run.settings), chart.series);
    series.is_joined = true;
    series.points.push_back(std::move(point));
  }
  if (optima.relative_floor() > 0.0) chart.floor = hundred * optima.relative_floor();
  chart.floor_name = "error of the reference";
  return chart;
}

}  // namespace pleuel
