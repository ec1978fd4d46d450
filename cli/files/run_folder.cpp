#include "cli/files/run_folder.hpp"

#include <algorithm>
#include <array>
#include <cerrno>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include "cli/files/older_run.hpp"
#include "core/base/error.hpp"
#include "core/base/plain_file_name.hpp"

namespace pleuel {

namespace {

/// What a run of any command may leave beside the card, but for the record of evaluations.
bool is_result(const std::string& name) {
  for (const char* known :
       {"result.json", "report.html", "failed_design.json", "history.csv", "trajectory.csv",
        "gradients.csv", "accuracy.csv", "accuracy.svg", "accuracy-gradients.svg",
        "accuracy-optimum.svg", "pareto.csv", "prices.csv", "stability.csv", "uncertainty.csv",
        "evaluations.csv", "evaluation_gradients.csv"}) {
    if (name == known) return true;
  }
  const bool is_motion =  // of both designs, in each load case
      name.starts_with("trajectory-start") || name.starts_with("trajectory-optimum");
  return (is_motion && name.ends_with(".csv")) ||
         (name.starts_with("plot") && name.ends_with(".svg"));
}

template <class IsOurs>
void remove_files(const fs::path& folder, const IsOurs& is_ours) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (is_ours(entry.path().filename().string())) fs::remove(entry, error);
  }
}

/// The record of evaluations, with its log.
constexpr std::array<const char*, 3> record_names = {"run.sqlite", "run.sqlite-wal",
                                                     "run.sqlite-shm"};

fs::path usual_folder(const Arguments& arguments) {
  if (arguments.files.size() > 1) return fs::path("runs") / arguments.command;
  const fs::path& file = arguments.files.empty() ? arguments.file : arguments.files.front();
  const std::string of_case =
      arguments.load_case ? "-" + plain_file_name(*arguments.load_case) : "";
  return fs::path("runs") / (file.stem().string() + "-" + arguments.command + of_case);
}

/// The command that the card of an older run names; empty if there is none that can be read.
std::string command_of(const fs::path& folder) {
  const auto run = find_older_run(folder);
  return run ? run->command() : "";
}

/// Whether there is nothing but drafts of the card of runs that were killed while they wrote it.
bool has_begun_only(const fs::path& folder) {
  return std::all_of(fs::directory_iterator(folder), {}, [](const fs::directory_entry& entry) {
    const std::string name = entry.path().filename().string();
    return name.starts_with(std::string(card_name) + ".") && name.ends_with(".draft");
  });
}

[[noreturn]] void refuse(const fs::path& folder, const std::string& reason) {
  throw InputError(fmt::format("-o {}: {}", folder.string(), reason));
}

/// The first of NAME, NAME-2, NAME-3 … with this ending that is not there.
fs::path free_path(const std::string& name, const std::string& ending) {
  fs::path free = name + ending;
  for (int number = 2; fs::exists(fs::symlink_status(free)); ++number) {
    free = fmt::format("{}-{}{}", name, number, ending);
  }
  return free;
}

}  // namespace

fs::path free_page(const std::string& name) {
  return free_path("runs/" + name, ".html");
}

void require_free(const fs::path& file, const Arguments& arguments) {
  const fs::file_status status = fs::symlink_status(file);
  if (!fs::exists(status)) return;
  const std::string name = (arguments.output == file ? "-o " : "") + file.string();
  if (!fs::is_regular_file(status)) {
    throw InputError(name + ": is there already, and no ordinary file");
  }
  if (!arguments.overwrites) {
    throw InputError(name + ": is there already; --overwrite replaces it");
  }
}

RunFolder::RunFolder(const Arguments& arguments)
    : path_(arguments.output ? *arguments.output
            : arguments.overwrites || arguments.resumes
                ? usual_folder(arguments)
                : free_path(usual_folder(arguments).string(), "")),
      keeps_record_(arguments.resumes) {
  if (fs::exists(path_) && !fs::is_directory(path_)) refuse(path_, "is a file, not a folder");
  make();
  lock();
  check_content(arguments);
  check_writable();
}

RunFolder::~RunFolder() {
  std::error_code error;
  for (fs::path folder = path_; !made_.empty(); folder = folder.parent_path()) {
    if (!fs::remove(folder, error) || folder == made_) break;
  }
  if (lock_ != -1) ::close(lock_);
}

void RunFolder::make() {
  fs::path outermost;
  for (fs::path folder = path_; !folder.empty() && !fs::exists(folder);
       folder = folder.parent_path()) {
    outermost = folder;
  }
  std::error_code error;
  fs::create_directories(path_, error);
  if (error) refuse(path_, "cannot be created: " + error.message());
  made_ = outermost;
}

void RunFolder::lock() {
  lock_ = ::open(path_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  // File systems without locks do not keep anybody from working.
  if (lock_ != -1 && ::flock(lock_, LOCK_EX | LOCK_NB) == -1 && errno == EWOULDBLOCK) {
    ::close(lock_);
    refuse(path_,
           "another run is at work in this folder; wait for its end, or choose another name");
  }
}

void RunFolder::check_content(const Arguments& arguments) const {
  if (has_begun_only(path_)) return;
  if (!fs::exists(path_ / card_name)) {
    refuse(path_, fmt::format("the folder holds something else than a run (it has no {}); choose "
                              "another name",
                              card_name));
  }
  const std::string older = command_of(path_);
  if (!older.empty() && older != arguments.command) {
    refuse(path_, fmt::format("holds a run of `pleuel {}`; choose another name", older));
  }
  if (arguments.overwrites || arguments.resumes) return;
  refuse(path_, fmt::format(
                    "holds a run already; choose another name{}, or replace it with "
                    "--overwrite",
                    fs::exists(path_ / record_names.front()) ? ", go on with it by --resume" : ""));
}

void RunFolder::check_writable() const {
  if (::access(path_.c_str(), W_OK | X_OK) == -1) refuse(path_, "cannot be written");
}

void RunFolder::remove_older_results() const {
  remove_files(path_, [&](const std::string& name) {
    const bool is_record = std::ranges::find(record_names, name) != record_names.end();
    return is_result(name) || (is_record && !keeps_record_);
  });
  remove_files(path_ / "vtk", [](const std::string& name) {
    return name.ends_with(".vtu") || name.ends_with(".pvd");
  });
  remove_files(path_ / "bodies", [](const std::string& name) { return name.ends_with(".json"); });
}

}  // namespace pleuel
