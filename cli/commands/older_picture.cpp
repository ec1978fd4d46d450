#include "cli/commands/older_picture.hpp"

#include <optional>

#include "cli/files/csv_file.hpp"
#include "cli/files/older_run.hpp"
#include "cli/files/run_picture.hpp"
#include "cli/input/design_file.hpp"
#include "cli/reports/case_report.hpp"
#include "cli/reports/optimum_report.hpp"

namespace pleuel {

namespace {

namespace fs = std::filesystem;

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

Json optimum_picture(const ProblemFile& problem, const Json& result, const fs::path& folder,
                     Notes& notes, std::size_t pictures) {
  std::vector<Redone> designs;
  const auto add = [&](const std::string& name, const char* key, const char* trajectory) {
    const auto x = design_in(result, problem, key);
    if (!x) return;
    designs.push_back(
        {name, *x, analyze(problem, *x), folder / name_of_case_file(trajectory, problem)});
  };
  add("start", "start", "trajectory-start");
  add(name_of_end(result.at("status")), "value", "trajectory-optimum");
  if (!designs.empty()) {
    designs.back().influence = design_influence(problem, *designs.back().analysis);
  }
  return picture_of(problem, designs, notes, pictures);
}

/// Of all load cases, of which the page shows one first.
Json optimum_pictures(const Json& card, const Json& result, const fs::path& folder, Notes& notes) {
  const std::string shown = shown_case(result);
  if (shown.empty()) return optimum_picture(problem_of(card, result), result, folder, notes, 1);
  const Json& names = result.at("cases").at("names");
  std::vector<Json> cases;
  std::size_t first = 0;
  for (const Json& name : names) {
    if (name == shown) first = cases.size();
    const ProblemFile problem = problem_of(card, result, name.get<std::string>());
    cases.push_back(optimum_picture(problem, result, folder, notes, names.size()));
  }
  return picture_of_cases(problem_of(card, result, ""), std::move(cases), first);
}

Json front_picture(const ProblemFile& problem, const Json& result) {
  std::vector<std::pair<std::string, Eigen::VectorXd>> designs;
  int number = 0;
  for (const Json& point : result.at("points")) {
    ++number;
    const auto x = design_in(point, problem, "");
    if (x && !point.at("objectives").empty()) designs.emplace_back(std::to_string(number), *x);
  }
  return rigid_picture(problem, designs);
}

/// @param result  of a simulation, which says what was simulated; others took the start, or the
///                design of a file
/// @param trajectory  file of a run that simulated the design; empty: it did not
Json single_picture(const ProblemFile& problem, const Json& card, const Json& result,
                    const fs::path& trajectory, Notes& notes) {
  const bool has_other_design = card.at("input").contains("design");
  Eigen::VectorXd x = start_design(problem);
  if (const auto simulated = design_in(result, problem, "value")) {
    x = *simulated;
  } else if (has_other_design) {
    x = read_design(card["input"]["design"].get<std::string>(), problem);
  }
  std::vector<Redone> designs;
  designs.push_back({has_other_design ? "design" : "start", x, nullptr, trajectory});
  const bool is_check = card.at("command") == "check";
  if (!trajectory.empty() || is_check) designs.back().analysis = analyze(problem, x);
  if (is_check) designs.back().influence = design_influence(problem, *designs.back().analysis);
  return picture_of(problem, designs, notes);
}

}  // namespace

Json picture_of_run(const Json& card, const Json& result, const fs::path& folder, Notes& notes) {
  if (!card.contains("problem")) return nullptr;  // of several files
  const std::string command = card.at("command").get<std::string>();
  if (command == "optimize") return optimum_pictures(card, result, folder, notes);
  const ProblemFile problem = problem_of(card, result);
  if (command == "pareto") return front_picture(problem, result);
  const bool has_motion = command == "simulate" || command == "gradient";
  return single_picture(problem, card, result, has_motion ? folder / "trajectory.csv" : fs::path(),
                        notes);
}

}  // namespace pleuel
