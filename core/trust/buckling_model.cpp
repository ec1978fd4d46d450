#include "core/trust/buckling_model.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/base/int_size.hpp"
#include "core/linear/elastic_stability.hpp"
#include "core/model/state_in_space.hpp"
#include "core/response/full_mechanism.hpp"

namespace pleuel {

namespace {

/// A beam of one element buckles late, at 12 EI/L² between pins, or never, between clamps; with two the
/// largest error of Euler's cases is 3 %.
constexpr int fewest_elements_to_buckle = 2;

int elements_of(const Model& model, const std::string& beam) {
  int elements = 0;
  for (const BodyModel* part : model.parts(beam)) elements += int_size(part->beam.elements);
  return elements;
}

/// Whether the mesh of a body is too coarse to buckle.
bool is_coarse(const Body& body, const Model& model) {
  return std::holds_alternative<BeamBody>(body.shape) &&
         model.parts(body.name).front()->is_elastic &&
         elements_of(model, body.name) < fewest_elements_to_buckle;
}

/// A point between the ends of a beam; of ends that follow different variables, as they are at a design.
Point between(const BeamBody& beam, double share, const Design<double>& design) {
  Point point;
  for (std::size_t i = 0; i < 3; ++i) {
    const Number &from = beam.from[i], &to = beam.to[i];
    const auto mix = [share](double a, double b) { return (1.0 - share) * a + share * b; };
    point[i] = mix(resolve(from, design), resolve(to, design));
    const bool follow_one = !from.expression && !to.expression && from.variable == to.variable;
    if (!follow_one) continue;
    point[i] = from;
    point[i].constant = mix(from.constant, to.constant);
    point[i].factor = mix(from.factor, to.factor);
  }
  return point;
}

/// Joints with the ground in place of what holds beams from outside.
void add_outside_holds(const Eigen::VectorXd& x, Scene& scene) {
  const Design<double> design(x.begin(), x.end());
  for (const Body& body : scene.bodies) {
    const auto* beam = std::get_if<BeamBody>(&body.shape);
    if (beam == nullptr || !beam->held) continue;
    std::vector<double> places = beam->held->at;
    constexpr int many = 8;
    for (int i = 0; i <= many && beam->held->at.empty(); ++i) places.push_back(double(i) / many);
    for (std::size_t i = 0; i < places.size(); ++i) {
      Joint joint;
      joint.name = fmt::format("{} held {}", body.name, i);
      joint.type = JointType::point_on_plane;
      joint.bodies = {ground_name, body.name};
      joint.at = between(*beam, places[i], design);
      joint.axis = beam->held->direction;
      scene.joints.push_back(joint);
    }
  }
}

}  // namespace

bool is_held(const Body& body) {
  const auto* beam = std::get_if<BeamBody>(&body.shape);
  return beam != nullptr && beam->held;
}

bool shows_buckling(const Scene& scene, const Model& model) {
  const auto shows_it = [](const BodyModel& body) {
    const bool is_elastic_beam = body.is_beam() && body.is_elastic;
    return body.frame.rotation != RotationCoordinates::angle &&
           (!is_elastic_beam || body.has_stiffening);
  };
  const auto prevents_it = [&](const Body& body) {
    return is_held(body) || is_coarse(body, model);
  };
  return std::ranges::none_of(scene.bodies, prevents_it) &&
         std::ranges::all_of(model.bodies, shows_it);
}

ProblemFile problem_in_space(const TrustedRun& run) {
  ProblemFile space = with_all_modes(run.problem);
  space.effects.geometric_stiffening = EffectChoice::on;
  space.simulation.moves_by_bending = true;  // it was asked already
  space.responses.clear();
  space.sensitivity.memory = SensitivitySettings().memory;
  for (Body& body : space.scene.bodies) {
    if (!is_coarse(body, run.analysis.model)) continue;
    auto& beam = std::get<BeamBody>(body.shape);
    beam.pieces = std::max(beam.pieces, fewest_elements_to_buckle);
  }
  add_outside_holds(run.x, space.scene);
  return space;
}

bool is_firm_in_space(const ProblemFile& space, const TrustedRun& run,
                      const std::set<int>& instants) {
  const Eigen::VectorXd start_values = start_design(space);
  const Design<double> start(start_values.begin(), start_values.end());
  const Design<double> design(run.x.begin(), run.x.end());
  try {
    Model model = build_model(space.scene, space.effects, start, design);
    return std::ranges::none_of(instants, [&](int instant) {
      State state;
      run.analysis.trajectory.states->load(instant, state);
      const std::optional<State> here = state_in_space(run.analysis.model, state, model);
      return !here || may_grow(model.mechanism, *here);
    });
  } catch (const SimulationError&) {  // the run in space says why
  } catch (const InputError&) {
  }
  return false;
}

}  // namespace pleuel
