#include "cli/reports/effects_report.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "cli/reports/time_text.hpp"
#include "cli/text/table.hpp"
#include "cli/text/wrapped_text.hpp"
#include "core/base/find_named.hpp"
#include "core/base/number_text.hpp"
#include "core/scene/shown_unit.hpp"

namespace pleuel {

namespace {

const char* kind_of(const EffectRecord& effect) {
  static constexpr std::array<const char*, 4> names = {"exact", "estimated", "measured", "forced"};
  return names[static_cast<std::size_t>(effect.kind)];
}

bool has_body(const EffectInfluence& influence, const std::string& body) {
  return std::ranges::find(influence.bodies, body) != influence.bodies.end();
}

void add_influence(const ProblemFile& problem, const EffectInfluence& influence, Json& entry) {
  if (!influence.failure.empty()) {
    entry["influence"] = nullptr;
    entry["failure"] = influence.failure;
    return;
  }
  entry["influence"] = by_name(problem.responses, influence.changes);
  entry["unknowns"] = influence.unknowns;
  entry["iterations"] = influence.iterations;
  if (influence.bodies.size() > 1) entry["together"] = influence.bodies;
  if (influence.time) entry["time"] = time_change_document(*influence.time);
}

std::string bodies_text(const std::vector<std::string>& bodies) {
  constexpr std::size_t most = 3;
  if (bodies.empty()) return "–";
  if (bodies.size() > most) return fmt::format("{} bodies", bodies.size());
  return fmt::format("{}", fmt::join(bodies, ", "));
}

/// "elasticity (crank, rod), spatial_motion"
/// @param effects  {EFFECT: [BODY]}
std::string names_text(const Json& effects) {
  std::vector<std::string> names;
  for (const auto& [effect, bodies] : effects.items()) {
    const auto listed = bodies.get<std::vector<std::string>>();
    names.push_back(listed.empty() ? effect
                                   : fmt::format("{} ({})", effect, fmt::join(listed, ", ")));
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

void add_effect(const std::string& effect, const std::string& body, Json& effects) {
  Json& bodies = effects[effect];
  if (bodies.is_null()) bodies = Json::array();
  if (!body.empty()) bodies.push_back(body);
}

/// "+3", "−2", "0"
std::string count_text(int count) {
  return count == 0 ? "0" : fmt::format("{}{}", count < 0 ? "−" : "+", std::abs(count));
}

/// "rod_bow −0.0012 mm (−0.6 %)"
std::string largest_change_text(const MeasuredEffects& effects, const EffectInfluence& influence) {
  const LargestInfluence largest = largest_influence(effects.values, influence.changes);
  if (largest.response < 0) return "nothing";
  const ResponseSettings& response = effects.problem.responses[largest.response];
  const ShownUnit unit = unit_of(response);
  const double change = influence.changes(largest.response);
  return fmt::format("{} {} {} ({} %)", response.name, signed_significant(unit.shown(change), 2),
                     unit.name,
                     signed_significant(std::copysign(100.0 * largest.relative, change), 2));
}

/// Of a response or of the optimum, relative.
double most_changed(const MeasuredEffects& effects, const EffectInfluence& influence) {
  const double change = largest_influence(effects.values, influence.changes).relative;
  if (!effects.price) return change;
  const auto index = index_of_named(effects.problem.responses, effects.problem.objective->response);
  const double objective = index ? std::abs(effects.values(*index)) : 0.0;
  const double worth = std::abs(effects.price(influence.changes));
  return objective > 0.0 ? std::max(change, worth / objective) : change;
}

bool does_matter(const MeasuredEffects& effects, const EffectInfluence& influence) {
  if (!influence.failure.empty()) return false;
  return most_changed(effects, influence) > change_that_counts(effects.problem.effects);
}

bool has_times(const MeasuredEffects& effects) {
  return std::ranges::any_of(effects.influences,
                             [](const EffectInfluence& one) { return one.time.has_value(); });
}

std::vector<std::string> row_of(const MeasuredEffects& effects, const EffectInfluence& one) {
  const PriceOfChanges& price = effects.price;
  std::vector<std::string> row = {one.effect, bodies_text(one.bodies)};
  if (!one.failure.empty()) {
    row.insert(row.end(), 2 + (has_times(effects) ? 1 : 0) + (price ? 1 : 0), "–");
    row.push_back(one.failure);
    return row;
  }
  row.insert(row.end(), {count_text(one.unknowns), count_text(one.iterations)});
  if (one.time) row.push_back(time_change_text(*one.time));
  if (price) {
    const std::string& objective = effects.problem.objective->response;
    const ShownUnit unit = unit_of(find_response(effects.problem, objective));
    row.push_back(signed_significant(unit.shown(price(one.changes)), 2) + " " + unit.name);
  }
  row.push_back(largest_change_text(effects, one));
  return row;
}

/// "4 further effects change nothing by more than 0.025 % and cost hardly any time"
std::string small_text(const MeasuredEffects& effects, const std::vector<bool>& matters) {
  std::size_t count = 0, all = 0;
  double most = 0.0;
  for (std::size_t i = 0; i < matters.size(); ++i) {
    all += effects.influences[i].bodies.size();
    if (matters[i] || !effects.influences[i].failure.empty()) continue;
    count += effects.influences[i].bodies.size();
    most = std::max(most, most_changed(effects, effects.influences[i]));
  }
  if (count == 0) return "";
  const bool is_all = count == all;
  const std::string subject =
      fmt::format("{}{}effect{} change{}", is_all ? "" : fmt::format("{} ", count),
                  is_all ? "all " : "further ", count == 1 ? "" : "s", count == 1 ? "s" : "");
  return subject + (most > 0.0
                        ? fmt::format(" nothing by more than {} %", significant(100.0 * most, 2))
                        : " nothing");
}

std::string indispensable_text(const MeasuredEffects& effects) {
  Json all = Json::object();
  for (const EffectInfluence& one : effects.influences) {
    if (one.failure.empty()) continue;
    for (const std::string& body : one.bodies) add_effect(one.effect, body, all);
  }
  return all.empty() ? "" : names_text(all) + " cannot be left out";
}

/// What the table leaves out.
std::string rest_text(const MeasuredEffects& effects, const std::vector<bool>& matters) {
  std::vector<std::string> parts = {small_text(effects, matters), indispensable_text(effects)};
  std::erase(parts, "");
  if (parts.empty()) return "";
  std::string text = fmt::format("{}; --effects shows all.\n", fmt::join(parts, "; "));
  if (text.front() >= 'a' && text.front() <= 'z') text.front() += 'A' - 'a';
  return wrapped(text, "  ");
}

/// One an influence; those that a simulation cannot do without do not count.
std::vector<bool> which_matter(const MeasuredEffects& effects) {
  std::vector<bool> matters;
  for (const EffectInfluence& one : effects.influences) {
    matters.push_back(does_matter(effects, one));
  }
  return matters;
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
    const auto influence = std::ranges::find_if(influences, [&](const EffectInfluence& one) {
      return one.effect == effect.name && has_body(one, effect.body);
    });
    if (influence != influences.end()) add_influence(problem, *influence, entry);
    document.push_back(std::move(entry));
  }
  return document;
}

std::string effects_text(const Model& model) {
  struct Row {
    std::vector<std::string> cells, bodies;
  };
  std::vector<Row> rows;
  for (const EffectRecord& effect : model.effects) {
    const int saved = effect.coordinates_saved;
    const std::vector<std::string> cells = {effect.name,
                                            "",
                                            effect.is_built ? "yes" : "no",
                                            kind_of(effect),
                                            saved > 0 ? std::to_string(saved) : "–",
                                            effect.reason};
    auto same = std::ranges::find(rows, cells, &Row::cells);
    if (same == rows.end()) same = rows.insert(rows.end(), {cells, {}});
    if (!effect.body.empty()) same->bodies.push_back(effect.body);
  }
  Table table({left_aligned("effect"), left_aligned("of"), left_aligned("built"),
               left_aligned("decision"), "saves", left_aligned("because")});
  for (auto& [cells, bodies] : rows) {
    cells[1] = bodies_text(bodies);
    table.add_row(cells);
  }
  return table.text();
}

std::string left_out_text(const Model& model) {
  Json all = Json::object();
  for (const EffectRecord& effect : model.effects) {
    if (!effect.is_built) add_effect(effect.name, effect.body, all);
  }
  return all.empty() ? "" : wrapped(fmt::format("Left out: {}.\n", names_text(all)), "  ");
}

void mark_effects(const MeasuredEffects& effects, Json& document) {
  const std::vector<bool> matters = which_matter(effects);
  for (Json& entry : document) {
    for (std::size_t i = 0; i < matters.size(); ++i) {
      const EffectInfluence& one = effects.influences[i];
      const bool is_it = entry.at("name") == one.effect && has_body(one, entry.value("body", ""));
      if (is_it && one.failure.empty()) entry["matters"] = static_cast<bool>(matters[i]);
    }
  }
}

std::string influences_text(const MeasuredEffects& effects, bool shows_all) {
  if (effects.influences.empty()) return "";
  std::vector<Table::Column> columns = {left_aligned("without"), left_aligned("of"), "unknowns",
                                        "iterations"};
  if (has_times(effects)) columns.push_back("time");
  if (effects.price) columns.push_back("optimum");
  columns.push_back(left_aligned("largest change of a response"));
  Table table(columns);
  const std::vector<bool> matters = which_matter(effects);
  for (std::size_t i = 0; i < matters.size(); ++i) {
    if (shows_all || matters[i]) table.add_row(row_of(effects, effects.influences[i]));
  }
  const std::string listed = table.is_empty() ? "" : table.text();
  const std::string rest = shows_all ? "" : rest_text(effects, matters);
  return "\n" + listed + (listed.empty() || rest.empty() ? "" : "\n") + rest;
}

}  // namespace pleuel
