#include "cli/input/run_setting.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cli/text/console.hpp"
#include "cli/text/json.hpp"
#include "cli/text/wrapped_text.hpp"
#include "core/base/error.hpp"
#include "core/scene/reading/json_text.hpp"
#include "core/scene/reading/override.hpp"
#include "core/scene/reading/text_file.hpp"

namespace pleuel {

namespace {

/// Commands whose answer is about the design as it is.
constexpr std::array<std::string_view, 5> commands = {"simulate", "gradient", "check", "prices",
                                                      "uncertainty"};

Json document_of(const std::filesystem::path& file) {
  return parse_json(read_text_file(file), file.string());
}

/// Whether the setting was chosen for an accuracy: stages have a target then.
bool was_chosen(const Json& result) {
  const Json stages = result.value("stages", Json::array());
  return !stages.empty() && stages.back().contains("target");
}

/// Chosen numbers by their places in the file of a case, or in the whole file.
using Setting = std::vector<std::pair<Json::json_pointer, Json>>;

/// Whether the problem has what a chosen number is of.
bool has_place(const Json& problem, const Json::json_pointer& place) {
  const std::string text = place.to_string();
  if (!text.starts_with("/scene/")) return true;
  if (!problem.contains(place.parent_pointer())) return false;
  const Json& owner = problem.at(place.parent_pointer());
  return place.back() != "elements" || !owner.is_object() || !owner.contains("segments");
}

/// @returns nothing if something of it is not in the problem
std::optional<Setting> setting_of(const Json& chosen, const Json& problem) {
  Setting setting;
  for (const auto& [text, value] : chosen.at("overrides").items()) {
    const Json::json_pointer place(text);
    if (!has_place(problem, place)) return std::nullopt;
    setting.emplace_back(place, value);
  }
  return setting;
}

/// The place in a whole file at which a load case changes another place.
std::string place_in_case(const std::string& load_case, const Json::json_pointer& place) {
  return (Json::json_pointer("/cases") / load_case / place.to_string()).to_string();
}

/// What the command line itself says stands above it.
bool is_given(const std::string& place, const std::vector<std::string>& assignments) {
  return std::any_of(assignments.begin(), assignments.end(), [&](const std::string& assignment) {
    return assignment.starts_with(place + "=");
  });
}

/// An assignment, and how it is told.
struct Assignment {
  std::string text, shown;
};

Assignment assignment(const std::string& load_case, const Json::json_pointer& place,
                      const Json& value) {
  const std::string plain = fmt::format("{}={}", place.to_string(), value.dump());
  if (load_case.empty()) return {plain, plain};
  return {fmt::format("{}={}", place_in_case(load_case, place), value.dump()),
          fmt::format("{} in case {}", plain, load_case)};
}

class RunSetting {
 public:
  /// @param result   of the optimization
  /// @param problem  the file with the assignments of the command line
  RunSetting(const Arguments& arguments, const Json& result, const Json& problem)
      : arguments_(arguments), result_(result), problem_(problem) {}

  /// Assignments; nothing if the problem is not that of the run.
  std::optional<std::vector<Assignment>> find() {
    const Json& setting = result_.at("setting");
    if (!problem_.contains("cases") || problem_.at("cases").empty()) {
      return setting.contains("overrides") && add(setting, "") ? std::optional(assignments_)
                                                               : std::nullopt;
    }
    for (const auto& [name, changes] : problem_.at("cases").items()) {
      if (arguments_.load_case && name != *arguments_.load_case) continue;
      if (!changes.is_object() || !add_of_case(setting, name)) return std::nullopt;
    }
    return assignments_;
  }

 private:
  /// Of an optimization for all cases, or for this one alone.
  bool add_of_case(const Json& setting, const std::string& name) {
    if (setting.contains("cases")) {
      return setting.at("cases").contains(name) && add(setting.at("cases").at(name), name);
    }
    return arguments_.load_case && setting.contains("overrides") && add(setting, name);
  }

  bool add(const Json& chosen, const std::string& load_case) {
    const std::optional<Setting> setting = setting_of(chosen, problem_);
    if (!setting) return false;
    for (const auto& [place, value] : *setting) {
      // The lengths of segments may go by their elements, and masses with them.
      const bool is_of_segment = place.to_string().find("/segments/") != std::string::npos;
      if (is_of_segment && !load_case.empty()) return false;
      const std::string in_case = load_case.empty() ? "" : place_in_case(load_case, place);
      const bool is_given_otherwise = is_given(place.to_string(), arguments_.overrides) ||
                                      (!in_case.empty() && is_given(in_case, arguments_.overrides));
      if (is_given_otherwise) continue;
      assignments_.push_back(assignment(load_case, place, value));
    }
    return true;
  }

  const Arguments& arguments_;
  const Json &result_, &problem_;
  std::vector<Assignment> assignments_;
};

struct FoundSetting {
  bool fits = true;  ///< otherwise the run is of another mechanism
  std::vector<Assignment> assignments;
};

/// Nothing where no accuracy was asked of the run, or where one is asked for now.
FoundSetting setting_of_run(const Arguments& arguments) {
  const std::filesystem::path& design = *arguments.design;
  const Json result =
      document_of(std::filesystem::is_directory(design) ? design / "result.json" : design);
  if (!result.contains("setting") || !was_chosen(result)) return {};
  Json problem = document_of(arguments.file);
  for (const std::string& assignment : arguments.overrides) {
    apply_override(problem, assignment, arguments.file.string());
  }
  if (problem.contains(Json::json_pointer("/accuracy/target"))) return {};
  const auto found = RunSetting(arguments, result, problem).find();
  if (!found) return {false, {}};
  return {true, *found};
}

}  // namespace

void take_setting_of_run(Arguments& arguments) {
  const bool looks_at_it =
      std::find(commands.begin(), commands.end(), arguments.command) != commands.end();
  if (!looks_at_it || !arguments.design) return;
  FoundSetting found;
  try {
    found = setting_of_run(arguments);
  } catch (const InputError&) {
    return;  // who reads the design says more of it
  } catch (const Json::exception&) {
    return;  // a damaged document
  }
  const std::string run = arguments.design->string();
  if (!found.fits) {
    show(stderr, wrapped(fmt::format("{}: note: simulated with the steps and elements of the file, "
                                     "since those of this optimum do not fit it\n",
                                     run)));
  }
  if (found.assignments.empty()) return;
  std::vector<std::string> shown, overrides;
  for (const Assignment& one : found.assignments) {
    shown.push_back(one.shown);
    overrides.push_back(one.text);
  }
  show(stderr, wrapped(fmt::format("{}: note: simulated with the steps and elements that this "
                                   "optimum was found with ({}); --set takes others\n",
                                   run, fmt::join(shown, ", "))));
  arguments.overrides.insert(arguments.overrides.begin(), overrides.begin(), overrides.end());
}

}  // namespace pleuel
