#include "cli/commands/commands.hpp"
#include "cli/reports/effects_report.hpp"
#include "cli/reports/scene_report.hpp"
#include "cli/reports/setting_report.hpp"
#include "core/integration/period_map.hpp"
#include "core/trust/check_list.hpp"

namespace pleuel {

namespace {

/// A simulated design, and what is to be said of it.
struct Simulated {
  const Analysis& analysis;
  Monitors monitors;
  double seconds = 0.0;
  std::vector<std::string> warnings{};
  ErrorBars errors{};
  std::vector<Eigen::VectorXd> bands{};       ///< of histories
  std::vector<EffectInfluence> influences{};  ///< if they are asked for
  int consequences = 0;                       ///< so many of the last warnings are not told
  double check_seconds = 0.0;                 ///< of what the warnings are found by
  bool is_checked = true;
};

/// Simulations of more steps say what follows.
constexpr int many_steps = 10000;

/// Finds the warnings. An interrupt ends that, but not what is known.
void check_numbers(const ProblemInput& input, Scrutiny scrutiny, Simulated& run) {
  if (scrutiny != Scrutiny::none && run.analysis.trajectory.steps() > many_steps) {
    show(stderr, fmt::format("simulated in {}; checking the numbers …\n", duration(run.seconds)));
  }
  const Stopwatch check;
  try {
    TrustedRun judged{input.problem, input.design, run.analysis, run.monitors, scrutiny};
    if (input.choice) judged.known = &input.choice->bars;
    Trust trust = judge_run(judged);
    run.warnings = texts_of(trust.findings);
    run.consequences = count_consequences(trust.findings);
    run.errors = std::move(trust.errors);
    run.bands = std::move(trust.bands);
  } catch (const Stopped&) {
    run.is_checked = false;
    run.warnings = {
        "interrupted while the numbers were checked: what speaks against them is not "
        "known"};
  }
  run.check_seconds = check.seconds();
}

/// How the start of a motion that repeats itself was found; nothing for others.
void add_periodic_start(const Trajectory& trajectory, Json& document) {
  if (!trajectory.periodic) return;
  const PeriodicStart& found = *trajectory.periodic;
  document["periodic_state"] = {{"period", found.period},
                                {"simulated_periods", found.simulations},
                                {"differentiated_periods", found.differentiations},
                                {"gap", found.gap},
                                {"growth", found.growth}};
}

std::string periodic_text(const Trajectory& trajectory) {
  if (!trajectory.periodic) return {};
  const PeriodicStart& found = *trajectory.periodic;
  return wrapped(fmt::format(
      "Periodic state found by {} simulated periods of {} and {} differentiated; after a period it "
      "is off by {:.1e} of the scale of a coordinate, and {:.2g} of a disturbance is left.\n",
      found.simulations, duration(found.period), found.differentiations, found.gap, found.growth));
}

Json simulation_document(const ProblemFile& problem, const Simulated& run) {
  const Analysis& analysis = run.analysis;
  const Trajectory& trajectory = analysis.trajectory;
  const System& system = *analysis.model.mechanism.system;
  Json document = {{"status", run.is_checked ? "done" : "interrupted"},
                   {"responses", responses_document(problem, analysis, run.errors)},
                   {"steps", trajectory.steps()},
                   {"split_steps", trajectory.split_steps},
                   {"rejected_steps", trajectory.rejected_steps},
                   {"newton_iterations", trajectory.newton_iterations},
                   {"factorizations", trajectory.factorizations},
                   {"seconds", run.seconds},
                   {"check_seconds", run.check_seconds},
                   {"monitors", monitors_document(run.monitors)},
                   {"warnings", run.warnings},
                   {"effects", effects_document(problem, analysis.model, run.influences)},
                   {"coordinates", system.coordinates()},
                   {"multipliers", system.multipliers()}};
  add_periodic_start(trajectory, document);
  return document;
}

Eigen::VectorXd step_sizes(const Trajectory& trajectory) {
  const Eigen::Index steps = trajectory.steps();
  return trajectory.time.tail(steps) - trajectory.time.head(steps);
}

/// Of a structure, which cannot move, as joints hold all bodies: what may be meant, or an axis that is wrong.
std::string held_text(const Analysis& analysis) {
  if (has_drives(analysis.model)) return "";
  const DegreesOfFreedom freedoms =
      rigid_degrees_of_freedom(analysis.model.mechanism, analysis.trajectory.state_at(0));
  return freedoms.free() > 0 ? "" : freedoms_text(freedoms, analysis.model);
}

/// @param design  where it comes from, if it is not the start
std::string simulation_text(const ProblemFile& problem, const std::string& design,
                            const Json& limits, const Simulated& run) {
  const Analysis& analysis = run.analysis;
  const Trajectory& trajectory = analysis.trajectory;
  std::string text = fmt::format(
      "{}{}: {}\n{}\n{}\n{}", problem.name, design, size_text(analysis), held_text(analysis),
      responses_text(problem, analysis, run.errors) + limits_text(problem, limits),
      monitors_text(run.monitors, analysis.model.mechanism.system->multipliers()) +
          assembly_text(analysis) + warnings_text(run.warnings, run.consequences));
  if (!run.influences.empty()) {
    text += influences_text({problem, values_of(analysis), run.influences}, true) + "\n";
  }
  if (trajectory.split_steps > 0) {
    text += wrapped(
        fmt::format("Newton's method failed in {} steps, which were split; look there with a "
                    "smaller /simulation/step.\n",
                    trajectory.split_steps));
  }
  if (problem.simulation.local_error > 0.0) {
    const Eigen::VectorXd sizes = step_sizes(trajectory);
    text += fmt::format("Steps from {} to {}, {} of them made again.\n", duration(sizes.minCoeff()),
                        duration(sizes.maxCoeff()), trajectory.rejected_steps);
  }
  text += periodic_text(trajectory);
  return text + fmt::format("{}, {} Newton iterations, {} factorizations; checked in {}\n",
                            duration(run.seconds), trajectory.newton_iterations,
                            trajectory.factorizations, duration(run.check_seconds));
}

/// Of a simulation that fails, what speaks against its numbers and against the motion before is shown.
std::unique_ptr<Analysis> analyze_or_doubt(const ProblemInput& input) {
  try {
    return analyze(input.problem, input.design, values_only);
  } catch (const SimulationError& error) {
    std::vector<Finding> findings = check_proportions_before(input.problem, input.design);
    try {
      if (findings.empty() && error.time()) {
        findings = findings_before_failure(input.problem, input.design, *error.time());
      }
    } catch (const Stopped&) {  // who does not wait for it sees the error
    }
    show(stderr, warnings_text(texts_of(findings)));
    throw;
  }
}

}  // namespace

Outcome run_simulate(const Arguments& arguments) {
  const ProblemInput input = read_input_with_accuracy(arguments);
  RunRecord record(arguments, input, Json::object());
  record.begin_phase("simulate");
  const Stopwatch stopwatch;
  const std::shared_ptr<Analysis> analysis = analyze_or_doubt(input);
  const double seconds = stopwatch.seconds();
  record.begin_phase("monitor");
  Simulated run{*analysis, monitor(analysis->model, analysis->trajectory), seconds};
  check_numbers(input, arguments.scrutiny, run);
  if (arguments.wants_all_warnings) run.consequences = 0;
  if (arguments.wants_effects && run.is_checked) {
    try {
      run.influences = effect_influences(input.problem, input.design, InfluenceTimes::measured);
    } catch (const Stopped&) {
      run.is_checked = false;
    }
  }
  record.begin_phase("write");
  const std::string design = arguments.design ? " at " + arguments.design->string() : "";
  const Json limits = limits_document(input.problem, input.design, *analysis, run.errors);
  const bool is_refuted = tries_a_design(arguments) && !broken_limits(limits).empty();
  Outcome outcome{run.is_checked && !is_refuted ? ExitCode::done : ExitCode::not_verified,
                  simulation_document(input.problem, run),
                  simulation_text(input.problem, design, limits, run)};
  mark_effects({input.problem, values_of(*analysis), run.influences}, outcome.document["effects"]);
  if (input.choice) outcome.document["setting"] = setting_document(input, *input.choice);
  outcome.document["variables"] = variables_document(input.problem, input.design);
  outcome.document["constraints"] = limits;
  record.write_result(outcome.document);
  write_trajectory(record.result("trajectory.csv"), *analysis, run.bands);
  record.finish(outcome, [&] {
    return run_picture(input.problem, {{input.design_name, input.design, analysis, run.bands}});
  });
  return outcome;
}

}  // namespace pleuel
