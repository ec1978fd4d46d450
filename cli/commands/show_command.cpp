
#include "cli/commands/commands.hpp"
#include "cli/files/report_page.hpp"
#include "cli/reports/effects_report.hpp"
#include "cli/reports/scene_report.hpp"
#include "core/mobility/lock.hpp"
#include "core/response/monitors.hpp"
#include "core/scene/body_rules.hpp"
#include "core/start/initial_state.hpp"
#include "core/trust/check_list.hpp"
#include "picture/motion.hpp"

/// The mechanism as the file places it, before anything is simulated.
namespace pleuel {

namespace {

/// What can be said without a simulation.
struct Shown {
  Json document;
  std::string text;
  Motion motion;  ///< of rigid bodies; empty where they cannot be assembled or nothing is driven
};

/// DegreesOfFreedom and size of the mechanism, if it can be assembled.
void add_assembly(const ProblemFile& problem, Model& model, Shown& shown,
                  std::vector<std::string>& warnings) {
  for (const Misalignment& found : find_misalignments(model, model.mechanism.guess, 1e-6)) {
    warnings.push_back(found.text());
  }
  model.mechanism.starts_in_equilibrium = false;
  try {
    const State start = initial_state(model.mechanism).state;
    DegreesOfFreedom freedoms = rigid_degrees_of_freedom(model.mechanism, start);
    freedoms.blocked = blocked_drives(model.mechanism, start, drive_rows(model));
    const std::string blocked = blocked_drives_text(model, start);
    if (!blocked.empty()) warnings.push_back(blocked);
    RigidMotion rigid =
        rigid_motion(problem.scene, model, problem.simulation.end_time, problem.simulation.step);
    const RigidPath& path = rigid.path;
    if (rigid.motion.time.size() > 1) shown.motion = std::move(rigid.motion);
    if (path.end == RigidPath::End::locks) {
      warnings.insert(warnings.begin(), lock_text(model, path));
      shown.document["lock"] = {{"time", path.time}, {"gap", path.gap}};
    }
    shown.document["rigid_motion"] = freedoms_document(freedoms, model);
    shown.text += "\n" + freedoms_text(freedoms, model, &start);
  } catch (const SimulationError& error) {
    shown.document["failure"] = error.what();
    warnings.push_back(fmt::format("the start was not found: {}", error.what()));
  }
  shown.document["steps"] = std::ceil(problem.simulation.end_time / problem.simulation.step);
}

/// The first steps of a simulation: for what is said before it.
struct FirstSteps {
  std::unique_ptr<Analysis> analysis;  ///< null: they fail
  std::string failure;                 ///< why
  double seconds = 0.0;                ///< that the whole simulation will take on this machine
};

constexpr double enough_seconds = 0.1;
constexpr double largest_share = 1.0 / 3.0;  ///< of the simulation
constexpr double first_count = 16.0;         ///< of steps
/// What it takes to find a motion that repeats itself, in simulated periods: 3.6 to 7.8 of those that
/// bench/periodic_state.py simulates.
constexpr double periods_of_start = 6.0;

/// Its first part. Intervals of responses may lie behind it.
ProblemFile beginning(ProblemFile problem, double end_time) {
  problem.simulation.end_time = end_time;
  problem.simulation.period = 0.0;
  problem.simulation.moves_by_bending = true;  // a lock is told without them
  for (ResponseSettings& response : problem.responses) {
    response.from.reset();
    response.to.reset();
  }
  return problem;
}

/// Two runs, of some steps and of twice as many, tell the time of a step from that of the
/// beginning. They take a tenth of a second, or a third of a shorter simulation.
FirstSteps take_first_steps(const ProblemFile& problem, const Eigen::VectorXd& x) {
  const double end = problem.simulation.end_time;
  FirstSteps first;
  double window = std::min(first_count * problem.simulation.step, end), seconds = 0.0;
  double before = 0.0, seconds_before = 0.0;
  try {
    while (true) {
      const Stopwatch stopwatch;
      first.analysis = analyze(beginning(problem, window), x, values_only);
      seconds = stopwatch.seconds();
      if (before > 0.0 && (seconds >= enough_seconds || window >= largest_share * end)) break;
      if (window >= end) break;
      before = window;
      seconds_before = seconds;
      window = std::min(2.0 * window, end);
    }
  } catch (const SimulationError& error) {
    first.analysis.reset();
    first.failure = error.what();
    return first;
  }
  const double rate = before > 0.0 ? std::max(0.0, (seconds - seconds_before) / (window - before))
                                   : seconds / window;
  first.seconds = seconds + rate * (end - window + periods_of_start * problem.simulation.period);
  return first;
}

/// "about 0.3 s": not known better than to a factor of two, since later steps may take more
/// iterations than the first ones.
std::string about_text(double seconds) {
  return "about " + duration(seconds < 1.0 ? seconds : std::round(seconds));
}

/// What only the first steps tell: how long the simulation takes, and which bodies nothing holds.
void add_first_steps(const ProblemFile& problem, const Eigen::VectorXd& x, Shown& shown,
                     std::vector<std::string>& warnings) {
  const FirstSteps first = take_first_steps(problem, x);
  if (!first.analysis) {
    warnings.push_back("the first steps cannot be simulated: " + first.failure);
    return;
  }
  shown.document["seconds"] = {{"simulate", first.seconds}};
  shown.text += "Time: one simulation takes " + about_text(first.seconds) + " on this machine\n";
  const Monitors monitors = monitor(first.analysis->model, first.analysis->trajectory);
  const TrustedRun run{problem, x, *first.analysis, monitors};
  shown.document["unheld_bodies"] = Json::array();
  for (const auto find : {check_unactuated_freedoms, check_unconnected_bodies}) {
    for (const Finding& finding : find(run)) {
      warnings.push_back(finding.text);
      for (const std::string& body : finding.bodies)
        shown.document["unheld_bodies"].push_back(body);
    }
  }
}

Shown describe(const ProblemFile& problem, const Eigen::VectorXd& x) {
  const std::vector<Finding> findings_before = check_before(problem);
  const Eigen::VectorXd start = start_design(problem);
  Model model = build_model(problem.scene, problem.effects, {start.begin(), start.end()},
                            {x.begin(), x.end()}, std::nullopt);
  Shown shown;
  std::vector<std::string> warnings = impossible_corners(problem);
  shown.text = problem.name + "\n\n" + bodies_text(model);
  if (const std::string joints = joints_text(problem); !joints.empty()) {
    shown.text += "\n" + joints;
  }
  if (const std::string actions = actions_text(problem, x); !actions.empty()) {
    shown.text += "\n" + actions;
  }
  shown.text += "\n" + effects_text(model);
  shown.document = {{"status", "done"},
                    {"name", problem.name},
                    {"bodies", bodies_document(model)},
                    {"coordinates", model.mechanism.system->coordinates()},
                    {"multipliers", model.mechanism.system->multipliers()},
                    {"variables", variables_document(problem)},
                    {"effects", effects_document(problem, model, {})}};
  add_assembly(problem, model, shown, warnings);
  if (!shown.document.contains("failure")) add_first_steps(problem, x, shown, warnings);
  for (const auto& findings : {findings_before, check_proportions_before(problem, x)}) {
    for (const std::string& text : texts_of(findings)) warnings.push_back(text);
  }
  shown.document["warnings"] = warnings;
  shown.text += warnings_text(warnings);
  return shown;
}

Json picture_of(const ProblemInput& input, const Motion& motion) {
  return run_picture(input.problem, {{input.design_name, input.design, {}, {}, {}, motion}});
}

/// Into a run folder, as of other commands.
Outcome show_in_folder(const Arguments& arguments, const ProblemInput& input) {
  RunRecord record(arguments, input, Json::object());
  record.begin_phase("show");
  const Shown shown = describe(input.problem, input.design);
  Outcome outcome{ExitCode::done, shown.document, shown.text};
  record.finish(outcome, [&] { return picture_of(input, shown.motion); });
  return outcome;
}

}  // namespace

Outcome run_show(const Arguments& arguments) {
  const ProblemInput input = read_input(arguments);
  if (arguments.output && arguments.output->extension() != ".html") {
    return show_in_folder(arguments, input);
  }
  const bool can_draw = find_report_template().has_value();
  if (!can_draw && arguments.output) throw InputError(no_template);
  if (arguments.output) require_free(*arguments.output, arguments);
  const Shown shown = describe(input.problem, input.design);
  Outcome outcome{ExitCode::done, shown.document, shown.text};
  if (!can_draw) {
    outcome.text += wrapped(fmt::format("No drawing: {}\n", no_template), "  ");
    return outcome;
  }
  const Json card = {{"command", "show"},
                     {"arguments", arguments.words},
                     {"input", {{"file", input.file.string()}, {"overrides", arguments.overrides}}},
                     {"problem", input.effective}};
  draw_page(arguments.output.value_or(free_page(arguments.file.stem().string() + "-show")),
            report_data(card, shown.document, picture_of(input, shown.motion)), outcome);
  return outcome;
}

}  // namespace pleuel
