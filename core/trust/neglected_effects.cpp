#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <variant>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/base/number_text.hpp"
#include "core/response/effect_measurement.hpp"
#include "core/trust/bent_beams.hpp"
#include "core/trust/check_list.hpp"
#include "core/trust/coarse_runs.hpp"

namespace pleuel {

namespace {

bool leaves_out_by_measurement(const Model& model) {
  return std::ranges::any_of(model.effects, [](const EffectRecord& record) {
    return record.kind == EffectRecord::Kind::measured && !record.is_built;
  });
}

}  // namespace

std::optional<CompleteRun> simulate_completely(const TrustedRun& run) {
  if (!leaves_out_by_measurement(run.analysis.model)) return {};
  compare_at_twice(run);  // whether its members buckle is looked for, too
  CompleteRun complete;
  try {
    complete.analysis = analyze_variant(run, [&](ProblemFile& variant) {
      variant = with_all_effects(variant);
      complete.problem = variant;
    });
  } catch (const SimulationError& error) {
    complete.failure = error.what();
  }
  return complete;
}

std::vector<Finding> check_neglected_effects(const TrustedRun& run, const CompleteRun& complete) {
  if (!complete.analysis) {
    return {{fmt::format("with the effects that were left out at the start design this one cannot "
                         "be simulated: {}",
                         complete.failure),
             true}};
  }
  if (run.x == start_design(run.problem)) return {};
  const LargestChange change =
      largest_change(run.problem, *complete.analysis, basis_of_variants(run));
  if (change.relative <= run.problem.effects.tolerance) return {};
  return {{fmt::format("effects that were left out at the start design change \"{}\" by {:.2g} "
                       "at this one, more than /effects/tolerance = {:g}. Start from this "
                       "design, or with a smaller tolerance.",
                       change.response, change.relative, run.problem.effects.tolerance),
           true,
           {change.response}}};
}

void add_neglected_effects(const TrustedRun& run, const CompleteRun& complete,
                           std::vector<std::optional<ErrorBar>>& errors) {
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (!errors[i]) continue;
    ErrorPart& effects = errors[i]->effects;
    if (!complete.analysis) {  // the bar says so
      effects.is_resolved = false;
      continue;
    }
    effects.change =
        complete.analysis->reductions[i].value - basis_of_variants(run).reductions[i].value;
    effects.bound = std::abs(effects.change);
  }
}

namespace {

/// Of the damping of bending.
constexpr double small_growth = 0.01;
/// Of a cantilever in its first mode damping grows by some 0.09 L/r θ² (θ: rotation of the tip, r:
/// radius of gyration): the shortening goes as w²/L, and axial modes are damped more than bending
/// ones by the ratio of their frequencies, which is that of L to r. The factor is that of resonances
/// with L/r from 87 to 346, which are 0.6 to 11 % too low.
constexpr double growth_of_damping = 0.09;

/// Length over the radius of gyration.
double slenderness(const Beam<double>& beam) {
  double length = 0.0, radius = std::numeric_limits<double>::infinity();
  for (const BeamElement<double>& element : beam.elements) {
    const SectionProperties<double>& section = element.section;
    length += element.length;
    radius =
        std::min(radius, std::sqrt(std::min(section.inertia_y, section.inertia_z) / section.area));
  }
  return length / radius;
}

bool is_damped_by_modes(const ProblemFile& problem, const std::string& name) {
  return std::ranges::any_of(problem.scene.bodies, [&](const Body& body) {
    const auto* beam = std::get_if<BeamBody>(&body.shape);
    return beam && body.name == name &&
           (beam->damping.modal.is_bound() || beam->damping.modal.constant > 0.0);
  });
}

}  // namespace

std::vector<Finding> check_modal_damping(const TrustedRun& run) {
  const Model& model = run.analysis.model;
  const auto is_concerned = [&](const BodyModel& body) {
    return body.has_stiffening && body.is_beam() && is_damped_by_modes(run.problem, body.name);
  };
  if (std::ranges::none_of(model.bodies, is_concerned)) return {};
  const auto& largest = largest_deformations(run);
  std::vector<Finding> findings;
  for (std::size_t i = 0; i < largest.size(); ++i) {
    const BodyModel& body = model.bodies[i];
    if (!is_concerned(body)) continue;
    const double rotation = largest[i].bending;
    const double share = growth_of_damping * slenderness(body.beam) * rotation * rotation;
    if (share < small_growth) continue;
    findings.push_back({fmt::format(
        "\"{}\" bends by {:.2g} rad, and its \"modal\" damping takes the shortening that goes "
        "with it for a stretch: bending is damped by some {} % too much, so that resonances are "
        "lower and free vibrations die sooner. Give it damping by \"stiffness\", which knows the "
        "difference.",
        body.name, rotation, significant(100.0 * share, 1))});
  }
  return findings;
}

}  // namespace pleuel
