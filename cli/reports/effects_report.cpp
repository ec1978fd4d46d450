#include "cli/reports/effects_report.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "cli/text/table.hpp"
#include "core/base/number_text.hpp"
#include "core/scene/shown_unit.hpp"

namespace pleuel {

namespace {

const char* kind_of(const EffectRecord& effect) {
  switch (effect.kind) {
    case EffectRecord::Kind::exact:
      return "exact";
    case EffectRecord::Kind::estimated:
      return "estimated";
    case EffectRecord::Kind::measured:
      return "measured";
    default:
      return "forced";
  }
}

void add_influence(const ProblemFile& problem, const EffectInfluence& influence, Json& entry) {
  if (!influence.failure.empty()) {
    entry["influence"] = nullptr;
    entry["failure"] = influence.failure;
    return;
  }
  entry["influence"] = Json::object();
  for (std::size_t i = 0; i < problem.responses.size(); ++i) {
    const double change = influence.changes(i);
    entry["influence"][problem.responses[i].name] = change;
  }
  entry["seconds"] = influence.seconds;
}

std::string signed_text(double value) {
  if (value == 0.0) return "0";
  return (value < 0.0 ? "−" : "+") + significant(std::abs(value), 2);
}

/// Whole percents: times of single runs are not known better.
std::string percent_text(double share) {
  const double percents = std::round(100.0 * share);
  return percents == 0.0 ? "0 %"
                         : fmt::format("{}{} %", percents < 0.0 ? "−" : "+", std::abs(percents));
}

/// "rod_bow −0.0012 mm (−0.6 %)": the largest relative change.
std::string largest_change_text(const ProblemFile& problem, const Eigen::VectorXd& values,
                                const EffectInfluence& influence) {
  Eigen::Index largest = -1;
  double most = 1e-8;  // below: round-off
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    const double relative = std::abs(influence.changes(i)) / std::abs(values(i));
    if (values(i) == 0.0 || !(relative > most)) continue;
    most = relative;
    largest = i;
  }
  if (largest < 0) return "nothing";
  const ResponseSettings& response = problem.responses[largest];
  const ShownUnit unit = unit_of(response);
  const double change = influence.changes(largest);
  return fmt::format("{} {} {} ({} %)", response.name, signed_text(unit.shown(change)), unit.name,
                     signed_text(100.0 * change / std::abs(values(largest))));
}

}  // namespace

Json effects_document(const ProblemFile& problem, const Model& model,
                      const std::vector<EffectInfluence>& influences) {
  Json document = Json::array();
  for (const EffectRecord& effect : model.effects) {
    Json entry = {{"name", effect.name},
                  {"built", effect.is_built},
                  {"decision", kind_of(effect)},
                  {"reason", effect.reason}};
    if (!effect.body.empty()) entry["body"] = effect.body;
    if (effect.estimate && std::isfinite(*effect.estimate)) entry["estimate"] = *effect.estimate;
    if (effect.coordinates_saved > 0) entry["coordinates_saved"] = effect.coordinates_saved;
    const auto influence =
        std::find_if(influences.begin(), influences.end(), [&](const EffectInfluence& one) {
          return one.body == effect.body && one.effect == effect.name;
        });
    if (influence != influences.end()) add_influence(problem, *influence, entry);
    document.push_back(std::move(entry));
  }
  return document;
}

std::string effects_text(const Model& model) {
  Table table({{"effect", Table::Align::left},
               {"of", Table::Align::left},
               {"built", Table::Align::left},
               {"decision", Table::Align::left},
               {"saves"},
               {"because", Table::Align::left}});
  for (const EffectRecord& effect : model.effects) {
    table.add_row({effect.name, effect.body.empty() ? "–" : effect.body,
                   effect.is_built ? "yes" : "no", kind_of(effect),
                   effect.coordinates_saved > 0 ? std::to_string(effect.coordinates_saved) : "–",
                   effect.reason});
  }
  return table.text();
}

std::string influences_text(const ProblemFile& problem, const Eigen::VectorXd& values,
                            const std::vector<EffectInfluence>& influences,
                            const PriceOfChanges& price) {
  if (influences.empty()) return "";
  std::vector<Table::Column> columns = {
      {"without", Table::Align::left}, {"of", Table::Align::left}, {"time"}};
  if (price) columns.push_back({"optimum"});
  columns.push_back({"largest change of a response", Table::Align::left});
  Table table(columns);
  for (const EffectInfluence& one : influences) {
    std::vector<std::string> row = {one.effect, one.body};
    if (!one.failure.empty()) {
      row.push_back("–");
      if (price) row.push_back("–");
      row.push_back(one.failure);
    } else {
      row.push_back(percent_text(-one.share));
      if (price) {
        const ShownUnit unit = unit_of(find_response(problem, problem.objective->response));
        row.push_back(signed_text(unit.shown(price(one.changes))) + " " + unit.name);
      }
      row.push_back(largest_change_text(problem, values, one));
    }
    table.add_row(std::move(row));
  }
  return "\n" + table.text() + "\n";
}

}  // namespace pleuel
