#include "cli/run_record.hpp"

#include <array>
#include <fstream>

#include <fmt/format.h>

#include "cli/versions.hpp"
#include "core/base/error.hpp"

namespace pleuel {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr const char* card_name = "run_card.json";

/// Everything that a run of any command may leave beside the card.
constexpr std::array<const char*, 11> result_names = {"history.csv",
                                                      "result.json",
                                                      "trajectory.csv",
                                                      "trajectory-start.csv",
                                                      "trajectory-optimum.csv",
                                                      "pareto.csv",
                                                      "accuracy.csv",
                                                      "stability.csv",
                                                      "uncertainty.csv",
                                                      "gradients.csv",
                                                      "failed_design.json"};

fs::path default_folder(const Arguments& arguments) {
  if (arguments.files.size() > 1) return fs::path("runs") / arguments.command;
  const fs::path& file = arguments.files.empty() ? arguments.file : arguments.files.front();
  return fs::path("runs") / (file.stem().string() + "-" + arguments.command);
}

/// The command that the card of an older run names; empty if there is none that can be read.
std::string command_of(const fs::path& folder) {
  std::ifstream stream(folder / card_name);
  const Json card = Json::parse(stream, nullptr, /*allow_exceptions=*/false);
  const bool is_named = card.is_object() && card.contains("command") && card["command"].is_string();
  return is_named ? card["command"].get<std::string>() : "";
}

void check_writable(const fs::path& folder) {
  const fs::path probe = folder / (std::string(card_name) + ".draft");
  std::error_code error;
  const bool is_written = static_cast<bool>(std::ofstream(probe) << '\n' << std::flush);
  fs::remove(probe, error);
  if (!is_written) throw InputError(fmt::format("-o {}: cannot be written", folder.string()));
}

void prepare_folder(const fs::path& folder, const std::string& command) {
  std::error_code error;
  if (fs::exists(folder) && !fs::is_directory(folder)) {
    throw InputError(fmt::format("-o {}: is a file, not a folder", folder.string()));
  }
  const bool is_foreign =
      fs::exists(folder) && !fs::is_empty(folder) && !fs::exists(folder / card_name);
  if (is_foreign) {
    throw InputError(fmt::format(
        "-o {}: the folder holds something else than a run (it has no {}); choose another name",
        folder.string(), card_name));
  }
  fs::create_directories(folder, error);
  if (error) {
    throw InputError(fmt::format("-o {}: cannot be created: {}", folder.string(), error.message()));
  }
  check_writable(folder);
  const std::string older = command_of(folder);
  if (!older.empty() && older != command) {
    throw InputError(fmt::format("-o {}: holds a run of `pleuel {}`; choose another name",
                                 folder.string(), older));
  }
}

/// First beside it, then renamed: readers see the old or the new file, never half of one.
void write_whole(const fs::path& path, const std::string& text) {
  fs::path draft = path;
  draft += ".draft";
  std::ofstream stream(draft, std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) throw InputError(fmt::format("{} cannot be written", path.string()));
  fs::rename(draft, path);
}

Json input_document(const ProblemInput& input, const Arguments& arguments) {
  Json document = {
      {"file", input.file.string()}, {"overrides", arguments.overrides}, {"hash", input.hash}};
  if (arguments.design) document["design"] = arguments.design->string();
  return document;
}

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

}  // namespace

RunRecord::RunRecord(const Arguments& arguments, Json options)
    : folder_(arguments.output.value_or(default_folder(arguments))), begin_(Clock::now()) {
  prepare_folder(folder_, arguments.command);
  card_["finished"] = false;
  card_["command"] = arguments.command;
  card_["arguments"] = arguments.words;
  card_["options"] = std::move(options);
  card_["versions"] = {{"pleuel", versions::pleuel},
                       {"nlopt", versions::nlopt},
                       {"ipopt", versions::ipopt},
                       {"eigen", versions::eigen},
                       {"klu", versions::klu},
                       {"compiler", versions::compiler},
                       {"build_type", versions::build_type}};
}

RunRecord::RunRecord(const Arguments& arguments, const ProblemInput& input, Json options)
    : RunRecord(arguments, std::move(options)) {
  card_["input"] = input_document(input, arguments);
  card_["problem"] = input.effective;
}

RunRecord::RunRecord(const Arguments& arguments, const std::vector<ProblemInput>& inputs,
                     Json options)
    : RunRecord(arguments, std::move(options)) {
  for (const ProblemInput& input : inputs) {
    card_["inputs"].push_back(input_document(input, arguments));
    card_["problems"].push_back(input.effective);
  }
}

void RunRecord::begin_phase(const std::string& name) {
  end_phase();
  phase_ = name;
  phase_begin_ = Clock::now();
}

void RunRecord::end_phase() {
  if (!phase_.empty()) phases_[phase_] = phases_.value(phase_, 0.0) + seconds_since(phase_begin_);
  phase_.clear();
}

fs::path RunRecord::result(const std::string& name) {
  if (!has_results_) replace_older_run();
  return folder_ / name;
}

void RunRecord::write(const std::string& name, const Json& document) {
  write_whole(result(name), to_text(document));
}

void RunRecord::finish(const Outcome& outcome) {
  end_phase();
  write("result.json", outcome.document);
  phases_["total"] = seconds_since(begin_);
  card_["finished"] = true;
  card_["exit_code"] = static_cast<int>(outcome.exit_code);
  card_["seconds"] = phases_;
  write(card_name, card_);
}

void RunRecord::replace_older_run() {
  has_results_ = true;
  write(card_name, card_);  // first: a folder without it would not be ours any more
  std::error_code error;
  for (const char* name : result_names) fs::remove(folder_ / name, error);
}

}  // namespace pleuel
