#include <algorithm>

#include <fmt/format.h>

#include "core/base/find_named.hpp"
#include "core/base/int_size.hpp"
#include "core/scene/grammar/response_keys.hpp"
#include "core/scene/response_parts.hpp"

namespace pleuel::response_tables {

namespace {

constexpr Choice<StressPart> stress_parts[] = {
    {"von-mises", StressPart::von_mises}, {"normal", StressPart::normal},
    {"axial", StressPart::axial},         {"bending", StressPart::bending},
    {"shear", StressPart::shear},         {"utilization", StressPart::utilization}};
constexpr Choice<StressPart> imported_stress_parts[] = {{"von-mises", StressPart::von_mises},
                                                        {"normal", StressPart::normal},
                                                        {"utilization", StressPart::utilization}};
constexpr int most_segments = 10000;

/// What a response of stress allows besides one beam.
struct StressBodies {
  bool several_beams = true, imported_ones = true;
};

/// The beams that a stress is the largest of: of one body a segment, a place or all of it, or all of
/// several bodies.
std::vector<const BeamBody*> beams(Keys& keys, const Body* one, StressPlaces& places,
                                   const Scope& scope, const StressBodies& allowed = {}) {
  std::vector<const BeamBody*> found;
  const BeamBody* beam = elastic_beam(keys, one);
  if (beam != nullptr) found.push_back(beam);
  std::vector<std::string> several;
  if (allowed.several_beams) {
    keys.names(optional_key("bodies"), "body", names_of(scope.scene.bodies), several,
               "Elastic beams: the largest of all.");
  }
  for (std::size_t i = 0; i < several.size(); ++i) {
    const auto* other = shape_of<BeamBody>(find_named(scope.scene.bodies, several[i]));
    keys.must_item("bodies", i, other != nullptr && !other->is_rigid,
                   fmt::format("must name an elastic beam, but \"{}\" is none", several[i]));
    found.push_back(other);
  }
  if (!several.empty()) places.bodies = several;
  for (const char* word : {"segment", "at"}) {
    keys.must(word, several.empty(), "is for one \"body\", not for several");
  }
  keys.exclusive("segment", "at");
  const int segments = beam == nullptr ? most_segments : int_size(beam->segments);
  keys.whole(optional_key("segment"), places.segment, {0, segments - 1},
             "Counted from 0; by default the whole beam.");
  if (beam == nullptr && allowed.imported_ones) {
    keys.other(optional_key("at"), "stress_place", "");
  } else {
    keys.place(optional_key("at"), places.station,
               "Only at this place along the beam, from 0 to 1; not with segment.");
  }
  return found;
}

void body_or_bodies(Keys& keys) {
  keys.exclusive("body", "bodies");
  keys.one_at_least({"body", "bodies"});
}

/// The points of stress of a file: all, or those that `at` names.
/// @returns what is known of them; without strengths where the file has no points
Strengths<double> stress_points(Keys& keys, const ImportedBody& body, StressPlaces& places) {
  const std::optional<StressRecovery>& stress = body.file->constants.stress;
  keys.must("body", stress.has_value(),
            fmt::format("names a body whose file {} has no block \"stress\"", body.source));
  for (const char* word : {"bodies", "segment"}) {
    keys.refused(word, "is for beams only; \"at\" names points of stress of a file");
  }
  if (!stress) return {};
  keys.name(optional_key("at"), "point or group of points", point_names(*stress), places.place, "");
  return stress->strengths;
}

void imported_stress(Keys& keys, const ImportedBody& body, StressResponse& stress) {
  const Strengths<double> strengths = stress_points(keys, body, stress.where);
  keys.choice(optional_key("part"), stress.part, imported_stress_parts, "");
  keys.must("part", stress.part != StressPart::utilization || strengths.yield != 0.0,
            fmt::format("needs a strength, which the file {} does not give", body.source));
}

}  // namespace

void describe(Keys& keys, StressResponse& stress, R& r, const Scope& scope) {
  keys.about(
      "Stress [Pa], the largest over a beam, over one of its segments or at a place; utilization "
      "is "
      "a number without unit.");
  body_or_bodies(keys);
  const Body* one =
      body(keys, optional_key("body"), stress.where.bodies, scope, "An elastic beam.");
  if (const auto* imported = shape_of<ImportedBody>(one)) {
    imported_stress(keys, *imported, stress);
  } else {
    const std::vector<const BeamBody*> all = beams(keys, one, stress.where, scope);
    keys.choice(optional_key("part"), stress.part, stress_parts,
                "normal: signed, axial and bending; axial: normal force over area; bending: "
                "without it; shear: of torsion; utilization: von Mises stress over the strength of "
                "the material.");
    for (const BeamBody* beam : all) {
      const Material* material = find_named(scope.scene.materials, beam->material);
      const bool has_strength = material != nullptr && material->strength.has_value();
      keys.must(
          "part", stress.part != StressPart::utilization || has_strength,
          fmt::format("needs the strength of the material \"{}\", which has none", beam->material));
    }
  }
  history(keys, r, scope);
}

namespace {

bool has_general_section(const BeamBody& beam) {
  return std::ranges::any_of(beam.segments, [](const Segment& segment) {
    return std::holds_alternative<GeneralSection>(segment.section);
  });
}

}  // namespace

void describe(Keys& keys, ShearStressResponse& stress, R& r, const Scope& scope) {
  keys.about(
      "Shear stress [Pa] of shear forces and torsion, the largest over a beam, over one of its "
      "segments or at a place. The sections are not of the type general.");
  body_or_bodies(keys);
  const Body* one =
      body(keys, optional_key("body"), stress.where.bodies, scope, "An elastic beam.");
  const std::vector<const BeamBody*> all =
      beams(keys, one, stress.where, scope, {.imported_ones = false});
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool is_known = !has_general_section(*all[i]);
    const char* rule =
        "names a beam with a general section, whose properties do not tell where shear forces act "
        "in it; \"section-force\" gives the forces";
    keys.must("body", is_known, rule);
    if (one == nullptr) keys.must_item("bodies", i, is_known, rule);
  }
  history(keys, r, scope);
}

