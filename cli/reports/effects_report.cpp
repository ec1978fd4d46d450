#include "cli/reports/effects_report.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "cli/reports/influence_report.hpp"
#include "cli/reports/time_text.hpp"
#include "cli/text/table.hpp"
#include "cli/text/wrapped_text.hpp"

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
  entry["influence"] = by_name(problem.responses, influence.changes);
  entry["unknowns"] = influence.unknowns;
  entry["iterations"] = influence.iterations;
  if (influence.time) entry["time"] = time_change_document(*influence.time);
}

bool are_alike(const EffectRecord& one, const EffectRecord& other) {
  return one.name == other.name && one.is_built == other.is_built && one.kind == other.kind &&
         one.reason == other.reason && one.coordinates_saved == other.coordinates_saved;
}

/// Effects that are decided alike, and of which bodies.
struct AlikeEffects {
  const EffectRecord* effect;
  std::vector<std::string> bodies;
};

std::vector<AlikeEffects> alike_effects(const Model& model) {
  std::vector<AlikeEffects> all;
  for (const EffectRecord& effect : model.effects) {
    auto same = std::find_if(all.begin(), all.end(), [&](const AlikeEffects& one) {
      return are_alike(*one.effect, effect);
    });
    if (same == all.end()) same = all.insert(all.end(), {&effect, {}});
    if (!effect.body.empty()) same->bodies.push_back(effect.body);
  }
  return all;
}

std::string bodies_text(const std::vector<std::string>& bodies) {
  constexpr std::size_t most = 3;
  if (bodies.empty()) return "–";
  if (bodies.size() > most) return fmt::format("{} bodies", bodies.size());
  return fmt::format("{}", fmt::join(bodies, ", "));
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
  Table table({left_aligned("effect"), left_aligned("of"), left_aligned("built"),
               left_aligned("decision"), "saves", left_aligned("because")});
  for (const auto& [effect, bodies] : alike_effects(model)) {
    table.add_row({effect->name, bodies_text(bodies), effect->is_built ? "yes" : "no",
                   kind_of(*effect),
                   effect->coordinates_saved > 0 ? std::to_string(effect->coordinates_saved) : "–",
                   effect->reason});
  }
  return table.text();
}

std::string left_out_text(const Model& model) {
  std::vector<std::pair<std::string, std::vector<std::string>>> all;  // name: bodies
  for (const EffectRecord& effect : model.effects) {
    if (effect.is_built) continue;
    const auto same = std::find_if(all.begin(), all.end(),
                                   [&](const auto& one) { return one.first == effect.name; });
    auto& entry =
        same == all.end() ? all.emplace_back(effect.name, std::vector<std::string>()) : *same;
    if (!effect.body.empty()) entry.second.push_back(effect.body);
  }
  if (all.empty()) return "";
  std::vector<std::string> names;
  for (const auto& [name, bodies] : all) names.push_back(effect_of_bodies(name, bodies));
  return wrapped(fmt::format("Left out: {}.\n", fmt::join(names, ", ")), "  ");
}

}  // namespace pleuel
