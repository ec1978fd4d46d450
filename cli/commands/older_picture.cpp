#include "cli/commands/older_picture.hpp"

#include <optional>

#include "cli/files/csv_file.hpp"
#include "cli/files/run_picture.hpp"
#include "cli/input/problem_input.hpp"
#include "cli/reports/case_report.hpp"
#include "cli/reports/optimum_report.hpp"

namespace pleuel {

namespace {

/// Simulated, if that is possible.
struct Redone {
  std::string name;
  Eigen::VectorXd x;
  std::unique_ptr<Analysis> analysis;
  fs::path trajectory{};  ///< with the bands of its histories; empty: there is none
  std::optional<DesignInfluence> influence{};
};

Json picture_of(const ProblemFile& problem, const std::vector<Redone>& designs, Notes& notes,
                std::size_t pictures = 1) {
  std::vector<ShownDesign> shown;
  for (const Redone& design : designs) {
    shown.push_back({design.name, design.x, design.analysis.get()});
    if (!design.trajectory.empty()) {
      TrajectoryBands file = read_bands(design.trajectory, *design.analysis);
      shown.back().bands = std::move(file.bands);
      if (!file.fault.empty()) notes.push_back("histories have no error bands: " + file.fault);
    }
    if (design.influence) shown.back().influence = &*design.influence;
  }
  return run_picture(problem, shown, pictures);
}

Json optimum_picture(const OlderRun& run, const ProblemFile& problem, std::size_t pictures,
                     Notes& notes) {
  std::vector<Redone> designs;
  const auto add = [&](const std::string& name, const char* key, const char* trajectory) {
    const auto x = design_in(run.result, problem, key);
    if (!x) return;
    designs.push_back({name, *x, analyze(problem, *x),
                       run.folder / name_of_case_file(trajectory, problem)});
  };
  add("start", "start", "trajectory-start");
  add(name_of_end(run.result.at("status")), "value", "trajectory-optimum");
  if (!designs.empty()) {
    designs.back().influence = design_influence(problem, *designs.back().analysis);
  }
  return picture_of(problem, designs, notes, pictures);
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
  Redone design{has_other_design ? "design" : "start", start_design(problem), nullptr};
  if (const auto simulated = design_in(run.result, problem, "value")) {
    design.x = *simulated;
  } else if (has_other_design) {
    design.x = read_design(run.card["input"]["design"].get<std::string>(), problem);
  }
  if (command == "simulate" || command == "gradient") {
    design.trajectory = run.folder / "trajectory.csv";
  }
  if (!design.trajectory.empty() || command == "check") {
    design.analysis = analyze(problem, design.x);
  }
  if (command == "check") design.influence = design_influence(problem, *design.analysis);
  std::vector<Redone> designs;
  designs.push_back(std::move(design));
  return picture_of(problem, designs, notes);
}

}  // namespace

Json picture_of_run(const OlderRun& run, Notes& notes) {
  if (!run.card.contains("problem")) return nullptr;  // of several files
  if (run.command() == "optimize") return optimum_pictures(run, notes);
  return run.command() == "pareto" ? front_picture(run) : single_picture(run, notes);
}

}  // namespace pleuel
