#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

#include "include/pleuel.h"
#include "optimization/backends.hpp"

namespace pleuel {

/// A search that a function of the caller makes, for as long as that runs. Evaluations of several threads wait for each
/// other.
class CalledSearch {
 public:
  explicit CalledSearch(ScaledProblem& problem) : problem_(&problem) {}

  /// What the caller's function asks for at y.
  /// @throws CallError        of status PLEUEL_STOPPED if the search is to end; if it has ended
  /// @throws SimulationError  if the design cannot be simulated
  ScaledEvaluation evaluate(const Eigen::VectorXd& y, Request request);
  int variables() const { return variables_; }
  int rows() const { return rows_; }

  /// No more evaluations.
  void end();

 private:
  std::mutex mutex_;  ///< of the problem
  ScaledProblem* problem_;
  const int variables_ = problem_->variables();
  const int rows_ = problem_->inequalities() + problem_->equalities();
};

/// @throws CallError if none of this number runs
std::shared_ptr<CalledSearch> find_called_search(std::uint64_t number);

/// A function of the caller as a backend.
struct CalledBackend {
  std::string name;
  bool takes_equalities = false;
  pleuel_backend function = nullptr;
  void* user = nullptr;
};

/// Its minimize() throws CallError if the function fails or throws.
std::unique_ptr<Optimizer> make_called_optimizer(const CalledBackend& backend,
                                                 const BackendOptions& options);

}  // namespace pleuel
