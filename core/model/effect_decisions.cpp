#include "core/model/effect_decisions.hpp"

#include <cmath>

#include <fmt/format.h>

namespace pleuel {

namespace {

std::optional<BeamEstimates> find_estimates(const Body& body, const EffectSettings& settings) {
  const auto found = settings.estimates.find(body.name);
  if (settings.tolerance <= 0.0 || found == settings.estimates.end()) return std::nullopt;
  return found->second;
}

bool is_needed(EffectChoice choice, std::optional<double> estimate, double tolerance) {
  if (choice != EffectChoice::automatic) return choice == EffectChoice::on;
  return !estimate || *estimate > tolerance;
}

}  // namespace

BeamEffects decide_beam_effects(const Body& body, const EffectSettings& settings) {
  const auto& beam = std::get<BeamBody>(body.shape);
  const std::optional<BeamEstimates> estimates = find_estimates(body, settings);
  const auto decide = [&](EffectChoice choice, double BeamEstimates::*estimate) {
    std::optional<double> number;
    if (estimates) number = (*estimates).*estimate;
    return is_needed(choice, number, settings.tolerance);
  };
  BeamEffects effects;
  effects.elasticity = !beam.is_rigid && decide(settings.elasticity, &BeamEstimates::elasticity);
  effects.rotary_inertia = decide(settings.rotary_inertia, &BeamEstimates::rotary_inertia);
  effects.torsional_elasticity = effects.elasticity && decide(settings.torsional_elasticity,
                                                              &BeamEstimates::torsional_elasticity);
  effects.geometric_stiffening =
      effects.elasticity && settings.axial_elasticity != EffectChoice::off &&
      decide(settings.geometric_stiffening, &BeamEstimates::geometric_stiffening);
  // The axial force that stiffens comes from axial strain.
  effects.axial_elasticity =
      effects.elasticity && (effects.geometric_stiffening ||
                             decide(settings.axial_elasticity, &BeamEstimates::axial_elasticity));
  return effects;
}

namespace {

class BeamTable {
 public:
  BeamTable(const Body& body, const EffectSettings& settings, const BodyModel& model,
            bool is_planar)
      : body_(body), settings_(settings), model_(model), is_planar_(is_planar) {}

  std::vector<EffectRecord> records() {
    const BeamEffects built = decide_beam_effects(body_, settings_);
    const auto& beam = std::get<BeamBody>(body_.shape);
    add("elasticity", built.elasticity, settings_.elasticity, &BeamEstimates::elasticity);
    if (beam.is_rigid) set_exact("the file says that it is rigid");
    if (built.elasticity) {
      add("axial_elasticity", built.axial_elasticity, settings_.axial_elasticity,
          &BeamEstimates::axial_elasticity);
      if (!built.axial_elasticity) saved(free_nodes());
      add("torsional_elasticity", built.torsional_elasticity && !is_planar_,
          settings_.torsional_elasticity, &BeamEstimates::torsional_elasticity);
      if (is_planar_) {
        set_exact("motion in a plane does not twist");
      } else if (!built.torsional_elasticity) {
        saved(free_nodes());
      }
      add("geometric_stiffening", built.geometric_stiffening, settings_.geometric_stiffening,
          &BeamEstimates::geometric_stiffening);
    }
    add("rotary_inertia", built.rotary_inertia, settings_.rotary_inertia,
        &BeamEstimates::rotary_inertia);
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

  void add(const std::string& name, bool is_built, EffectChoice choice,
           double BeamEstimates::*estimate) {
    EffectRecord record{name, body_.name, is_built, EffectRecord::Kind::exact, "", {}, 0};
    const auto estimates = find_estimates(body_, settings_);
    if (choice != EffectChoice::automatic) {
      record.kind = EffectRecord::Kind::forced;
      record.reason = "asked for";
    } else if (estimates) {
      record.kind = EffectRecord::Kind::estimated;
      record.estimate = (*estimates).*estimate;
      record.reason = std::isinf(*record.estimate)
                          ? "a response of the body asks for it"
                          : fmt::format("changes responses by some {:.2g}, tolerance {:g}",
                                        *record.estimate, settings_.tolerance);
      if (is_built && *record.estimate <= settings_.tolerance) {
        record.reason = "geometric stiffening needs it";
      }
    } else {
      record.reason = "no tolerance allows to leave it out";
    }
    records_.push_back(std::move(record));
  }

  const Body& body_;
  const EffectSettings& settings_;
  const BodyModel& model_;
  bool is_planar_;
  std::vector<EffectRecord> records_;
};

}  // namespace

std::vector<EffectRecord> beam_records(const Body& body, const EffectSettings& settings,
                                       const BodyModel& model, bool is_planar) {
  return BeamTable(body, settings, model, is_planar).records();
}

}  // namespace pleuel
