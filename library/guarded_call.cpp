#include "library/guarded_call.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <new>
#include <utility>

#include <fmt/format.h>

#include "cli/interruption.hpp"
#include "core/base/stop.hpp"
#include "library/open_problem.hpp"

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

namespace {

std::atomic<int> running = 0;

}  // namespace

RunningCall::RunningCall() noexcept {
  if (running.fetch_add(1) == 0) withdraw_stop();
}

RunningCall::~RunningCall() {
  running.fetch_sub(1);
}

void require_pointer(const void* pointer, const char* name) {
  if (pointer == nullptr) throw CallError(fmt::format("{} must not be NULL", name));
}

void require_size(std::size_t size, std::size_t expected, const char* name) {
  if (size == expected) return;
  throw CallError(fmt::format("the problem has {} {}, got the size {}", expected, name, size));
}

Eigen::VectorXd checked_design(const OpenProblem& problem, const double* x, std::size_t variables) {
  const std::vector<std::string>& names = problem.names(PLEUEL_VARIABLES);
  require_size(variables, names.size(), "variables");
  if (variables > 0) require_pointer(x, "x");
  for (std::size_t i = 0; i < variables; ++i) {
    if (std::isfinite(x[i])) continue;
    throw CallError(
        fmt::format("x[{}], the variable \"{}\", must be finite, got {}", i, names[i], x[i]));
  }
  return Eigen::Map<const Eigen::VectorXd>(x, static_cast<Eigen::Index>(variables));
}

void require_index(std::size_t index, std::size_t count, const char* name) {
  if (index >= count) {
    throw CallError(fmt::format("{} must be less than {}, got {}", name, count, index));
  }
}

void copy_out(const Eigen::VectorXd& from, double* to) {
  if (to != nullptr) Eigen::Map<Eigen::VectorXd>(to, from.size()) = from;
}

void copy_out(const Eigen::MatrixXd& from, double* to) {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  if (to != nullptr) Eigen::Map<Rows>(to, from.rows(), from.cols()) = from;
}

char* text_out(const std::string& text) {
  char* copy = static_cast<char*>(std::malloc(text.size() + 1));
  if (copy == nullptr) throw std::bad_alloc();
  std::memcpy(copy, text.c_str(), text.size() + 1);
  return copy;
}

}  // namespace pleuel
