#include "cli/files/output_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "cli/text/console.hpp"
#include "core/base/error.hpp"

namespace pleuel {

namespace fs = std::filesystem;

void ResultFile::note(const std::string& reason) const {
  if (unwritten == nullptr) return;
  if (std::ranges::find(*unwritten, path.string()) != unwritten->end()) return;
  unwritten->push_back(path.string());
  show(stderr, fmt::format("pleuel: {} cannot be written: {}\n", path.string(), reason));
}

void make_folder_of(const fs::path& file) {
  if (!file.has_parent_path()) return;
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  if (error) {
    throw InputError(
        fmt::format("{}: cannot be created: {}", file.parent_path().string(), error.message()));
  }
}

OutputFile::OutputFile(ResultFile file, const fs::path& draft) : file_(std::move(file)) {
  ::unlink(draft.c_str());
  descriptor_ = ::open(draft.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (descriptor_ == -1) fail(errno);
}

OutputFile::~OutputFile() {
  close();
}

void OutputFile::write(const std::string& text) {
  if (!failure_.empty()) return;
  const off_t begin = ::lseek(descriptor_, 0, SEEK_CUR);
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t count = ::write(descriptor_, text.data() + done, text.size() - done);
    if (count == -1 && errno == EINTR) continue;
    if (count == -1) {
      const int error = errno;
      // Half a line would be read as a whole one. If it cannot be cut off, the failure is told
      // anyway.
      [[maybe_unused]] const int is_cut = ::ftruncate(descriptor_, begin);
      return fail(error);
    }
    done += static_cast<std::size_t>(count);
  }
}

const std::string& OutputFile::close() {
  if (descriptor_ != -1 && ::close(descriptor_) == -1) fail(errno);
  descriptor_ = -1;
  return failure_;
}

void OutputFile::fail(int error) {
  failure_ = std::strerror(error);
  file_.note(failure_);
}

bool write_file(const ResultFile& file, const std::string& text) {
  fs::path draft = file.path;
  draft += fmt::format(".{}.draft", ::getpid());
  std::error_code error;
  OutputFile output(file, draft);
  output.write(text);
  std::string failure = output.close();
  if (failure.empty()) {
    fs::rename(draft, file.path, error);
    if (!error) return true;
    failure = error.message();
    file.note(failure);
  }
  fs::remove(draft, error);
  if (file.unwritten != nullptr) return false;
  throw InputError(fmt::format("{}: cannot be written: {}", file.path.string(), failure));
}

}  // namespace pleuel
