#include "core/scene/reading/call_record.hpp"

#include <atomic>
#include <fstream>
#include <iterator>

#include <fmt/format.h>
#include <unistd.h>

#include "core/base/plain_file_name.hpp"

namespace pleuel {

namespace {

namespace fs = std::filesystem;

std::string content_of_file(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace

CallRecord::CallRecord(const BodyGenerator& generator) : folder_(generator.record) {
  std::vector<std::string> words = generator.command;
  words.insert(words.end(), generator.files.begin(), generator.files.end());
  for (const std::string& word : words) {
    identity_.add(word);
    const fs::path file = fs::path(generator.folder) / word;
    std::error_code error;
    if (fs::is_regular_file(file, error)) identity_.add(content_of_file(file));
  }
}

std::string CallRecord::find(const std::string& input) const {
  return folder_.empty() ? "" : content_of_file(path_of(input));
}

/// Written beside it and renamed: nobody reads half of it.
void CallRecord::keep(const std::string& input, const std::string& output) const {
  if (folder_.empty()) return;
  static std::atomic<int> count = 0;
  std::error_code error;
  fs::create_directories(folder_, error);
  const fs::path path = path_of(input);
  const fs::path draft = fmt::format("{}.{}.{}", path.string(), ::getpid(), count++);
  std::ofstream stream(draft, std::ios::binary);
  stream << output;
  stream.close();
  if (stream) fs::rename(draft, path, error);
}

fs::path CallRecord::path_of(const std::string& input) const {
  Fingerprint fingerprint = identity_;
  fingerprint.add(input);
  return folder_ / (plain_file_name(fingerprint.text()) + ".json");
}

}  // namespace pleuel
