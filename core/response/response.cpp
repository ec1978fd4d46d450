#include "core/response/response.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/response/body_frequency.hpp"
#include "core/response/buckling_signal.hpp"
#include "core/response/drift_signal.hpp"
#include "core/response/drive_signals.hpp"
#include "core/response/energy_signals.hpp"
#include "core/response/imported_signals.hpp"
#include "core/response/least_norm_signal.hpp"
#include "core/response/mechanism_modes.hpp"
#include "core/response/motion_signals.hpp"
#include "core/response/projected_signal.hpp"
#include "core/response/reaction_signal.hpp"
#include "core/response/stress_signal.hpp"
#include "core/scene/response_quantity.hpp"

namespace pleuel {

namespace {

void set_mass(const ResponseSettings& settings, const Model& model, Response& response) {
  response.constant_x = Eigen::VectorXd::Zero(model.mechanism.system->variables());
  for (const BodyModel& body : model.bodies) {
    const bool is_counted = settings.bodies.empty() ||
                            std::find(settings.bodies.begin(), settings.bodies.end(), body.name) !=
                                settings.bodies.end();
    if (!is_counted) continue;
    response.constant += body.mass;
    response.constant_x += body.mass_x;
  }
}

class ResponseMaker {
 public:
  /// @param norm  of the model; null without redundant constraints
  ResponseMaker(const ResponseSettings& settings, const Model& model,
                std::shared_ptr<LeastNorm> norm)
      : settings_(settings), model_(model), norm_(std::move(norm)) {}

  Response make() {
    response_.name = settings_.name;
    response_.unit = quantity_of(settings_).unit;
    response_.over_time = settings_.over_time;
    response_.from = settings_.from;
    response_.to = settings_.to;
    switch (settings_.type) {
      case ResponseType::mass:
        set_mass(settings_, model_, response_);
        break;
      case ResponseType::frequency:
        set_frequency();
        break;
      case ResponseType::stress:
      case ResponseType::buckling:
        if (body().is_beam()) check_section_forces();
        [[fallthrough]];
      case ResponseType::deflection:
      case ResponseType::position:
      case ResponseType::velocity:
      case ResponseType::acceleration:
        set_body_signal();
        break;
      case ResponseType::drive_torque:
      case ResponseType::drive_force:
        set_multiplier_signal(make_drive_effort_signal(driven_joint()));
        break;
      case ResponseType::drive_power:
        set_multiplier_signal(make_drive_power_signal(driven_joint()));
        break;
      case ResponseType::reaction_force:
        set_reaction(ReactionPart::Kind::force);
        break;
      case ResponseType::reaction_moment:
        set_reaction(ReactionPart::Kind::moment);
        break;
      case ResponseType::kinetic_energy:
        response_.signal = make_kinetic_energy_signal(model_, settings_.bodies);
        break;
      case ResponseType::elastic_energy:
        response_.signal = make_elastic_energy_signal(model_, settings_.bodies);
        break;
      case ResponseType::energy_balance:
        response_.signal = make_energy_and_power_signal(model_);
        response_.is_balance = true;
        break;
      case ResponseType::constraint_drift:
        if (model_.mechanism.system->multipliers() == 0) fail("the mechanism has no constraints");
        response_.signal = make_drift_signal(model_, settings_.level);
        break;
    }
    return std::move(response_);
  }

 private:
  [[noreturn]] void fail(const std::string& why) const {
    throw InputError(
        fmt::format("the response \"{}\" cannot be computed: {}", settings_.name, why));
  }

  int variables() const { return model_.mechanism.system->variables(); }
  const BodyModel& body() const { return model_.body(settings_.bodies.front()); }

  void set_frequency() {
    if (settings_.bodies.empty()) {
      response_.mechanism_mode = settings_.mode;
      return;
    }
    const FrequencyWithDerivatives frequency = body_frequency(body(), settings_.mode, variables());
    response_.constant = frequency.value;
    response_.constant_x = frequency.derivatives;
  }

