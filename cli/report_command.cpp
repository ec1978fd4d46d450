#include <fstream>
#include <optional>

#include <fmt/format.h>

#include "cli/commands.hpp"
#include "cli/console.hpp"
#include "cli/design_file.hpp"
#include "cli/output_file.hpp"
#include "cli/report_page.hpp"
#include "cli/run_folder.hpp"
#include "cli/run_picture.hpp"
#include "cli/trajectory_csv.hpp"
#include "cli/wrapped_text.hpp"
#include "core/base/error.hpp"
#include "core/response/effect_measurement.hpp"
#include "core/scene/problem_reader.hpp"

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

/// The problem as it ran: with the steps and elements that were chosen for an accuracy.
ProblemFile problem_of(const Json& card, const Json& result) {
  std::vector<std::string> overrides;
  if (result.contains("setting") && result["setting"].contains("overrides")) {
    for (const auto& [pointer, value] : result["setting"]["overrides"].items()) {
      overrides.push_back(pointer + "=" + value.dump());
    }
  }
  ProblemFile problem = read_problem_text(
      card.at("problem").dump(), card.at("input").at("file").get<std::string>(), overrides);
  decide_effects(problem);
  return problem;
}

/// The values of a document's variables; nothing if it does not have all of them.
/// @param key  of {NAME: {key: number}}; empty for {NAME: number}
std::optional<Eigen::VectorXd> design_in(const Json& document, const ProblemFile& problem,
                                         const std::string& key) {
  Eigen::VectorXd x = start_design(problem);
  if (x.size() == 0) return x;
  if (!document.contains("variables")) return std::nullopt;
  for (std::size_t i = 0; i < problem.variables.size(); ++i) {
    const Json variable = document["variables"].value(problem.variables[i].name, Json());
    const Json value = key.empty() ? variable : variable.value(key, Json());
    if (!value.is_number()) return std::nullopt;
    x(static_cast<Eigen::Index>(i)) = value.get<double>();
  }
  return x;
}

/// Simulated, if that is possible.
struct Redone {
  std::string name;
  Eigen::VectorXd x;
  std::unique_ptr<Analysis> analysis;
  fs::path trajectory{};  ///< with the bands of its histories; empty: there is none
};

Json picture_of(const ProblemFile& problem, const std::vector<Redone>& designs) {
  std::vector<ShownDesign> shown;
  for (const Redone& design : designs) {
    shown.push_back({design.name, design.x, design.analysis.get()});
    if (design.analysis) shown.back().bands = read_bands(design.trajectory, *design.analysis);
  }
  return run_picture(problem, shown);
}

Json optimum_picture(const ProblemFile& problem, const Json& result, const fs::path& folder) {
  std::vector<Redone> designs;
  for (const auto& [name, key] : {std::pair{"start", "start"}, std::pair{"optimum", "value"}}) {
    const auto x = design_in(result, problem, key);
    const fs::path trajectory = folder / fmt::format("trajectory-{}.csv", name);
    if (x) designs.push_back({name, *x, analyze(problem, *x), trajectory});
  }
  return picture_of(problem, designs);
}

Json front_picture(const ProblemFile& problem, const Json& result) {
  std::vector<Redone> designs;
  int number = 0;
  for (const Json& point : result.at("points")) {
    ++number;
    const auto x = design_in(point, problem, "");
    if (x && !point.at("objectives").empty())
      designs.push_back({std::to_string(number), *x, nullptr});
  }
  return picture_of(problem, designs);
}

/// @param result  of a simulation, which says what was simulated; others took the start, or the
///                design of a file
/// @param trajectory  file of a run that simulated the design; empty: it did not
Json single_picture(const ProblemFile& problem, const Json& card, const Json& result,
                    const fs::path& trajectory) {
  const bool has_other_design = card.at("input").contains("design");
  Eigen::VectorXd x = start_design(problem);
  if (const auto simulated = design_in(result, problem, "value")) {
    x = *simulated;
  } else if (has_other_design) {
    x = read_design(card["input"]["design"].get<std::string>(), problem);
  }
  std::vector<Redone> designs;
  designs.push_back({has_other_design ? "design" : "start", x, nullptr, trajectory});
  if (!trajectory.empty()) designs.back().analysis = analyze(problem, x);
  return picture_of(problem, designs);
}

Json picture_of_run(const Json& card, const Json& result, const fs::path& folder) {
  if (!card.contains("problem")) return nullptr;  // of several files
  const ProblemFile problem = problem_of(card, result);
  const std::string command = card.at("command").get<std::string>();
  if (command == "optimize") return optimum_picture(problem, result, folder);
  if (command == "pareto") return front_picture(problem, result);
  return single_picture(problem, card, result,
                        command == "simulate" ? folder / "trajectory.csv" : fs::path());
}

/// @returns what the user is told
std::string make_report(const fs::path& page, const fs::path& folder, WriteFailures& failures) {
  const Json card = read_document(folder / card_name),
             result = read_document(folder / "result.json");
  Json picture;
  std::string note;
  try {
    picture = picture_of_run(card, result, folder);
  } catch (const std::exception& error) {
    note = wrapped(fmt::format("Without the mechanism: {}\n", error.what()), "  ");
  }
  write_file({folder / report_name, &failures},
             report_page(page, report_data(card, result, picture, folder)));
  return fmt::format("Report: {}\n{}", (folder / report_name).string(), note);
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
    outcome.document["reports"].push_back((folder / report_name).string());
  }
  outcome.unwritten = failures.files();
  return outcome;
}

}  // namespace pleuel
