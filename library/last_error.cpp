#include "library/last_error.hpp"

#include <algorithm>
#include <utility>

#include "cli/failure.hpp"
#include "library/call_error.hpp"

namespace pleuel {

namespace {

/// The texts and the pointers to them.
struct KeptError {
  CallFailure failure;
  pleuel_error shown{PLEUEL_OK, "", "", "", ""};

  void keep(CallFailure one) {
    failure = std::move(one);
    shown = {failure.kind, failure.file.c_str(), failure.pointer.c_str(), failure.rule.c_str(),
             failure.text.c_str()};
  }
};

KeptError& kept_error() {
  thread_local KeptError kept;
  return kept;
}

pleuel_status kind_of(const Failure& failure) {
  return failure.is_stopped ? PLEUEL_STOPPED : static_cast<pleuel_status>(failure.code);
}

CallFailure handled_failure(const std::string& file) {
  try {
    throw;
  } catch (const CallError& error) {
    CallFailure failure = divided(error.status, error.what());
    failure.file = file;
    return failure;
  } catch (...) {
    const Failure failure = current_failure();
    const bool names_file = file.empty() || failure.message.starts_with(file);
    const bool is_of_file =
        kind_of(failure) == PLEUEL_BAD_INPUT || kind_of(failure) == PLEUEL_SIMULATION_FAILED;
    return divided(kind_of(failure),
                   names_file || !is_of_file ? failure.message : file + ": " + failure.message);
  }
}

}  // namespace

CallFailure divided(pleuel_status kind, const std::string& message) {
  CallFailure failure{kind, {}, {}, message, message};
  if (const std::size_t end = message.find(": "); end < message.find_first_of(" \n")) {
    failure.file = message.substr(0, end);
    failure.rule = message.substr(end + 2);
  }
  if (failure.rule.starts_with("/")) {
    const std::size_t end = std::min(failure.rule.find(' '), failure.rule.size());
    failure.pointer = failure.rule.substr(0, end);
    failure.rule.erase(0, std::min(end + 1, failure.rule.size()));
    if (failure.pointer.ends_with(":")) failure.pointer.pop_back();
  }
  return failure;
}

pleuel_status keep_failure(const std::string& file) noexcept {
  try {
    kept_error().keep(handled_failure(file));
    return kept_error().shown.kind;
  } catch (...) {  // of a message, for want of memory
    constexpr const char* text = "the memory of the machine is used up";
    kept_error().shown = {PLEUEL_FAULT, "", "", text, text};
    return PLEUEL_FAULT;
  }
}

const pleuel_error* last_error() noexcept {
  return &kept_error().shown;
}

}  // namespace pleuel