  /// Section forces come from strain.
  void check_section_forces() const {
    const BodyModel& body = this->body();
    if (!body.is_elastic) fail(fmt::format("\"{}\" is rigid", body.name));
    const bool needs_axial =
        settings_.type == ResponseType::buckling || settings_.part == StressPart::axial;
    if (needs_axial && !has_axial_displacement(body)) {
      fail(fmt::format("\"{}\" has no axial elasticity", body.name));
    }
    const bool has_strength = body.beam.elements.front().strength > 0.0;
    if (settings_.part == StressPart::utilization && !has_strength) {
      fail(fmt::format("the material of \"{}\" has no strength", body.name));
    }
  }

  static bool has_axial_displacement(const BodyModel& body) {
    const ElasticCoordinates& coordinates = *body.coordinates;
    for (int node = 0; node < coordinates.node_count(); ++node) {
      if (coordinates.index(node, 0) >= 0) return true;
    }
    return false;
  }

  void set_body_signal() {
    const BodyModel& body = this->body();
    if (body.is_imported()) {
      response_.signal = make_imported_signal(body);
    } else if (!body.basis) {
      response_.signal = make_body_signal(body);
    } else {
      project(make_body_signal(*body.nodal), body.map);
    }
  }

  void project(std::unique_ptr<Signal> signal, const CoordinateMap& map) {
    response_.signal = std::make_unique<ProjectedSignal>(std::move(signal), map, variables());
  }

  std::unique_ptr<Signal> make_body_signal(const BodyModel& body) const {
    const PlaceMotion place{settings_.at, settings_.direction};
    switch (settings_.type) {
      case ResponseType::stress:
        return make_stress_signal(body, model_.gravity, settings_.part,
                                  {settings_.segment, settings_.station});
      case ResponseType::buckling:
        return make_buckling_signal(body, model_.gravity);
      case ResponseType::deflection:
        return make_deflection(body);
      case ResponseType::position:
        return make_position_signal(body, place);
      case ResponseType::velocity:
        return make_velocity_signal(body, place);
      default:
        return make_acceleration_signal(body, place);
    }
  }

  std::unique_ptr<Signal> make_imported_signal(const BodyModel& body) const {
    const bool needs_strain =
        settings_.type == ResponseType::stress || (settings_.type == ResponseType::deflection &&
                                                   settings_.against == DeflectionReference::frame);
    if (needs_strain && !body.is_elastic) fail(fmt::format("\"{}\" is rigid", body.name));
    const auto motion = [&](TimeDerivative derivative) {
      return make_imported_motion_signal(body, settings_.place, settings_.direction, derivative);
    };
    switch (settings_.type) {
      case ResponseType::stress:
        return make_imported_stress_signal(body, model_.gravity, settings_.part);
      case ResponseType::velocity:
        return motion(TimeDerivative::first);
      case ResponseType::acceleration:
        return motion(TimeDerivative::second);
      case ResponseType::deflection:
        if (settings_.against == DeflectionReference::frame) {
          return make_imported_deflection_signal(body, settings_.place, settings_.direction);
        }
        [[fallthrough]];
      default:  // also against the rigid mechanism, see make_deflection()
        return motion(TimeDerivative::none);
    }
  }

  std::unique_ptr<Signal> make_deflection(const BodyModel& body) const {
    switch (settings_.against) {
      case DeflectionReference::frame:
        return make_deflection_signal(body, settings_.at, settings_.direction);
      case DeflectionReference::chord:
        return make_chord_deflection_signal(body, settings_.at, settings_.direction);
      default:  // the position in the rigid mechanism is taken off afterwards
        return make_position_signal(body, {settings_.at, settings_.direction});
    }
  }

  const JointModel& driven_joint() const {
    const JointModel& joint = model_.joint(settings_.joint);
    if (joint.drive_row < 0) fail(fmt::format("the joint \"{}\" has no drive", joint.name));
    return joint;
  }

  void set_reaction(ReactionPart::Kind kind) {
    const JointModel& joint = model_.joint(settings_.joint);
    auto signal = make_reaction_signal(joint, {kind, settings_.direction});
    if (joint.map) {
      signal = std::make_unique<ProjectedSignal>(std::move(signal), *joint.map, variables());
    }
    set_multiplier_signal(std::move(signal));
  }

  /// Where constraints are redundant, multipliers are those of least norm.
  void set_multiplier_signal(std::unique_ptr<Signal> signal) {
    if (norm_) {
      response_.signal = std::make_unique<LeastNormSignal>(std::move(signal), norm_, model_);
    } else {
      response_.signal = std::move(signal);
    }
  }