namespace {

/// What a criterion needs to know, and what the endurance or the damage does.
/// @param given  not zero where it is
/// @param where  what lacks it
void fatigue_data(Keys& keys, const FatigueResponse& fatigue, const Strengths<double>& given,
                  const std::string& where) {
  const auto need = [&](bool is_asked, double number, std::string_view word) {
    keys.must("criterion", !is_asked || number > 0.0,
              fmt::format("needs the \"{}\" of {}", word, where));
  };
  const bool is_damage = fatigue.kind == FatigueNumber::damage;
  const bool is_soderberg = fatigue.criterion == FatigueCriterion::soderberg;
  need(!is_damage, given.endurance_limit, "endurance_limit");
  need(is_damage, given.fatigue, "fatigue_strength");
  need(is_damage, given.fatigue_exponent, fatigue_exponent_word);
  need(is_soderberg, given.yield, "strength");
  need(!is_soderberg, given.ultimate, "ultimate_strength");
}

/// 1 for each that is given, by a number or by a variable.
Strengths<double> given_strengths(const Material& material) {
  const auto one = [](const auto& number) { return number ? 1.0 : 0.0; };
  return {one(material.strength), one(material.ultimate_strength), one(material.endurance_limit),
          one(material.fatigue_strength), one(material.fatigue_exponent)};
}

}  // namespace

void describe(Keys& keys, FatigueResponse& fatigue, R& r, const Scope& scope) {
  const bool is_damage = fatigue.kind == FatigueNumber::damage;
  keys.about(is_damage
                 ? "Damage by all cycles of normal stress of a point in the simulation or a window "
                   "of it, by rainflow counting, Basquin's line and the sum of Palmgren and Miner: "
                   "the largest of all points of one beam."
                 : "Utilization of the material by the cycle between the largest and the smallest "
                   "normal stress of a point, in the simulation or a window of it: the largest of "
                   "all points. Its inverse is the factor of safety on the load.");
  keys.refused(
      "over_time",
      "is not for a fatigue, which looks at the largest and the smallest stress of cycles");
  if (is_damage) {
    keys.refused("bodies", "is not for a fatigue-damage: give one \"body\"");
  } else {
    body_or_bodies(keys);
  }
  keys.choice("criterion", fatigue.criterion, fatigue_criteria,
              "How much mean stress a cycle bears beside its amplitude: a straight line to the "
              "ultimate strength (goodman) or to the strength (soderberg), or a parabola to the "
              "ultimate strength (gerber). Compression as a mean neither harms nor helps.");
  r.over_time = OverTime::final;
  const Key key = is_damage ? Key("body") : optional_key("body");
  const Body* one = body(keys, key, fatigue.where.bodies, scope, "An elastic beam.");
  if (const auto* imported = shape_of<ImportedBody>(one)) {
    fatigue_data(keys, fatigue, stress_points(keys, *imported, fatigue.where),
                 fmt::format("the file {}, which does not give it", imported->source));
  } else {
    const StressBodies allowed{.several_beams = !is_damage};
    for (const BeamBody* beam : beams(keys, one, fatigue.where, scope, allowed)) {
      const Material* material = find_named(scope.scene.materials, beam->material);
      if (material == nullptr) continue;
      fatigue_data(keys, fatigue, given_strengths(*material),
                   fmt::format("the material \"{}\", which has none: give it in /scene/materials",
                               material->name));
    }
  }
  window(keys, r, scope);
}

}  // namespace pleuel::response_tables
