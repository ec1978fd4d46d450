#pragma once

#include "cli/input/arguments.hpp"

namespace pleuel {

/// The first of runs/NAME.html, NAME-2.html … that is not there.
fs::path free_page(const std::string& name);

/// @throws InputError if there is a file already that shall not be overwritten, or something else
void require_free(const fs::path& file, const Arguments& arguments);

/// The folder of a run: made if need be, and locked against other runs of the program until it is
/// destroyed or the program ends. A folder that was made and is still empty then goes again.
class RunFolder {
 public:
  /// By default runs/<file>-<command>, or where that is taken runs/<file>-<command>-2 and so on.
  /// @throws InputError if the folder cannot be written, if another run is at work in it, or if it
  ///         holds something: a run of the same command may be overwritten or go on if the user
  ///         says so, another one or foreign files may not
  explicit RunFolder(const Arguments& arguments);
  ~RunFolder();
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;

  const fs::path& path() const { return path_; }

  /// Removes what an older run left, but for its card, and the record that a run goes on with.
  void remove_older_results() const;

 private:
  void make();
  void lock();
  void check_content(const Arguments& arguments) const;
  void check_writable() const;

  fs::path path_;
  bool keeps_record_;
  fs::path made_;  ///< the outermost folder that was made for it; empty if none
  int lock_ = -1;
};

}  // namespace pleuel
