#pragma once

#include <filesystem>
#include <string>

#include "core/base/fingerprint.hpp"
#include "core/scene/body_source.hpp"

namespace pleuel {

/// What calls of one program returned, by their input: a folder, one file a call. Any number of threads and
/// processes may use it.
class CallRecord {
 public:
  /// Calls of another command, or with other contents of the files that it names, are others.
  explicit CallRecord(const BodyGenerator& generator);

  /// @returns what the call returned; empty if it is not known
  std::string find(const std::string& input) const;

  /// A folder that cannot be written to costs a call later, no more.
  void keep(const std::string& input, const std::string& output) const;

  /// Of the command and its files.
  std::string identity() const { return identity_.text(); }

 private:
  std::filesystem::path path_of(const std::string& input) const;

  std::filesystem::path folder_;
  Fingerprint identity_;
};

}  // namespace pleuel
