#include <algorithm>
#include <fstream>
#include <map>
#include <optional>

#include <fmt/format.h>

#include "cli/commands/commands.hpp"
#include "cli/files/output_file.hpp"
#include "cli/files/report_page.hpp"
#include "cli/files/run_again.hpp"
#include "cli/files/run_folder.hpp"
#include "cli/files/run_picture.hpp"
#include "cli/files/trajectory_csv.hpp"
#include "cli/input/design_file.hpp"
#include "cli/reports/case_report.hpp"
#include "cli/reports/optimum_report.hpp"
#include "cli/text/console.hpp"
#include "cli/text/wrapped_text.hpp"
#include "core/base/error.hpp"

/// Reports of earlier runs: what is shown of the mechanism is simulated again from the run card.
namespace pleuel {

namespace {

namespace fs = std::filesystem;

Json read_document(const fs::path& path) {
  if (!fs::is_regular_file(path)) {
    throw InputError(
        fmt::format("{}: there is no such file: not the folder of a finished run", path.string()));
  }
  std::ifstream stream(path);
  Json document = Json::parse(stream, nullptr, /*allow_exceptions=*/false);
  if (!document.is_object()) throw InputError(path.string() + ": is not a JSON document");
  return document;
}

/// Simulated, if that is possible.
struct Redone {
  std::string name;
  Eigen::VectorXd x;
  std::unique_ptr<Analysis> analysis;
  fs::path trajectory{};  ///< with the bands of its histories; empty: there is none
  std::optional<DesignInfluence> influence{};
};

/// What is told of files that cannot be used.
using Notes = std::vector<std::string>;

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

Json front_picture(const ProblemFile& problem, const Json& result, Notes& notes) {
  std::vector<Redone> designs;
  int number = 0;
  for (const Json& point : result.at("points")) {
    ++number;
    const auto x = design_in(point, problem, "");
    if (x && !point.at("objectives").empty())
      designs.push_back({std::to_string(number), *x, nullptr});
  }
  return picture_of(problem, designs, notes);
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

Json picture_of_run(const Json& card, const Json& result, const fs::path& folder, Notes& notes) {
  if (!card.contains("problem")) return nullptr;  // of several files
  const std::string command = card.at("command").get<std::string>();
  if (command == "optimize") return optimum_pictures(card, result, folder, notes);
  const ProblemFile problem = problem_of(card, result);
  if (command == "pareto") return front_picture(problem, result, notes);
  const bool has_motion = command == "simulate" || command == "gradient";
  return single_picture(problem, card, result, has_motion ? folder / "trajectory.csv" : fs::path(),
                        notes);
}

/// What a result has that is whole.
struct Needed {
  const char* key;
  Json::value_t type;
};

std::vector<Needed> needed_in(const std::string& command) {
  using Type = Json::value_t;
  static const std::map<std::string, std::vector<Needed>> needed = {
      {"accuracy", {{"runs", Type::array}}},
      {"check", {{"responses", Type::object}}},
      {"gradient", {{"responses", Type::object}}},
      {"optimize",
       {{"status", Type::string},
        {"objective", Type::object},
        {"variables", Type::object},
        {"constraints", Type::object}}},
      {"pareto", {{"points", Type::array}}},
      {"prices", {{"prices", Type::object}}},
      {"simulate", {{"responses", Type::object}}},
      {"stability", {{"runs", Type::array}}},
      {"uncertainty", {{"responses", Type::object}}},
  };
  const auto found = needed.find(command);
  return found == needed.end() ? std::vector<Needed>() : found->second;
}

/// @throws InputError if something is missing that the run has written
void check_whole(const Json& card, const Json& result, const fs::path& folder) {
  const auto damaged = [&](const char* file, const std::string& what) {
    return InputError(fmt::format("{}: is damaged: {}", (folder / file).string(), what));
  };
  if (!card.contains("command") || !card["command"].is_string()) {
    throw damaged(card_name, "it names no command");
  }
  const std::string command = card["command"].get<std::string>();
  for (const Needed& one : needed_in(command)) {
    if (!result.contains(one.key) || result[one.key].type() != one.type) {
      throw damaged("result.json",
                    fmt::format("a run of `pleuel {}` has \"{}\" there", command, one.key));
    }
  }
  const bool is_optimum = command == "optimize" && result["objective"].contains("value");
  if (!is_optimum) return;
  for (const auto& [name, variable] : result["variables"].items()) {
    if (!variable.is_object() || !variable.contains("value") || !variable["value"].is_number()) {
      throw damaged("result.json", fmt::format("the variable \"{}\" has no value", name));
    }
  }
}

/// @returns what the user is told
std::string make_report(const fs::path& page, const fs::path& folder, WriteFailures& failures) {
  const Json card = read_document(folder / card_name),
             result = read_document(folder / "result.json");
  check_whole(card, result, folder);
  Json picture;
  Notes notes;
  try {
    picture = picture_of_run(card, result, folder, notes);
  } catch (const std::exception& error) {
    notes.push_back(fmt::format("the mechanism is not shown: {}", error.what()));
  }
  if (!card.value("finished", true)) {
    notes.push_back("the run did not come to its end: what it had written is shown");
  }
  std::string text;
  if (write_file({folder / report_name, &failures},
                 report_page(page, report_data(card, result, picture, folder)))) {
    text = fmt::format("Report: {}\n", (folder / report_name).string());
  }
  for (const std::string& note : notes) text += wrapped("Note: " + note + "\n", "  ");
  return text;
}

}  // namespace

Outcome run_report(const Arguments& arguments) {
  const auto page = find_report_template();
  if (!page) {
    throw InputError(
        "the template of reports is not built, which takes nodejs and npm: see docs/report.md");
  }
  Outcome outcome;
  outcome.document = {{"reports", Json::array()}};
  WriteFailures failures;
  for (const fs::path& folder : arguments.files) {
    outcome.text += make_report(*page, folder, failures);
    const std::string report = (folder / report_name).string();
    const auto& failed = failures.files();
    if (std::find(failed.begin(), failed.end(), report) == failed.end()) {
      outcome.document["reports"].push_back(report);
    }
  }
  outcome.unwritten = failures.files();
  return outcome;
}

}  // namespace pleuel
