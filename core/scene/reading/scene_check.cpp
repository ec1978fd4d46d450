#include "core/scene/reading/scene_check.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/scene/body_rules.hpp"
#include "core/scene/reading/geometry.hpp"
#include "core/scene/reading/limits.hpp"
#include "core/scene/reading/mechanism_check.hpp"
#include "core/scene/reading/placement_check.hpp"
#include "core/scene/reading/sample_design.hpp"
#include "core/scene/reading/section_check.hpp"

namespace pleuel {
namespace {

/// A beam, or a body that lies as one.
template <class Beam>
void check_axes(const JsonNode& node, const Beam& beam, const SampleDesign& sample) {
  const Eigen::Vector3d axis =
      position(beam.to, sample.design) - position(beam.from, sample.design);
  const double size = std::max(position(beam.to, sample.design).stableNorm(),
                               position(beam.from, sample.design).stableNorm());
  if (axis.stableNorm() <= rounding_tolerance * size) {
    node.fail("has zero length: \"from\" and \"to\" are the same point" + sample.where);
  }
  if (!beam.reference) return;
  const Eigen::Vector3d reference((*beam.reference)[0], (*beam.reference)[1], (*beam.reference)[2]);
  if (axis.stableNormalized().cross(reference.stableNormalized()).norm() <= rounding_tolerance) {
    node.at("reference").fail_with_value("must not be parallel to the beam", sample.where);
  }
}

void check_sections(const JsonNode& node, const BeamBody& beam, const Design<double>& start) {
  const std::optional<JsonNode> list = node.find("segments");
  for (std::size_t i = 0; i < beam.segments.size(); ++i) {
    const JsonNode segment = list ? list->items()[i] : node;
    check_section(segment.at("section"), beam.segments[i].section, start);
  }
}

void check_inertia(const JsonNode& node, const RigidBody& body, const Design<double>& start) {
  const JsonNode list = node.at("inertia");
  const auto is_zero = [&](const Number& entry) { return resolve(entry, start) == 0.0; };
  if (std::all_of(body.inertia.begin(), body.inertia.begin() + 3, is_zero)) {
    list.fail_with_value("must not be all zero (a body without inertia is a point-mass)");
  }
  if (const auto broken = inertia_complaint(body, start)) list.fail_with_value(*broken);
}

/// Derivatives belong to the design at which they were made.
void check_design(const JsonNode& node, const ImportedBody& body, const Design<double>& start) {
  if (body.maker) return;
  for (const ImportedVariable& of : body.variables) {
    const ConstantsDerivative& derivative = body.file->design[of.in_design];
    const double value = resolve(of.number, start);
    if (std::abs(value - derivative.value) <= rounding_tolerance * std::abs(derivative.value)) {
      continue;
    }
    node.at("file").fail(fmt::format(
        "names the file {} of the design {} = {:.12g} [{}], but the variable starts at {:.12g}",
        body.source, derivative.variable, derivative.value, derivative.unit, value));
  }
}

void check_bodies(const JsonNode& node, const Scene& scene,
                  const std::vector<SampleDesign>& samples) {
  for (const Body& body : scene.bodies) {
    const JsonNode place = node.at(body.name);
    if (const auto* beam = std::get_if<BeamBody>(&body.shape)) {
      for (const SampleDesign& sample : samples) check_axes(place, *beam, sample);
      check_sections(place, *beam, samples.front().design);
    } else if (const auto* rigid = std::get_if<RigidBody>(&body.shape)) {
      check_inertia(place, *rigid, samples.front().design);
    } else if (const auto* imported = std::get_if<ImportedBody>(&body.shape)) {
      for (const SampleDesign& sample : samples) check_axes(place, *imported, sample);
      check_design(place, *imported, samples.front().design);
    }
  }
}

/// What would set the elastic coordinates, too, or leaves none.
void check_deflections(const JsonNode& bodies, const ProblemFile& problem) {
  for (const Body& body : problem.scene.bodies) {
    if (body.initial_deflections.empty()) continue;
    const JsonNode node = bodies.at(body.name).at("initial_deflections");
    if (problem.simulation.quasi_static_start) {
      node.fail("cannot be given where /simulation/initial_state is \"quasi-static\"");
    }
    if (problem.simulation.period > 0.0) {
      node.fail("cannot be given where /simulation/initial_state is \"periodic\"");
    }
    if (problem.effects.elasticity == EffectChoice::off) {
      node.fail("cannot be given where /effects/elasticity is \"off\"");
    }
  }
}

}  // namespace

void check_scene(const JsonNode& node, const ProblemFile& problem) {
  check_mechanism(node, problem.scene);
  const std::vector<SampleDesign> samples = sample_designs(problem.variables);
  check_bodies(node.at("bodies"), problem.scene, samples);
  check_placement(node, problem.scene, samples);
  check_deflections(node.at("bodies"), problem);
}

}  // namespace pleuel
