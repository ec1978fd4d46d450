#include "core/trust/refined_runs.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <variant>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/int_size.hpp"
#include "core/integration/simulation_options.hpp"
#include "core/jobs/parallel.hpp"
#include "core/model/divided_beams.hpp"
#include "core/scene/beam_mesh.hpp"

namespace pleuel {

namespace {

void change_steps(SimulationSettings& settings, double factor) {
  const double steps = steps_within(settings.end_time, settings.step);
  settings.step = settings.end_time / steps_within(steps, factor);
  settings.local_error = std::min(settings.local_error * factor * factor, 0.5);
  settings.smallest_step *= factor;
}

/// Segments without a fraction share the length in proportion to their elements, which rounding
/// would change.
void fix_fractions(BeamBody& beam) {
  double sum = 0.0;
  for (const Segment& segment : beam.segments) sum += segment.elements;
  for (Segment& segment : beam.segments) {
    if (!segment.fraction) segment.fraction = segment.elements / sum;
  }
}

void change_elements(Scene& scene, double factor) {
  for (Body& body : scene.bodies) {
    auto* beam = std::get_if<BeamBody>(&body.shape);
    if (!beam || beam->is_rigid) continue;
    fix_fractions(*beam);
    for (Segment& segment : beam->segments) {
      segment.elements = static_cast<int>(std::ceil(factor * segment.elements));
    }
  }
}

void divide_meshes(Scene& scene, int pieces) {
  for (Body& body : scene.bodies) {
    if (auto* beam = std::get_if<BeamBody>(&body.shape)) beam->pieces *= pieces;
  }
}

/// How many elements the mesh of a beam has, with all its frames, as if it were elastic.
std::map<std::string, int> mesh_sizes(const ProblemFile& problem) {
  const Eigen::VectorXd start = start_design(problem);
  const Design<double> design(start.begin(), start.end());
  const Scene scene = divide_beams(problem.scene, problem.effects, design).scene;
  std::map<std::string, int> sizes;
  for (const Body& body : scene.bodies) {
    const auto* beam = std::get_if<BeamBody>(&body.shape);
    if (!beam || beam->is_rigid) continue;
    sizes[name_in_scene(body)] += int_size(make_mesh(body, scene, design, true).elements);
  }
  return sizes;
}

void add_modes(Scene& scene, int more) {
  for (Body& body : scene.bodies) {
    auto* beam = std::get_if<BeamBody>(&body.shape);
    if (beam && beam->reduction) beam->reduction->more_modes += more;
  }
}

}  // namespace

Refinement operator*(const Refinement& first, const Refinement& second) {
  return {first.step * second.step, first.elements * second.elements,
          first.more_modes + second.more_modes, first.newton * second.newton,
          first.pieces * second.pieces};
}

ProblemFile refined(ProblemFile problem, const Refinement& refinement) {
  if (refinement.step != 1.0) change_steps(problem.simulation, refinement.step);
  if (refinement.elements != 1.0) change_elements(problem.scene, refinement.elements);
  if (refinement.pieces > 1) divide_meshes(problem.scene, refinement.pieces);
  if (refinement.more_modes > 0) add_modes(problem.scene, refinement.more_modes);
  problem.simulation.newton_tolerance *= refinement.newton;
  return problem;
}

int beam_elements(const ProblemFile& problem) {
  int count = 0;
  for (const Body& body : problem.scene.bodies) {
    const auto* beam = std::get_if<BeamBody>(&body.shape);
    if (beam == nullptr || beam->is_rigid) continue;
    for (const Segment& segment : beam->segments) count += segment.elements;
  }
  return count;
}

NestedRun simulate_refined(const ProblemFile& problem, const Eigen::VectorXd& x,
                           const Refinement& refinement, const Trajectory* similar) {
  NestedRun run;
  try {
    run.problem = refined(problem, refinement);
    run.problem.simulation.moves_by_bending = true;  // whether it moves at all was asked before
    run.analysis = analyze(run.problem, x, judging(similar));
  } catch (const SimulationError& error) {
    run.failure = error.what();
  } catch (const InputError& error) {  // more modes than coordinates …
    run.failure = error.what();
  }
  return run;
}

RefinedRun refined_run_of(const NestedRun& nested) {
  if (!nested.analysis) return {nested.failure, {}, {}, {}, 0.0};
  const Analysis& analysis = *nested.analysis;
  return {
      {},
      values_of(analysis),
      analysis.trajectory.time,
      analysis.histories,
      static_cast<double>(analysis.trajectory.steps()) * analysis.model.mechanism.system->size()};
}

RefinedRun make_refined_run(const ProblemFile& problem, const Eigen::VectorXd& x,
                            const Refinement& refinement, const Trajectory* similar) {
  return refined_run_of(simulate_refined(problem, x, refinement, similar));
}

void RefinedRuns::keep(const Refinement& refinement, RefinedRun run) {
  runs_.insert_or_assign(refinement, std::move(run));
}

std::vector<const RefinedRun*> RefinedRuns::runs(const std::vector<Refinement>& refinements,
                                                 const Trajectory* similar) {
  std::vector<decltype(runs_)::value_type*> missing;
  std::vector<const RefinedRun*> all;
  for (const Refinement& refinement : refinements) {
    const auto [entry, is_new] = runs_.try_emplace(refinement);
    if (is_new) missing.push_back(&*entry);
    all.push_back(&entry->second);
  }
  for_each_in_parallel(int_size(missing), available_threads(), [&](int i) {
    missing[i]->second = make_refined_run(problem_, x_, missing[i]->first, similar);
  });
  return all;
}

bool has_reduced_beams(const Model& model, const ProblemFile& problem) {
  return std::ranges::any_of(problem.scene.bodies, [&](const Body& body) {
    const auto* beam = std::get_if<BeamBody>(&body.shape);
    return beam && beam->reduction && model.body(body.name).is_elastic;
  });
}

int mesh_size(const ProblemFile& problem) {
  int sum = 0;
  for (const auto& [name, size] : mesh_sizes(problem)) sum += size;
  return sum;
}

bool can_be_halved(const Model& model, const ProblemFile& problem) {
  const std::map<std::string, int> sizes = mesh_sizes(problem),
                                   halves = mesh_sizes(refined(problem, {.elements = 0.5}));
  return std::ranges::all_of(sizes, [&](const auto& one) {
    const auto& [name, size] = one;
    const int most = (size + 1) / 2 + size / 8;
    return !model.body(name).is_elastic || halves.at(name) <= most;
  });
}

std::optional<int> fewest_elements(const Model& model, const ProblemFile& problem) {
  std::optional<int> fewest;
  for (const Body& body : problem.scene.bodies) {
    const auto* beam = std::get_if<BeamBody>(&body.shape);
    if (!beam || !model.body(body.name).is_elastic) continue;
    for (const Segment& segment : beam->segments) {
      fewest = std::min(fewest.value_or(segment.elements), segment.elements);
    }
  }
  return fewest;
}

}  // namespace pleuel
