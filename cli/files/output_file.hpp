#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace pleuel {

/// Results that could not be written: a run goes on without them, and says so.
class WriteFailures {
 public:
  /// Also tells standard error, the first time for each file, unless silenced.
  void note(const std::filesystem::path& path, const std::string& reason);

  /// The files.
  const std::vector<std::string>& files() const { return files_; }

  /// Of the first one.
  const std::string& reason() const { return reason_; }

  /// For those who tell it themselves.
  void silence() { is_silent_ = true; }

 private:
  std::vector<std::string> files_;
  std::string reason_;
  bool is_silent_ = false;
};

/// Makes the folder that a file is to be written to, where it is not there.
/// @throws InputError if it cannot be made
void make_folder_of(const std::filesystem::path& file);

/// Where a result is to be written, and who is to hear if it cannot be.
struct ResultFile {
  std::filesystem::path path;
  WriteFailures* failures;
};

/// A new file, in place of one of this name. It is made anew: neither a link nor another name of
/// the older file leads the text elsewhere. The first failure is noted and ends its writing.
class OutputFile {
 public:
  explicit OutputFile(const ResultFile& file) : OutputFile(file, file.path) {}

  /// Writes to another path for now: a draft.
  OutputFile(ResultFile file, const std::filesystem::path& draft);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// All of it or nothing: a part that went in is cut off again.
  void write(const std::string& text);

  /// @returns whether all could be written
  bool close();

 private:
  void fail(int error);

  ResultFile file_;
  int descriptor_;
  bool has_failed_ = false;
};

/// Writes a whole file: first beside it, then renamed. Readers see the old or the new one, never
/// half of one.
/// @returns whether it could be written
bool write_file(const ResultFile& file, const std::string& text);

}  // namespace pleuel
