#include "core/response/analysis.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/machine_memory.hpp"
#include "core/linear/modes.hpp"
#include "core/mobility/lock.hpp"
#include "core/response/expression_value.hpp"
#include "core/response/history_reduction.hpp"
#include "core/response/make_responses.hpp"
#include "core/response/modal_vectors.hpp"
#include "core/response/monitors.hpp"
#include "core/response/recorder.hpp"
#include "core/response/validity.hpp"
#include "core/response/whole_turns.hpp"
#include "core/scene/time_breaks.hpp"
#include "core/start/equilibrium.hpp"
#include "core/start/initial_state.hpp"

namespace pleuel {

namespace {

bool asks_for_modes(const ProblemFile& problem) {
  return std::ranges::any_of(problem.responses,
                             [](const ResponseSettings& one) { return one.is<ModeResponse>(); });
}

/// What the model leaves out of the motion is part of its frequencies.
void set_full_mechanism(const ProblemFile& problem, const Design<double>& start,
                        const Design<double>& design, const Differentiation& differentiation,
                        Analysis& analysis) {
  if (!asks_for_modes(problem) || has_all_modes(problem, analysis.model)) return;
  try {
    analysis.full = make_full_mechanism(problem, start, design, differentiation);
  } catch (const SimulationError& error) {
    analysis.modes_left_out = error.what();
  }
}

/// Of responses that count damping or do not, in some axes.
void choose_modes(bool is_damped, MotionAxes::Kind axes, Analysis& analysis) {
  std::optional<LinearizedModes> mechanism;
  const auto first = static_cast<int>(analysis.damped_modes.size());
  for (std::size_t i = 0; i < analysis.responses.size(); ++i) {
    const Response& response = analysis.responses[i];
    if (!response.mode()) continue;
    const ModeChoice& choice = *response.mode();
    if (choice.counts_damping() != is_damped || axes_of(choice) != axes) continue;
    if (!mechanism) {
      mechanism.emplace(model_of_modes(analysis), analysis.vibrating->initial.state, is_damped,
                        axes);
    }
    try {
      analysis.mechanism_modes[i] = (is_damped ? first : 0) + find_mode(*mechanism, choice);
    } catch (const SimulationError& error) {
      throw SimulationError(refused_response(response.name, error.what()));
    } catch (const InputError& error) {
      // How many modes there are with damping changes with the design.
      if (is_damped) throw SimulationError(refused_response(response.name, error.what()));
      refuse_response(response.name, error.what());
    }
  }
  if (!mechanism) return;
  if (is_damped) {
    Eigen::VectorXcd all(first + mechanism->modes.size());
    all << analysis.damped_modes, mechanism->modes;
    analysis.damped_modes = std::move(all);
  } else {
    analysis.mechanism_frequencies = mechanism->modes.unaryExpr(&frequency_of).real();
  }
}

void set_modes(Analysis& analysis) {
  analysis.mechanism_modes.assign(analysis.responses.size(), 0);
  if (!std::ranges::any_of(analysis.responses,
                           [](const Response& response) { return response.mode(); })) {
    return;
  }
  analysis.vibrating =
      analysis.full ? analysis.full->vibrating : vibration_state(analysis.model.mechanism);
  choose_modes(false, MotionAxes::Kind::standing, analysis);
  choose_modes(true, MotionAxes::Kind::standing, analysis);
  choose_modes(true, MotionAxes::Kind::rotor, analysis);
}

/// The problem without elasticity, for the positions that deflections are measured against.
ProblemFile without_elasticity(const ProblemFile& problem) {
  ProblemFile rigid = problem;
  rigid.effects.elasticity = EffectChoice::off;
  rigid.simulation.quasi_static_start = false;
  rigid.responses.clear();
  for (ResponseSettings response : problem.responses) {
    const auto* deflection = std::get_if<DeflectionResponse>(&response.what);
    if (!is_against_rigid_mechanism(response)) continue;
    response.what = PointMotionResponse{deflection->point, {deflection->direction}};
    rigid.responses.push_back(std::move(response));
  }
  return rigid;
}

/// Simulates the mechanism without elasticity where a response needs it.
void set_rigid_mechanism(const ProblemFile& problem, Analysis& analysis) {
  const ProblemFile rigid = without_elasticity(with_steps_of(analysis.trajectory, problem));
  if (rigid.responses.empty()) return;
  try {
    analysis.rigid =
        analyze(rigid, analysis.x, {.has_derivatives = analysis.model.has_derivatives});
  } catch (const SimulationError& error) {
    std::string why = error.what();
    if (analysis.rigid_path.end == RigidPath::End::bends) {
      why = bending_text(analysis.model) + " (" + why + ")";
    }
    throw SimulationError(fmt::format(
        "the mechanism without elasticity, which a deflection is measured against: {}", why));
  }
}

/// Model and responses.
void build(const ProblemFile& problem, bool has_derivatives, Analysis& analysis) {
  const Eigen::VectorXd start = start_design(problem);
  const Design<double> design(analysis.x.begin(), analysis.x.end()),
      start_values(start.begin(), start.end());
  Differentiation differentiation;
  if (has_derivatives) differentiation = problem.sensitivity.invariants;
  analysis.model =
      build_model(problem.scene, problem.effects, start_values, design, differentiation);
  analysis.model.mechanism.starts_in_equilibrium = problem.simulation.quasi_static_start;
  set_full_mechanism(problem, start_values, design, differentiation, analysis);
  analysis.responses = make_responses(problem.responses, analysis.model, model_of_modes(analysis));
}

/// Where windows of responses begin and end [s]: there are instants.
std::vector<double> window_ends(const ProblemFile& problem) {
  std::vector<double> ends;
  for (const ResponseSettings& response : problem.responses) {
    for (const std::optional<double>& end : {response.from, response.to}) {
      if (end) ends.push_back(*end);
    }
  }
  return ends;
}

SimulationOptions options_of(const ProblemFile& problem) {
  SimulationOptions options{problem.simulation};
  options.breaks = time_breaks(problem.scene, options);
  const std::vector<double> ends = window_ends(problem);
  options.breaks.insert(options.breaks.end(), ends.begin(), ends.end());
  options.memory = problem.sensitivity.memory;
  return options;
}

/// @throws the error, after what of the joints may be its cause
[[noreturn]] void explain(const SimulationError& error, const Model& model, const RigidPath& path) {
  constexpr double largest = 3e-2;
  std::vector<std::string> causes;
  if (path.end == RigidPath::End::bends) causes.push_back(bending_text(model) + ".");
  for (const Misalignment& found : find_misalignments(model, model.mechanism.guess, largest)) {
    causes.push_back(found.text());
  }
  if (causes.empty()) throw error;
  throw SimulationError(fmt::format("{} That may be why: {}", fmt::join(causes, " "), error.what()),
                        error.time());
}

void require_memory(const std::vector<Response>& responses, const TimeIntegration& options) {
  double channels = 1.0;  // the time
  std::set<const Signal*> signals;
  for (const Response& response : responses) {
    if (!response.history()) continue;
    const Signal* signal = response.history()->signal.get();
    if (signals.insert(signal).second) channels += signal->channels();
  }
  const double steps = options.end_time / options.step;
  const double needed = sizeof(double) * channels * steps, there = machine_memory();
  if (needed <= there) return;
  throw InputError(
      fmt::format("{:.3g} steps with {:.0f} numbers each, those of the responses, take {:.3g} GB, "
                  "but the machine has {:.3g} GB: take a longer /simulation/step, a shorter "
                  "/simulation/end_time, or ask for a stress \"at\" a place, not of a whole body",
                  steps, channels, needed * 1e-9, there * 1e-9));
}

/// The history of a response, measured against the rigid mechanism if need be.
Eigen::MatrixXd against_rigid(const Response& response, const Eigen::MatrixXd& history,
                              const Analysis& analysis) {
  const std::optional<std::size_t>& reference = response.history()->rigid_response;
  if (!reference) return history;
  const Eigen::MatrixXd& rigid = analysis.rigid->histories[*reference];
  if (rigid.cols() != history.cols()) {
    throw SimulationError(fmt::format(
        "the deflection \"{}\" cannot be compared with the mechanism without elasticity: steps had "
        "to be split in one of the two. Try a smaller /simulation/step",
        response.name));
  }
  return history - rigid;
}

/// The number of a response; its history becomes that which is reduced.
Reduction reduce_response(std::size_t i, ShortWindow short_window, Analysis& analysis) {
  const Response& response = analysis.responses[i];
  if (short_window == ShortWindow::unknown && !response.holds_steps(analysis.trajectory.time)) {
    return {std::numeric_limits<double>::quiet_NaN(), {}, {}};
  }
  if (const ResponseHistory* history = response.history()) {
    if (history->rigid_response || history->map) {
      analysis.histories.set(
          i, mapped_history(response, analysis.trajectory.time,
                            against_rigid(response, analysis.histories[i], analysis)));
    }
    return reduce_history(response, analysis.trajectory, analysis.histories[i], analysis.breaks);
  }
  Reduction constant;
  if (response.expression()) {
    constant.value = numbers_of(analysis.responses, analysis.reductions, analysis.x).value(i);
    return constant;
  }
  const ModeChoice* mode = response.mode();
  const int number = analysis.mechanism_modes[i];
  if (!mode) {
    constant.value = std::get<DesignConstant>(response.source).value;
  } else if (mode->counts_damping()) {
    constant.value = number_of(mode->of, analysis.damped_modes(number));
  } else {
    constant.value = analysis.mechanism_frequencies(number);
  }
  return constant;
}

/// Expressions come last, in the order of the file: they may name expressions before them.
void reduce_responses(ShortWindow short_window, Analysis& analysis) {
  analysis.reductions.resize(analysis.responses.size());
  for (const bool of_expressions : {false, true}) {
    for (std::size_t i = 0; i < analysis.responses.size(); ++i) {
      const bool is_expression = analysis.responses[i].expression() != nullptr;
      if (is_expression != of_expressions) continue;
      analysis.reductions[i] = reduce_response(i, short_window, analysis);
    }
  }
}

}  // namespace

Eigen::VectorXd start_design(const ProblemFile& problem) {
  Eigen::VectorXd x(problem.variables.size());
  for (std::size_t i = 0; i < problem.variables.size(); ++i) {
    x(i) = problem.variables[i].start;
  }
  return x;
}

void require_memory(const ProblemFile& problem) {
  const Eigen::VectorXd start = start_design(problem);
  const Design<double> x(start.begin(), start.end());
  const Model model = build_model(problem.scene, problem.effects, x, x, std::nullopt);
  require_memory(make_responses(problem.responses, model, model), problem.simulation);
}

ProblemFile with_steps_of(const Trajectory& trajectory, ProblemFile problem) {
  const bool is_regular = problem.simulation.local_error == 0.0 && window_ends(problem).empty();
  if (is_regular) return problem;
  problem.simulation.instants.assign(trajectory.time.begin(), trajectory.time.end());
  return problem;
}

const Model& model_of_modes(const Analysis& analysis) {
  return analysis.full ? analysis.full->model : analysis.model;
}

Eigen::VectorXd values_of(const Analysis& analysis) {
  Eigen::VectorXd values(analysis.reductions.size());
  for (std::size_t i = 0; i < analysis.reductions.size(); ++i) {
    values(i) = analysis.reductions[i].value;
  }
  return values;
}

std::unique_ptr<Analysis> analyze(const ProblemFile& problem, const Eigen::VectorXd& x,
                                  const AnalysisOptions& asked) {
  if (problem.has_cases()) throw std::logic_error("load cases are simulated one by one");
  auto analysis = std::make_unique<Analysis>();
  analysis->x = x;
  build(problem, asked.has_derivatives, *analysis);
  require_memory(analysis->responses, problem.simulation);
  SimulationOptions options = options_of(problem);
  options.similar = asked.similar;
  if (!problem.simulation.moves_by_bending) {
    analysis->rigid_path = follow_drives(analysis->model, options.end_time, options.step);
    require_no_lock(analysis->model, analysis->rigid_path);
  }
  Recorder recorder(analysis->responses, step_count(options) + 1);
  ConstraintGuard guard(analysis->model, options);
  try {
    analysis->trajectory =
        simulate(analysis->model.mechanism, options, [&](int step, const State& state) {
          recorder.see(step, state);
          guard.see(step, state);
        });
  } catch (const UnstableEquilibrium&) {
    throw;
  } catch (const SimulationError& error) {
    explain(error, analysis->model, analysis->rigid_path);
  }
  analysis->breaks = instants_at(time_breaks(problem.scene, options), analysis->trajectory.time);
  analysis->histories = recorder.take(analysis->trajectory.steps() + 1);
  for (std::size_t i = 0; i < problem.responses.size(); ++i) {
    if (!is_counted_angle(problem.responses[i])) continue;
    Eigen::MatrixXd angles = analysis->histories[i];
    count_turns(angles);
    analysis->histories.set(i, std::move(angles));
  }
  set_modes(*analysis);
  set_rigid_mechanism(problem, *analysis);
  reduce_responses(asked.short_window, *analysis);
  require_finite(analysis->responses, analysis->histories, analysis->trajectory);
  if (asked.short_window == ShortWindow::refused) {
    require_finite(analysis->responses, analysis->reductions);
  }
  return analysis;
}

std::unique_ptr<Analysis> with_derivatives(const ProblemFile& problem,
                                           std::unique_ptr<Analysis> analysis) {
  if (analysis->model.has_derivatives) return analysis;
  // States that are simulated again are those of the model that they belong to.
  if (analysis->trajectory.recomputed()) return analyze(problem, analysis->x);
  build(problem, true, *analysis);
  if (analysis->rigid) {
    const ProblemFile rigid = without_elasticity(with_steps_of(analysis->trajectory, problem));
    analysis->rigid = with_derivatives(rigid, std::move(analysis->rigid));
  }
  return analysis;
}

}  // namespace pleuel
