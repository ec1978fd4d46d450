#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/scene/problem_text.hpp"
#include "include/pleuel.h"
#include "optimization/design/design_problem.hpp"
#include "sensitivity/gradients.hpp"

namespace pleuel {

/// A C function was called in a way that it cannot be: the message says which argument is wrong, and how.
class CallError : public std::runtime_error {
 public:
  explicit CallError(const std::string& text, pleuel_status status = PLEUEL_BAD_CALL)
      : std::runtime_error(text), status(status) {}

  pleuel_status status;
};

/// A problem that another program has opened. Its simulations are made one at a time; what it says of the problem
/// may be read meanwhile.
class OpenProblem {
 public:
  /// @param text  of which the text may be missing: then it is that of the file
  /// @throws InputError
  OpenProblem(const ProblemText& text, bool has_text);

  const std::string& file_name() const { return file_name_; }
  const ProblemFile& file() const { return file_; }

  /// @throws CallError if there is no such list
  const std::vector<std::string>& names(pleuel_list list) const;
  /// SI units of the things of a list; empty for those without.
  const std::vector<std::string>& units(pleuel_list list) const;

  /// Of objective and limits. @throws InputError if there is no objective; SimulationError
  Evaluation evaluate(const Eigen::VectorXd& x, Request request);
  /// Of all responses, which stand as constraints. @throws SimulationError
  Evaluation evaluate_responses(const Eigen::VectorXd& x, Request request);

  /// The curve that stands for the history of a response; empty if it has none.
  struct Curve {
    Eigen::VectorXd time, values;
  };
  Curve history(const Eigen::VectorXd& x, std::size_t response);
  /// The history at the place of the peak, with derivatives by the variables; nothing if the response has none.
  std::optional<HistoryGradients> history_gradients(const Eigen::VectorXd& x, std::size_t response);

 private:
  /// @throws InputError if nothing can be designed
  DesignProblem& problem();
  /// Of a response that is of one load case.
  std::optional<OfCase> place_of(std::size_t response) const;

  std::string file_name_;
  ProblemFile file_;
  std::map<pleuel_list, std::vector<std::string>> names_, units_;
  std::mutex mutex_;  ///< of what follows
  std::unique_ptr<DesignProblem> problem_;
  Eigen::VectorXd differentiated_x_;
  std::map<std::size_t, std::vector<HistoryGradients>> differentiated_;  ///< by load case
};

// The table of problems that are open: numbers of others name nothing, whatever they are.

/// @returns its number, which no other problem of this process ever has
pleuel_problem add_open_problem(std::shared_ptr<OpenProblem> problem);

/// @throws CallError if none of this number is open
std::shared_ptr<OpenProblem> find_open_problem(pleuel_problem number);

/// @throws CallError if none of this number is open
void remove_open_problem(pleuel_problem number);

/// What another program knows by numbers: none is used twice, and others name nothing, whatever they are.
template <class Thing>
class HandleTable {
 public:
  /// @param refusal  of numbers that name nothing: "the problem {} is not open"
  explicit HandleTable(const char* refusal) : refusal_(refusal) {}

  std::uint64_t add(std::shared_ptr<Thing> thing) {
    const std::lock_guard lock(mutex_);
    things_.emplace(++last_, std::move(thing));
    return last_;
  }

  /// @throws CallError if there is none of this number
  std::shared_ptr<Thing> find(std::uint64_t number) {
    const std::lock_guard lock(mutex_);
    return place_of(number)->second;
  }

  /// @throws CallError if there is none of this number
  std::shared_ptr<Thing> remove(std::uint64_t number) {
    const std::lock_guard lock(mutex_);
    const auto place = place_of(number);
    std::shared_ptr<Thing> removed = std::move(place->second);
    things_.erase(place);
    return removed;
  }

 private:
  auto place_of(std::uint64_t number) {
    const auto place = things_.find(number);
    if (place == things_.end()) throw CallError(fmt::format(fmt::runtime(refusal_), number));
    return place;
  }

  const char* refusal_;
  std::mutex mutex_;
  std::uint64_t last_ = 0;
  std::unordered_map<std::uint64_t, std::shared_ptr<Thing>> things_;
};

}  // namespace pleuel
