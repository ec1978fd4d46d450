#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "include/pleuel.h"
#include "library/open_problem.hpp"

namespace pleuel {

/// An error of a C function, taken apart.
struct CallFailure {
  pleuel_status kind = PLEUEL_FAULT;
  std::string file, pointer, rule, text;
};

/// Takes a message "file: /pointer rule, got value" apart, as far as it is one.
CallFailure divided(pleuel_status kind, const std::string& message);

/// Keeps what the exception that is being handled means as the last error of this thread. To be
/// called from a handler.
/// @param file  of the problem that the call was about; empty: messages name it, or there is none
/// @returns     its kind
pleuel_status keep_failure(const std::string& file) noexcept;

/// Of this thread.
const pleuel_error* last_error() noexcept;

/// A call that may be stopped, while it lasts. What was asked of the calls before is forgotten when the first
/// one begins.
class RunningCall {
 public:
  RunningCall() noexcept;
  ~RunningCall();
  RunningCall(const RunningCall&) = delete;
  RunningCall& operator=(const RunningCall&) = delete;
};

// What C functions do around their work: no exception leaves them, all arguments are checked.

/// Does work(); what it throws becomes the last error.
template <class Work>
pleuel_status guarded_call(const Work& work) noexcept {
  try {
    const RunningCall call;
    work();
    return PLEUEL_OK;
  } catch (...) {
    return keep_failure("");
  }
}

/// Does work(open problem), with whose file errors begin.
template <class Work>
pleuel_status guarded_call(pleuel_problem number, const Work& work) noexcept {
  std::shared_ptr<OpenProblem> problem;
  try {
    problem = find_open_problem(number);
    const RunningCall call;
    work(*problem);
    return PLEUEL_OK;
  } catch (...) {
    return keep_failure(problem ? problem->file_name() : std::string());
  }
}

/// @throws CallError  "problem must not be NULL"
void require_pointer(const void* pointer, const char* name);

/// @throws CallError  "the problem has 3 variables, got the size 2"
void require_size(std::size_t size, std::size_t expected, const char* name);

/// A design of the problem. @throws CallError if it is none: wrong size, NULL, not finite
Eigen::VectorXd checked_design(const OpenProblem& problem, const double* x, std::size_t variables);

/// @throws CallError if the list has no such thing
void require_index(std::size_t index, std::size_t count, const char* name);

/// Writes a vector, if an array is there for it.
void copy_out(const Eigen::VectorXd& from, double* to);
/// Row by row.
void copy_out(const Eigen::MatrixXd& from, double* to);

/// A copy that the caller gives back by pleuel_free().
char* text_out(const std::string& text);

}  // namespace pleuel