  const ResponseSettings& settings_;
  const Model& model_;
  std::shared_ptr<LeastNorm> norm_;
  Response response_;
};

/// The whole mechanism's frequencies at the initial state.
void set_mechanism_frequencies(Analysis& analysis) {
  Eigen::VectorXd frequencies;
  for (Response& response : analysis.responses) {
    if (!response.mechanism_mode) continue;
    if (frequencies.size() == 0) {
      State initial;
      analysis.trajectory.load(0, initial);
      frequencies = mechanism_frequencies(analysis.model.mechanism, initial);
    }
    if (*response.mechanism_mode >= frequencies.size()) {
      throw InputError(
          fmt::format("the response \"{}\" cannot be computed: the mechanism has {} natural "
                      "frequencies, not {}",
                      response.name, frequencies.size(), *response.mechanism_mode + 1));
    }
    response.constant = frequencies(*response.mechanism_mode);
  }
}

/// The problem without elasticity, for the positions that deflections are measured against.
ProblemFile without_elasticity(const ProblemFile& problem) {
  ProblemFile rigid = problem;
  rigid.effects.elasticity = EffectChoice::off;
  rigid.simulation.quasi_static_start = false;
  std::erase_if(rigid.responses, [](const ResponseSettings& response) {
    return response.against != DeflectionReference::rigid_mechanism;
  });
  for (ResponseSettings& response : rigid.responses) {
    response.type = ResponseType::position;
    response.against = DeflectionReference::frame;
  }
  return rigid;
}

/// Simulates the mechanism without elasticity where a response needs it.
void set_rigid_mechanism(const ProblemFile& problem, const Eigen::VectorXd& x, Analysis& analysis) {
  const ProblemFile rigid = without_elasticity(with_steps_of(analysis.trajectory, problem));
  if (rigid.responses.empty()) return;
  try {
    analysis.rigid = analyze(rigid, x);
  } catch (const SimulationError& error) {
    throw SimulationError(
        fmt::format("the mechanism without elasticity, which a deflection is measured against: {}",
                    error.what()));
  }
  std::size_t next = 0;
  for (std::size_t i = 0; i < problem.responses.size(); ++i) {
    if (problem.responses[i].against == DeflectionReference::rigid_mechanism) {
      analysis.responses[i].rigid_response = next++;
    }
  }
}

/// Reduces a history over time; that of a balance becomes the error at each instant.
Reduction reduce_history(const Response& response, const Eigen::VectorXd& time,
                         Eigen::MatrixXd& history) {
  const StepRange range = response.steps(time);
  if (!response.is_balance) return reduce(response.over_time, time, history, range);
  Reduction reduction = reduce_balance(time, history, range);
  history = balance_history(time, history, range);
  return reduction;
}

/// Observes all signals while the mechanism is simulated, so that no state is needed twice.
class Recorder {
 public:
  /// @param instants  as many as there are, if no step has to be split
  Recorder(const std::vector<Response>& responses, int instants) : responses_(responses) {
    for (const Response& response : responses) {
      histories_.emplace_back(response.signal ? response.signal->channels() : 0,
                              response.signal ? instants : 0);
    }
  }

  void see(int step, const State& state) {
    for (std::size_t i = 0; i < responses_.size(); ++i) {
      if (!responses_[i].signal) continue;
      if (step == histories_[i].cols()) {
        histories_[i].conservativeResize(Eigen::NoChange, step + step / 8 + 64);
      }
      responses_[i].signal->observe(state, histories_[i].col(step));
    }
  }

  std::vector<Eigen::MatrixXd> take(int instants) {
    for (Eigen::MatrixXd& history : histories_) {
      if (history.cols() > instants) history.conservativeResize(Eigen::NoChange, instants);
    }
    return std::move(histories_);
  }

