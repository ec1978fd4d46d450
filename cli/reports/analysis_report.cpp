#include "cli/reports/analysis_report.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "cli/text/table.hpp"
#include "core/base/number_text.hpp"
#include "core/scene/shown_unit.hpp"

namespace pleuel {

Json responses_document(const Analysis& analysis, const ErrorBars& errors) {
  Json document = Json::object();
  for (std::size_t i = 0; i < analysis.responses.size(); ++i) {
    const Response& response = analysis.responses[i];
    document[response.name] = {{"value", analysis.reductions[i].value}, {"unit", response.unit}};
    if (!errors.empty()) document[response.name]["error"] = error_document(error_of(errors, i));
  }
  return document;
}

double size_of(const Model& model) {
  const auto moves = [](const BodyModel& body) { return body.frame.translations() > 0; };
  const auto body = std::find_if(model.bodies.begin(), model.bodies.end(), moves);
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
  std::vector<Table::Column> columns = {
      {"response", Table::Align::left}, {"value"}, {"unit", Table::Align::left}};
  if (!errors.empty()) columns.push_back({"error", Table::Align::left});
  Table table(columns);
  for (std::size_t i = 0; i < analysis.responses.size(); ++i) {
    const ShownUnit unit = unit_of(problem.responses[i]);
    table.add_row({analysis.responses[i].name,
                   significant(unit.shown(without_round_off(analysis, i))), unit.name,
                   errors.empty() ? "" : error_text(error_of(errors, i), unit)});
  }
  return table.is_empty() ? "  The file asks for no responses.\n" : table.text();
}

std::string size_text(const Analysis& analysis) {
  const System& system = *analysis.model.mechanism.system;
  return fmt::format("{} steps of {:.4g} s, {} coordinates, {} multipliers",
                     analysis.trajectory.steps(), analysis.trajectory.scheme.step,
                     system.coordinates(), system.multipliers());
}

}  // namespace pleuel
