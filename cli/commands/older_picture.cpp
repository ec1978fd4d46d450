
#include "cli/commands/commands.hpp"
#include "cli/reports/case_report.hpp"
#include "cli/reports/optimum_document.hpp"

namespace pleuel {

namespace {

/// Those of the histories that the run has written.
void take_bands(const fs::path& trajectory, ShownDesign& design, Notes& notes) {
  TrajectoryBands file = read_bands(trajectory, *design.analysis);
  design.bands = std::move(file.bands);
  if (!file.fault.empty()) notes.push_back("histories have no error bands: " + file.fault);
}

Json optimum_picture(const OlderRun& run, const ProblemFile& problem, std::size_t pictures,
                     Notes& notes) {
  std::vector<ShownDesign> designs;
  const auto add = [&](const std::string& name, const char* key, const char* trajectory) {
    const auto x = design_in(run.result, problem, key);
    if (!x) return;
    designs.push_back({name, *x, analyze(problem, *x)});
    take_bands(run.folder / name_of_case_file(trajectory, problem), designs.back(), notes);
  };
  add("start", "start", "trajectory-start");
  add(name_of_end(run.result.at("status")), "value", "trajectory-optimum");
  if (!designs.empty()) {
    designs.back().influence = design_influence(problem, *designs.back().analysis);
  }
  return run_picture(problem, designs, pictures);
}

/// Of all load cases, of which the page shows one first.
Json optimum_pictures(const OlderRun& run, Notes& notes) {
  const std::string shown = run.shown_case();
  if (shown.empty()) return optimum_picture(run, problem_of(run), 1, notes);
  const Json& names = run.result.at("cases").at("names");
  std::vector<Json> cases;
  std::size_t first = 0;
  for (const Json& name : names) {
    if (name == shown) first = cases.size();
    const ProblemFile problem = problem_of(run, name.get<std::string>());
    cases.push_back(optimum_picture(run, problem, names.size(), notes));
  }
  return picture_of_cases(problem_of(run, ""), std::move(cases), first);
}

Json front_picture(const OlderRun& run) {
  const ProblemFile problem = problem_of(run);
  std::vector<std::pair<std::string, Eigen::VectorXd>> designs;
  int number = 0;
  for (const Json& point : run.result.at("points")) {
    ++number;
    const auto x = design_in(point, problem, "");
    if (x && !point.at("objectives").empty()) designs.emplace_back(std::to_string(number), *x);
  }
  return rigid_picture(problem, designs);
}

/// Of a run that looked at one design: a simulation says which it was, others took the start, or the
/// design of a file.
Json single_picture(const OlderRun& run, Notes& notes) {
  const ProblemFile problem = problem_of(run);
  const std::string command = run.command();
  const bool has_other_design = run.card.at("input").contains("design");
  ShownDesign design{has_other_design ? "design" : "start", start_design(problem)};
  if (const auto simulated = design_in(run.result, problem, "value")) {
    design.x = *simulated;
  } else if (has_other_design) {
    design.x = read_design(run.card["input"]["design"].get<std::string>(), problem);
  }
  const bool has_trajectory = command == "simulate" || command == "gradient";
  if (has_trajectory || command == "check") design.analysis = analyze(problem, design.x);
  if (has_trajectory) take_bands(run.folder / "trajectory.csv", design, notes);
  if (command == "check") design.influence = design_influence(problem, *design.analysis);
  return run_picture(problem, {design});
}

}  // namespace

Json picture_of_run(const OlderRun& run, Notes& notes) {
  if (!run.card.contains("problem")) return nullptr;  // of several files
  if (run.command() == "optimize") return optimum_pictures(run, notes);
  return run.command() == "pareto" ? front_picture(run) : single_picture(run, notes);
}

}  // namespace pleuel
