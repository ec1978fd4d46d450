#include "cli/files/older_run.hpp"

#include <ctime>
#include <fstream>
#include <utility>

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/input/problem_input.hpp"
#include "cli/reports/document_table.hpp"
#include "core/base/error.hpp"
#include "core/response/effect_measurement.hpp"

namespace pleuel {

namespace {

constexpr const char* result_name = "result.json";

/// Whether a run is at work in the folder: it holds its lock.
bool is_at_work(const fs::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor == -1) return false;
  const bool is_free = ::flock(descriptor, LOCK_SH | LOCK_NB) == 0;
  ::close(descriptor);
  return !is_free;
}

/// The JSON object in a file; null if there is none that can be read.
Json document_in(const fs::path& file) {
  if (!fs::is_regular_file(file)) return nullptr;
  std::ifstream stream(file);
  Json document = Json::parse(stream, nullptr, /*allow_exceptions=*/false);
  return document.is_object() ? document : Json();
}

using Type = Json::value_t;
using Needed = std::vector<std::pair<const char*, Type>>;

/// What a result has that is whole.
Needed needed_in(const std::string& command) {
  static const std::map<std::string, Needed> needed = {
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
  return found == needed.end() ? Needed() : found->second;
}

/// The effects of the model that the result is of: where an optimization has ended, more of them may
/// matter than where it began.
/// @returns whether the result names them
bool take_effects(const Json& result, ProblemFile& problem) {
  if (problem.has_cases() || !result.contains("effects")) return false;
  EffectDecisions decisions;
  for (const Json& effect : result["effects"]) {
    if (!effect.contains("body") || effect.value("case", "") != problem.load_case) continue;
    const std::pair key(effect["body"].get<std::string>(), effect.at("name").get<std::string>());
    decisions.measured[key].is_needed = effect.at("built").get<bool>();
  }
  if (decisions.measured.empty()) return false;
  problem.effects.decisions = std::move(decisions);
  return true;
}

}  // namespace

std::string OlderRun::problem() const {
  const Json inputs = card.value("inputs", Json::array({card.value("input", Json())}));
  if (inputs.size() != 1) return fmt::format("{} files", inputs.size());
  const std::string name = text_at(card, "/problem/name");
  return name.empty() ? fs::path(text_at(inputs[0], "/file")).stem().string() : name;
}

std::string OlderRun::status() const {
  if (!card.value("finished", false)) return is_at_work(folder) ? "running" : "killed";
  if (!damage_of(*this).empty()) return "damaged";
  return result.value("status", "done");
}

std::string OlderRun::shown_case() const {
  return text_at(result, "/cases/shown");
}

std::optional<double> OlderRun::objective() const {
  return number_at(result, "/objective/value");
}

std::string OlderRun::objective_unit() const {
  return objective() ? text_at(result, "/objective/unit") : "";
}

std::optional<double> OlderRun::seconds() const {
  return number_at(card, "/seconds/total");
}

std::string OlderRun::date() const {
  struct stat status = {};
  if (::stat((folder / card_name).c_str(), &status) == -1) return "";
  return fmt::format("{:%Y-%m-%d %H:%M}", fmt::localtime(status.st_mtime));
}

fs::file_time_type OlderRun::written() const {
  std::error_code error;
  const fs::file_time_type time = fs::last_write_time(folder / card_name, error);
  return error ? fs::file_time_type::min() : time;
}

Json summary_of(const OlderRun& run) {
  return {{"folder", run.folder.string()},
          {"command", run.command()},
          {"problem", run.problem()},
          {"status", run.status()}};
}

std::optional<OlderRun> find_older_run(const fs::path& folder) {
  OlderRun run{folder, document_in(folder / card_name), document_in(folder / result_name)};
  if (run.card.is_null() || !run.card.value("command", Json()).is_string()) return std::nullopt;
  return run;
}

std::string damage_of(const OlderRun& run) {
  const auto damaged = [&](const char* file, const std::string& what) {
    return fmt::format("{}: is damaged: {}", (run.folder / file).string(), what);
  };
  const std::string command = text_at(run.card, "/command");
  if (command.empty()) return damaged(card_name, "it names no command");
  if (!run.result.is_object()) {
    const fs::path file = run.folder / result_name;
    return file.string() + (fs::exists(file)
                                ? ": is not a JSON document"
                                : ": there is no such file: not the folder of a finished run");
  }
  for (const auto& [key, type] : needed_in(command)) {
    if (run.result.value(key, Json()).type() != type) {
      return damaged(result_name,
                     fmt::format("a run of `pleuel {}` has \"{}\" there", command, key));
    }
  }
  if (command != "optimize" || !run.objective()) return "";
  for (const auto& [name, variable] : run.result["variables"].items()) {
    if (!number_at(variable, "/value")) {
      return damaged(result_name, fmt::format("the variable \"{}\" has no value", name));
    }
  }
  return "";
}

OlderRun read_older_run(const fs::path& folder) {
  if (!fs::is_directory(folder)) {
    throw InputError(fmt::format("{}: there is no such run folder", folder.string()));
  }
  std::optional<OlderRun> run = find_older_run(folder);
  if (!run) {
    throw InputError(fmt::format("{}: is not the folder of a run: it has no {} that can be read",
                                 folder.string(), card_name));
  }
  return std::move(*run);
}

std::optional<ProblemFile> problem_on_card(const fs::path& folder) try {
  const Json card = document_in(folder / card_name);
  return read_problem_text(card.at("problem").dump(), card.at("input").at("file"), {}).complete();
} catch (const std::exception&) {
  return std::nullopt;
}

ProblemFile problem_of(const OlderRun& run) {
  return problem_of(run, run.shown_case());
}

ProblemFile problem_of(const OlderRun& run, const std::string& load_case) {
  const std::string file = run.card.at("input").at("file").get<std::string>();
  const Json document = overridden_document({run.card.at("problem").dump(), file, {}, load_case});
  Json setting = run.result.value("setting", Json::object());
  if (setting.contains("cases")) setting = setting["cases"].value(load_case, Json::object());
  std::vector<std::string> overrides;
  if (setting.contains("overrides")) {
    for (const auto& [pointer, value] : setting["overrides"].items()) {
      overrides.push_back(pointer + "=" + value.dump());
    }
  }
  ProblemFile problem = read_problem_text(document.dump(), file, overrides).complete();
  problem.load_case = load_case;
  if (!take_effects(run.result, problem)) decide_effects(problem);
  return problem;
}

std::optional<Eigen::VectorXd> design_in(const Json& document, const ProblemFile& problem,
                                         const std::string& key) {
  Eigen::VectorXd x = start_design(problem);
  if (x.size() == 0) return x;
  for (std::size_t i = 0; i < problem.variables.size(); ++i) {
    const std::string place = place_in("/variables", problem.variables[i].name);
    const auto value = number_at(document, key.empty() ? place : place + "/" + key);
    if (!value) return std::nullopt;
    x(i) = *value;
  }
  return x;
}

}  // namespace pleuel
