#include "core/scene/grammar/response_keys.hpp"

#include <fmt/format.h>

#include "core/base/find_named.hpp"
#include "core/scene/response_parts.hpp"

namespace pleuel::response_tables {

void window(Keys& keys, R& r, const Scope& scope) {
  const double end = scope.end_time;
  keys.fixed(optional_key("from"), r.from, {quantities::time, Range::not_negative},
             "Start of the window of time {}, before the end of the simulation; default 0.");
  keys.must("from", r.from.value_or(0.0) < end,
            fmt::format("must be before the end of the simulation, {:g} [s]", end),
            Shown::rule_and_value);
  keys.fixed(optional_key("to"), r.to, {quantities::time, Range::positive},
             "End of the window of time {}, after its start; by default the end of the "
             "simulation.");
  keys.must("to", r.to.value_or(end) <= end,
            fmt::format("must not be after the end of the simulation, {:g} [s]", end),
            Shown::rule_and_value);
  keys.must("to", r.to.value_or(end) > r.from.value_or(0.0), "must be later than \"from\"",
            Shown::rule_and_value);
}

void history(Keys& keys, R& r, const Scope& scope) {
  keys.choice("over_time", r.over_time, over_time_kinds, "How the history becomes one number.");
  window(keys, r, scope);
}

const Body* body(Keys& keys, const Key& key, std::string& name, const Scope& scope,
                 std::string_view sentence) {
  keys.name(key, "body", names_of(scope.scene.bodies), name, sentence);
  return find_named(scope.scene.bodies, name);
}

const Body* body(Keys& keys, const Key& key, std::vector<std::string>& names, const Scope& scope,
                 std::string_view sentence) {
  std::string name;
  const Body* one = body(keys, key, name, scope, sentence);
  if (!name.empty()) names = {name};
  return one;
}

const BeamBody* elastic_beam(Keys& keys, const Body* body) {
  const auto* beam = shape_of<BeamBody>(body);
  if (body == nullptr) return nullptr;
  keys.must("body", beam != nullptr,
            fmt::format("must name a beam, but \"{}\" is none", body->name));
  keys.must("body", beam == nullptr || !beam->is_rigid,
            fmt::format("must name an elastic beam, but \"{}\" is rigid", body->name));
  return beam;
}

void component_of_jerk(Keys& keys, MotionComponent& one, const std::string& prefix,
                       std::string_view sentence) {
  keys.refused_choice("direction", "magnitude",
                      fmt::format("must be \"x\", \"y\", \"z\" or a vector, as the magnitude of "
                                  "the {0}jerk is no rate of that of the {0}acceleration",
                                  prefix));
  component(keys, one, axes, sentence);
}

void place(Keys& keys, const Body* body, ResponsePoint& point, std::string_view sentence) {
  const auto* imported = shape_of<ImportedBody>(body);
  if (imported != nullptr) {
    keys.name("at", "place", names_of(imported->file->constants.places), point.place, sentence);
  } else if (shape_of<BeamBody>(body) != nullptr) {
    keys.place("at", point.at, sentence);
  } else {
    keys.other("at", "named_place", sentence);
  }
}

}  // namespace pleuel::response_tables
