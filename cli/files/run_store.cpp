#include "cli/files/run_store.hpp"

#include <ctime>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "cli/files/command_text.hpp"
#include "cli/input/fingerprint.hpp"
#include "cli/text/console.hpp"
#include "core/base/error.hpp"
#include "core/base/stop.hpp"

namespace pleuel {

namespace {

/// What has to be the same for a run to go on, and how a user would call it.
constexpr std::pair<const char*, const char*> decisive[] = {
    {"command", "command"},
    {"problem", "problem"},
    {"files", "file that the problem names"},
    {"design", "start"},
    {"options", "options"},
    {"versions", "version of Pleuel or what it is made of"},
    {"program", "build of Pleuel"}};

std::string utc_now() {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
}

/// "/simulation/step is \"0.1 ms\" there and \"0.2 ms\" here"
std::string first_difference(const Json& there, const Json& here) {
  for (const Json& change : Json::diff(there, here)) {
    const Json::json_pointer place(change.at("path").get<std::string>());
    const auto text = [&](const Json& document) {
      return document.contains(place) ? document.at(place).dump() : std::string("missing");
    };
    return fmt::format("{} is {} there and {} here", place.empty() ? "it" : place.to_string(),
                       text(there), text(here));
  }
  const std::string place = first_reordered(there, here).value_or("");
  return fmt::format("the keys of {} stand in another order", place.empty() ? "the file" : place);
}

}  // namespace

RunStore::RunStore(RunRecord& record, const Arguments& arguments, const ProblemInput& input,
                   Json options)
    : record_(record), arguments_(arguments) {
  description_ = {{"command", arguments.command},
                  {"arguments", arguments.words},
                  {"problem", input.effective},
                  {"files", fingerprints_of_files(input.effective, input.file)},
                  {"design", by_name(input.problem.variables, input.design)},
                  {"options", std::move(options)},
                  {"versions", record.versions()},
                  {"program", program_fingerprint()},
                  {"variables", list_of(input.problem.variables, &DesignVariable::name)},
                  {"constraints", list_of(input.problem.constraints, &ConstraintSettings::name)}};
  if (arguments.resumes) open_older();
}

void RunStore::open_older() {
  const fs::path file = record_.folder() / database_name;
  if (!fs::exists(file)) return begin_without_record();
  try {
    database_.emplace(file);
    database_->check();
    check_same_run();
    goes_on_ = true;
  } catch (const DatabaseError& error) {
    throw InputError(fmt::format("--resume: {}: {}; {}", file.string(), error.what(), begin_anew));
  }
}

/// A script may ask for --resume from the first time on; results that are there are not replaced.
void RunStore::begin_without_record() const {
  const std::string folder = record_.folder().string();
  if (fs::exists(record_.folder() / "result.json")) {
    throw InputError(
        fmt::format("--resume: {} has results and no {}: there is nothing to resume; take another "
                    "folder, or --overwrite",
                    folder, database_name));
  }
  show(stderr, fmt::format("pleuel: note: --resume: {} has no {}: there is nothing to resume, the "
                           "run begins anew\n",
                           folder, database_name));
}

void RunStore::check_same_run() const {
  const bool is_described = database_->description("begun").has_value();
  if (!is_described && database_->evaluations() == 0) return;  // killed before it was
  const auto older = [&](const std::string& name) {
    const auto text = database_->description(name);
    if (!text) throw DatabaseError(fmt::format("the table run has no row {}", name));
    return Json::parse(*text);
  };
  for (const auto& [name, word] : decisive) {
    const Json there = older(name), &here = description_.at(name);
    if (there == here) continue;
    throw InputError(
        fmt::format("--resume: {} holds a run with another {}: {}; take that one again; {}",
                    record_.folder().string(), word, first_difference(there, here), begin_anew));
  }
}

void RunStore::describe_run() {
  if (is_described_ || database_->description("begun")) return;
  is_described_ = true;
  for (const auto& [name, value] : description_.items()) database_->describe(name, value.dump());
  database_->describe("begun", Json(utc_now()).dump());  // last: all else is there then
}

template <class Action>
void RunStore::attempt(const Action& action) {
  if (has_failed_) return;
  const ResultFile file = record_.result(database_name);
  try {
    if (!database_) database_.emplace(file.path);
    describe_run();
    if (first_) database_->keep(first_->first, first_->second);
    first_.reset();
    action(*database_);
    is_begun_ = true;
  } catch (const DatabaseError& error) {
    has_failed_ = true;
    file.note(error.what());
    if (is_begun_) stop();
  }
}

/// What a record has begun with is not to be lost for what comes after it.
void RunStore::stop() const {
  show(stderr,
       "pleuel: what comes from here on could not be kept, and the run stops; what was recorded "
       "stays, and --resume goes on from there\n");
  request_stop();
}

std::optional<StoredEvaluation> RunStore::find(const EvaluationKey& key) {
  std::optional<StoredEvaluation> found;
  if (!database_) return found;  // nothing is known before the first
  attempt([&](RunDatabase& database) { found = database.find(key); });
  known_ += found ? 1 : 0;
  return found;
}

void RunStore::keep(const EvaluationKey& key, const StoredEvaluation& stored) {
  if (++made_ == 1 && !database_) {
    first_.emplace(key, stored);
    return;
  }
  attempt([&](RunDatabase& database) { database.keep(key, stored); });
}

void RunStore::confirm(const EvaluationKey& key, const StoredEvaluation& again) {
  attempt([&](RunDatabase& database) { database.confirm(key, again); });
  ++confirmed_;
}

std::optional<std::string> RunStore::find_part(const std::string& name) {
  std::optional<std::string> found;
  if (!database_) return found;
  attempt([&](RunDatabase& database) { found = database.find_part(name); });
  known_parts_ += found ? 1 : 0;
  return found;
}

void RunStore::keep_part(const std::string& name, const std::string& content) {
  ++made_parts_;
  attempt([&](RunDatabase& database) { database.keep_part(name, content); });
}

void RunStore::add(const EvaluationRecord& record) {
  attempt([&](RunDatabase& database) {
    if (!has_history_) database.clear_history();
    has_history_ = true;
    database.add(record);
  });
}

void RunStore::finish(Outcome& outcome) {
  attempt([&](RunDatabase& database) {
    database.describe("result", outcome.document.dump());
    database.describe("ended", Json(utc_now()).dump());
  });
  const bool is_interrupted = outcome.document.value("status", "") == "interrupted" ||
                              outcome.document.contains("interrupted");
  if (is_interrupted) {
    outcome.text += "To go on from there: " + typed_command(arguments_);
    if (!arguments_.output) outcome.text += " -o " + shell_word(record_.folder().string());
    outcome.text += arguments_.resumes ? "\n" : " --resume\n";
  }
  outcome.text += known_text();
}

std::string RunStore::known_text() const {
  if (!goes_on_) return "";
  const std::string file = (record_.folder() / database_name).string();
  std::string text;
  if (known_ + made_ > 0) {
    text += fmt::format("{} of {} evaluations were known from {}\n", known_, known_ + made_, file);
  }
  if (confirmed_ > 0) {
    text += fmt::format("{} of them were made again for the verdict, and agree\n", confirmed_);
  }
  if (known_parts_ + made_parts_ > 0) {
    text += fmt::format("{} of {} parts of the study were known from {}\n", known_parts_,
                        known_parts_ + made_parts_, file);
  }
  return text;
}

}  // namespace pleuel
