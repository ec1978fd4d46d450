#include "cli/input/run_setting.hpp"

#include <algorithm>
#include <array>
#include <string_view>
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

/// The chosen setting as overrides; nothing if a body of it is not in the problem.
std::vector<std::string> overrides_of(const Json& chosen, const Json& problem) {
  std::vector<std::string> overrides;
  for (const auto& [place, value] : chosen.items()) {
    const bool is_of_body = place.starts_with("/scene/");
    if (is_of_body && !problem.contains(Json::json_pointer(place).parent_pointer())) return {};
    overrides.push_back(place + "=" + value.dump());
  }
  return overrides;
}

std::vector<std::string> setting_of_run(const Arguments& arguments) {
  const std::filesystem::path& design = *arguments.design;
  const Json result =
      document_of(std::filesystem::is_directory(design) ? design / "result.json" : design);
  const Json::json_pointer place("/setting/overrides");
  if (!result.contains(place) || !was_chosen(result)) return {};
  Json problem = document_of(arguments.file);
  for (const std::string& assignment : arguments.overrides) {
    apply_override(problem, assignment, arguments.file.string());
  }
  if (problem.contains(Json::json_pointer("/accuracy/target"))) return {};
  return overrides_of(result.at(place), problem);
}

}  // namespace

void take_setting_of_run(Arguments& arguments) {
  const bool looks_at_it =
      std::find(commands.begin(), commands.end(), arguments.command) != commands.end();
  if (!looks_at_it || !arguments.design) return;
  std::vector<std::string> setting;
  try {
    setting = setting_of_run(arguments);
  } catch (const InputError&) {
    return;  // who reads the design says more of it
  } catch (const Json::exception&) {
    return;  // a damaged document
  }
  if (setting.empty()) return;
  show(stderr, wrapped(fmt::format("{}: note: simulated with the steps and elements that this "
                                   "optimum was found with ({}); --set takes others\n",
                                   arguments.design->string(), fmt::join(setting, ", "))));
  arguments.overrides.insert(arguments.overrides.begin(), setting.begin(), setting.end());
}

}  // namespace pleuel
