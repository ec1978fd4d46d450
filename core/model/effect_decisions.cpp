#include "core/model/effect_decisions.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include <fmt/format.h>

namespace pleuel {

namespace {

std::optional<BeamEstimates> find_estimates(const Body& body, const EffectSettings& settings) {
  if (settings.tolerance <= 0.0) return std::nullopt;
  const auto found = settings.decisions.estimates.find(body.name);
  if (found == settings.decisions.estimates.end()) return std::nullopt;
  return found->second;
}

const MeasuredEffect* find_measured(const Body& body, const char* effect,
                                    const EffectSettings& settings) {
  const auto found = settings.decisions.measured.find({body.name, effect});
  return found == settings.decisions.measured.end() ? nullptr : &found->second;
}

/// What is asked for, without regard to what effects need of each other.
bool is_wanted(const Body& body, const BeamEffect& effect, const EffectSettings& settings) {
  const EffectChoice choice = settings.*effect.choice;
  if (choice != EffectChoice::automatic) return choice == EffectChoice::on;
  if (const MeasuredEffect* measured = find_measured(body, effect.name, settings)) {
    return measured->is_needed;
  }
  const std::optional<BeamEstimates> estimates = find_estimates(body, settings);
  return !estimates || (*estimates).*effect.estimate > settings.tolerance;
}

}  // namespace

BodyEffects decide_effects(const Body& body, const EffectSettings& settings) {
  BodyEffects effects;
  for (const BeamEffect& effect : beam_effects) {
    effects.*effect.is_built = is_wanted(body, effect, settings);
  }
  const bool has_axial = settings.axial_elasticity != EffectChoice::off;
  const auto* beam = std::get_if<BeamBody>(&body.shape);
  effects.elasticity = effects.elasticity && !(beam != nullptr && beam->is_rigid);
  effects.torsional_elasticity = effects.torsional_elasticity && effects.elasticity;
  effects.geometric_stiffening = effects.geometric_stiffening && effects.elasticity && has_axial;
  effects.axial_elasticity =
      effects.elasticity && (effects.axial_elasticity || effects.geometric_stiffening);
  return effects;
}

namespace {

class BeamTable {
 public:
  BeamTable(const Body& body, const EffectSettings& settings, const BodyModel& model,
            bool is_planar)
      : body_(body), settings_(settings), model_(model), is_planar_(is_planar) {}

  std::vector<EffectRecord> records() {
    built_ = decide_effects(body_, settings_);
    add("elasticity");
    if (std::get<BeamBody>(body_.shape).is_rigid) set_exact("the file says that it is rigid");
    if (built_.elasticity) {
      add("axial_elasticity");
      if (!built_.axial_elasticity) saved(free_nodes());
      add_torsion();
      add_stiffening();
    }
    add("rotary_inertia");
    if (built_.elasticity && std::get<BeamBody>(body_.shape).has_shear) {
      records_.push_back(
          {"shear", body_.name, true, EffectRecord::Kind::forced, "asked for", {}, 0});
    }
    return std::move(records_);
  }

 private:
  /// Coordinates that one displacement direction has: at all nodes but one.
  int free_nodes() const { return model_.beam.node_count() - 1; }
  void saved(int coordinates) { records_.back().coordinates_saved = coordinates; }

  void set_exact(const std::string& reason) {
    EffectRecord& record = records_.back();
    record.kind = EffectRecord::Kind::exact;
    record.reason = reason;
    record.estimate.reset();
  }

  void add_torsion() {
    add("torsional_elasticity");
    if (is_planar_) {
      set_exact("motion in a plane does not twist");
      records_.back().is_built = false;
    } else if (!built_.torsional_elasticity) {
      saved(free_nodes());
    }
  }

  void add_stiffening() {
    add("geometric_stiffening");
    if (settings_.axial_elasticity != EffectChoice::off) return;
    if (settings_.geometric_stiffening == EffectChoice::off) return;
    set_exact("axial_elasticity is off, and without axial strain there is no axial force");
    records_.back().kind = EffectRecord::Kind::forced;
  }

  void add(const char* name) {
    const BeamEffect& effect = *std::ranges::find_if(
        beam_effects, [name](const BeamEffect& other) { return std::string(name) == other.name; });
    EffectRecord record{name, body_.name, built_.*effect.is_built, EffectRecord::Kind::exact, "",
                        {},   0};
    const auto estimates = find_estimates(body_, settings_);
    if (settings_.*effect.choice != EffectChoice::automatic) {
      record.kind = EffectRecord::Kind::forced;
      record.reason = "asked for";
    } else if (const MeasuredEffect* measured = find_measured(body_, name, settings_)) {
      describe(*measured, record);
    } else if (estimates) {
      describe((*estimates).*effect.estimate, record);
    } else {
      record.reason = "no tolerance allows to leave it out";
    }
    if (record.is_built && !is_wanted(body_, effect, settings_)) {
      record.reason = "geometric stiffening needs it";
    }
    records_.push_back(std::move(record));
  }

  void describe(const MeasuredEffect& measured, EffectRecord& record) const {
    record.kind = EffectRecord::Kind::measured;
    record.estimate = measured.change;
    record.reason = measured.is_needed
                        ? fmt::format("without it \"{}\" changes by {:.2g}, tolerance {:g}",
                                      measured.response, measured.change, settings_.tolerance)
                        : fmt::format(
                              "without all that is left out \"{}\" changes most, by {:.2g}, "
                              "tolerance {:g}",
                              measured.response, measured.change, settings_.tolerance);
  }

  void describe(double estimate, EffectRecord& record) const {
    record.kind = EffectRecord::Kind::estimated;
    record.estimate = estimate;
    record.reason = std::isinf(estimate)
                        ? "a response of the body asks for it"
                        : fmt::format("changes responses by some {:.2g}, tolerance {:g}", estimate,
                                      settings_.tolerance);
  }

  const Body& body_;
  const EffectSettings& settings_;
  const BodyModel& model_;
  bool is_planar_;
  BodyEffects built_;
  std::vector<EffectRecord> records_;
};

}  // namespace

std::vector<EffectRecord> beam_records(const Body& body, const EffectSettings& settings,
                                       const BodyModel& model, bool is_planar) {
  return BeamTable(body, settings, model, is_planar).records();
}

}  // namespace pleuel
