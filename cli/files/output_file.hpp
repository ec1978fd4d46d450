#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace pleuel {

/// Makes the folder that a file is to be written to, where it is not there.
/// @throws InputError if it cannot be made
void make_folder_of(const std::filesystem::path& file);

/// Where a result is to be written.
struct ResultFile {
  std::filesystem::path path;
  /// Results that could not be written: a run goes on without them, and says so. Null: nobody can go
  /// on without this one.
  std::vector<std::string>* unwritten;

  /// That it could not be written. Also tells standard error, the first time for each file.
  void note(const std::string& reason) const;
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

  /// @returns why not all could be written; empty: it could
  const std::string& close();

 private:
  void fail(int error);

  ResultFile file_;
  int descriptor_;
  std::string failure_;
};

/// Writes a whole file: first beside it, then renamed. Readers see the old or the new one, never
/// half of one.
/// @returns whether it could be written
/// @throws InputError if it could not, and nobody goes on without it
bool write_file(const ResultFile& file, const std::string& text);

}  // namespace pleuel
