#include "cli/reports/analysis_report.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "cli/text/table.hpp"
#include "core/base/number_text.hpp"
#include "core/response/peak_place.hpp"
#include "core/scene/shown_unit.hpp"

namespace pleuel {

namespace {

Json peak_document(const Peak& peak) {
  Json document = {{"time", peak.time}, {"place", peak.place}};
  if (peak.share) document["share"] = *peak.share;
  return document;
}

/// "0.1176 s, 0.42 of the length"
std::string peak_text(const std::optional<Peak>& peak) {
  if (!peak) return "";
  const std::string time = fmt::format("{:.4g} s", peak->time);
  return peak->share ? fmt::format("{}, {:.2g} of the length", time, *peak->share) : time;
}

bool has_peaks(const Analysis& analysis) {
  return std::ranges::any_of(analysis.responses,
                             [](const Response& response) { return response.is_peak_over_time(); });
}

}  // namespace

Json responses_document(const ProblemFile& problem, const Analysis& analysis,
                        const ErrorBars& errors) {
  Json document = Json::object();
  for (std::size_t i = 0; i < analysis.responses.size(); ++i) {
    const Response& response = analysis.responses[i];
    document[response.name] = {{"value", analysis.reductions[i].value}, {"unit", response.unit}};
    if (!errors.empty()) document[response.name]["error"] = error_document(error_of(errors, i));
    if (const auto peak = find_peak(problem, analysis, i)) {
      document[response.name]["peak"] = peak_document(*peak);
    }
  }
  return document;
}

double size_of(const Model& model) {
  const auto moves = [](const BodyModel& body) { return body.frame.translations() > 0; };
  const auto body = std::ranges::find_if(model.bodies, moves);
  return body == model.bodies.end() ? 0.0 : model.mechanism.scale(body->frame.offset);
}

double without_round_off(const Analysis& analysis, std::size_t response) {
  constexpr double round_off = 1e-14;
  const Response& of = analysis.responses[response];
  const double value = analysis.reductions[response].value;
  if (!of.history()) return value;
  double least = round_off * analysis.histories[response].lpNorm<Eigen::Infinity>();
  if (of.is_reduced_by(OverTime::integral)) least *= analysis.trajectory.time.maxCoeff();
  if (of.unit == "m") least = std::max(least, round_off * size_of(analysis.model));
  return std::abs(value) < least ? 0.0 : value;
}

std::string responses_text(const ProblemFile& problem, const Analysis& analysis,
                           const ErrorBars& errors) {
  std::vector<Table::Column> columns = {left_aligned("response"), "value", left_aligned("unit")};
  if (!errors.empty()) columns.push_back(left_aligned("error"));
  if (has_peaks(analysis)) columns.push_back(left_aligned("peak at"));
  Table table(columns);
  for (std::size_t i = 0; i < analysis.responses.size(); ++i) {
    const ShownUnit unit = unit_of(problem.responses[i]);
    const double value = without_round_off(analysis, i);
    std::vector<std::string> row = {analysis.responses[i].name, significant(unit.shown(value)),
                                    unit.name};
    if (!errors.empty()) row.push_back(error_text(error_document(error_of(errors, i)), unit));
    if (has_peaks(analysis)) {
      row.push_back(value == 0.0 ? "" : peak_text(find_peak(problem, analysis, i)));
    }
    table.add_row(std::move(row));
  }
  return table.is_empty() ? "  The file asks for no responses.\n" : table.text();
}

Json monitors_document(const Monitors& monitors) {
  return {{"position_drift", monitors.position_drift},
          {"velocity_drift", monitors.velocity_drift},
          {"energy_error", monitors.energy_error},
          {"elastic_energy_error", monitors.elastic_energy_error},
          {"elastic_rotation", monitors.elastic_rotation}};
}

std::string monitors_text(const Monitors& monitors, int multipliers) {
  std::string text;
  if (multipliers > 0) {
    text =
        fmt::format("Joints and drives are kept to {} m or rad, their rates to {} m/s or rad/s.\n",
                    magnitude(monitors.position_drift), magnitude(monitors.velocity_drift));
  }
  return text + fmt::format("Energy is balanced to {} of the largest energy in the motion.\n",
                            magnitude(monitors.energy_error));
}

std::string size_text(const Analysis& analysis) {
  const System& system = *analysis.model.mechanism.system;
  return fmt::format("{} steps of {:.4g} s, {} coordinates, {} multipliers",
                     analysis.trajectory.steps(), analysis.trajectory.scheme.step,
                     system.coordinates(), system.multipliers());
}

}  // namespace pleuel
