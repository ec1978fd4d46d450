#include "library/called_optimizer.hpp"

#include <array>
#include <utility>

#include <fmt/format.h>

#include "core/base/int_size.hpp"
#include "library/open_problem.hpp"

namespace pleuel {

namespace {

/// Never destroyed: threads of the caller may outlive what the program ends with.
HandleTable<CalledSearch>& called_searches() {
  static auto& one = *new HandleTable<CalledSearch>(
      "the search {} does not run: its backend has returned, or it never began");
  return one;
}

/// In the table while it lasts.
class Running {
 public:
  explicit Running(ScaledProblem& problem)
      : search_(std::make_shared<CalledSearch>(problem)), number_(called_searches().add(search_)) {}
  ~Running() {
    called_searches().remove(number_);
    search_->end();
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  std::uint64_t number() const { return number_; }

 private:
  std::shared_ptr<CalledSearch> search_;
  std::uint64_t number_;
};

class CalledOptimizer : public Optimizer {
 public:
  CalledOptimizer(CalledBackend backend, const BackendOptions& options)
      : backend_(std::move(backend)), options_(options) {}

  bool takes_equalities() const override { return backend_.takes_equalities; }

  BackendResult minimize(ScaledProblem& problem) override {
    const Eigen::VectorXd start = problem.start(), lower = problem.lower(), upper = problem.upper();
    const auto size = [](int count) { return static_cast<std::size_t>(count); };
    const Running one(problem);
    const pleuel_search search = {one.number(),
                                  size(problem.variables()),
                                  size(problem.inequalities()),
                                  size(problem.equalities()),
                                  start.data(),
                                  lower.data(),
                                  upper.data(),
                                  options_.tolerance};
    BackendResult result{start, ""};
    result.reason = called(search, result.y.data());
    return result;
  }

 private:
  /// @param y  from where the search begins to where it ended
  /// @returns  why it ended
  std::string called(const pleuel_search& search, double* y) const {
    std::array<char, PLEUEL_REASON_SIZE> reason{};
    int failure = 0;
    try {
      failure = backend_.function(&search, y, reason.data(), backend_.user);
    } catch (...) {
      throw CallError(fmt::format("the backend \"{}\" threw an exception; it must return instead",
                                  backend_.name));
    }
    reason.back() = '\0';
    const std::string text = reason.data();
    if (failure == 0) return text.empty() ? "it has returned" : text;
    throw CallError(fmt::format("the backend \"{}\" failed: {}", backend_.name,
                                text.empty() ? fmt::format("it returned {}", failure) : text));
  }

  CalledBackend backend_;
  BackendOptions options_;
};

}  // namespace

ScaledEvaluation CalledSearch::evaluate(const Eigen::VectorXd& y, Request request) {
  const std::lock_guard lock(mutex_);
  if (problem_ == nullptr) throw CallError("the search has ended: its backend has returned");
  std::optional<ScaledEvaluation> found = problem_->evaluate(y, request);
  if (found) return *std::move(found);
  if (problem_->should_stop()) {
    throw CallError("the search is to end: the backend must return", PLEUEL_STOPPED);
  }
  throw SimulationError(problem_->failure());
}

void CalledSearch::end() {
  const std::lock_guard lock(mutex_);
  problem_ = nullptr;
}

std::shared_ptr<CalledSearch> find_called_search(std::uint64_t number) {
  return called_searches().find(number);
}

std::unique_ptr<Optimizer> make_called_optimizer(const CalledBackend& backend,
                                                 const BackendOptions& options) {
  return std::make_unique<CalledOptimizer>(backend, options);
}

}  // namespace pleuel