 private:
  const std::vector<Response>& responses_;
  std::vector<Eigen::MatrixXd> histories_;
};

SimulationOptions options_of(const ProblemFile& problem) {
  const SimulationSettings& settings = problem.simulation;
  return {settings.end_time,
          settings.step,
          settings.spectral_radius,
          settings.newton_tolerance,
          settings.max_newton_iterations,
          settings.scheme,
          settings.formulation,
          settings.local_error,
          settings.smallest_step,
          settings.instants,
          problem.sensitivity.memory};
}

/// The history of a response, measured against the rigid mechanism if need be.
Eigen::MatrixXd against_rigid(const Response& response, Eigen::MatrixXd history,
                              const Analysis& analysis) {
  if (!response.rigid_response) return history;
  const Eigen::MatrixXd& rigid = analysis.rigid->histories[*response.rigid_response];
  if (rigid.cols() != history.cols()) {
    throw SimulationError(fmt::format(
        "the deflection \"{}\" cannot be compared with the mechanism without elasticity: steps had "
        "to be split in one of the two. Try a smaller /simulation/step",
        response.name));
  }
  return history - rigid;
}

}  // namespace

StepRange Response::steps(const Eigen::VectorXd& time) const {
  const StepRange range = steps_between(time, from, to);
  if (range.steps() >= 2) return range;
  throw InputError(
      fmt::format("the response \"{}\" is reduced over a window of time with less than two steps; "
                  "widen it or shorten the steps",
                  name));
}

std::vector<Response> make_responses(const std::vector<ResponseSettings>& settings,
                                     const Model& model) {
  std::shared_ptr<LeastNorm> norm;
  if (!model.mechanism.system->left_out().empty()) {
    norm = std::make_shared<LeastNorm>(model.mechanism);
  }
  std::vector<Response> responses;
  for (const ResponseSettings& setting : settings) {
    responses.push_back(ResponseMaker(setting, model, norm).make());
  }
  return responses;
}

Eigen::MatrixXd observe(Signal& signal, const Trajectory& trajectory) {
  Eigen::MatrixXd history(signal.channels(), trajectory.steps() + 1);
  State state;
  for (int step = 0; step <= trajectory.steps(); ++step) {
    trajectory.load(step, state);
    signal.observe(state, history.col(step));
  }
  return history;
}

Eigen::VectorXd start_design(const ProblemFile& problem) {
  Eigen::VectorXd x(static_cast<Eigen::Index>(problem.variables.size()));
  for (std::size_t i = 0; i < problem.variables.size(); ++i) {
    x(static_cast<Eigen::Index>(i)) = problem.variables[i].start;
  }
  return x;
}

ProblemFile with_steps_of(const Trajectory& trajectory, ProblemFile problem) {
  if (problem.simulation.local_error == 0.0) return problem;
  problem.simulation.instants.assign(trajectory.time.begin(), trajectory.time.end());
  return problem;
}

Eigen::VectorXd values_of(const Analysis& analysis) {
  Eigen::VectorXd values(static_cast<Eigen::Index>(analysis.reductions.size()));
  for (std::size_t i = 0; i < analysis.reductions.size(); ++i) {
    values(static_cast<Eigen::Index>(i)) = analysis.reductions[i].value;
  }
  return values;
}

std::unique_ptr<Analysis> analyze(const ProblemFile& problem, const Eigen::VectorXd& x) {
  const Eigen::VectorXd start = start_design(problem);
  const Design<double> design(x.begin(), x.end()), start_values(start.begin(), start.end());
  auto analysis = std::make_unique<Analysis>();
  analysis->model = build_model(problem.scene, problem.effects, start_values, design,
                                problem.sensitivity.invariants);
  analysis->model.mechanism.starts_in_equilibrium = problem.simulation.quasi_static_start;
  analysis->responses = make_responses(problem.responses, analysis->model);
  const SimulationOptions options = options_of(problem);
  Recorder recorder(analysis->responses, step_count(options) + 1);
  analysis->trajectory = simulate(analysis->model.mechanism, options,
                                  [&](int step, const State& state) { recorder.see(step, state); });
  analysis->histories = recorder.take(analysis->trajectory.steps() + 1);
  set_mechanism_frequencies(*analysis);
  set_rigid_mechanism(problem, x, *analysis);
  for (std::size_t i = 0; i < analysis->responses.size(); ++i) {
    const Response& response = analysis->responses[i];
    Reduction reduction;
    if (response.signal) {
      Eigen::MatrixXd& history = analysis->histories[i];
      history = against_rigid(response, std::move(history), *analysis);
      reduction = reduce_history(response, analysis->trajectory.time, history);
    } else {
      reduction.value = response.constant;
    }
    analysis->reductions.push_back(std::move(reduction));
  }
  return analysis;
}

}  // namespace pleuel
