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

/// Everything that a run of any command may leave.
constexpr std::array<const char*, 12> result_names = {"history.csv",
                                                      "result.json",
                                                      "trajectory.csv",
                                                      "trajectory-start.csv",
                                                      "trajectory-optimum.csv",
                                                      "pareto.csv",
                                                      "accuracy.csv",
                                                      "stability.csv",
                                                      "uncertainty.csv",
                                                      "gradients.csv",
                                                      "failed_design.json",
                                                      card_name};

fs::path default_folder(const Arguments& arguments) {
  if (arguments.files.size() > 1) return fs::path("runs") / arguments.command;
  const fs::path& file = arguments.files.empty() ? arguments.file : arguments.files.front();
  return fs::path("runs") / (file.stem().string() + "-" + arguments.command);
}

void prepare_folder(const fs::path& folder) {
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
  for (const char* name : result_names) fs::remove(folder / name, error);
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
  prepare_folder(folder_);
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
  write_card();
}

RunRecord::RunRecord(const Arguments& arguments, const std::vector<ProblemInput>& inputs,
                     Json options)
    : RunRecord(arguments, std::move(options)) {
  for (const ProblemInput& input : inputs) {
    card_["inputs"].push_back(input_document(input, arguments));
    card_["problems"].push_back(input.effective);
  }
  write_card();
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

void RunRecord::write(const std::string& name, const Json& document) const {
  write_whole(folder_ / name, to_text(document));
}

void RunRecord::finish(const Outcome& outcome) {
  end_phase();
  write("result.json", outcome.document);
  phases_["total"] = seconds_since(begin_);
  card_["finished"] = true;
  card_["exit_code"] = static_cast<int>(outcome.exit_code);
  card_["seconds"] = phases_;
  write_card();
}

void RunRecord::write_card() {
  write(card_name, card_);
}

}  // namespace pleuel
