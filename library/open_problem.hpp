#pragma once

#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/problem_text.hpp"
#include "include/pleuel.h"
#include "optimization/design/design_problem.hpp"
#include "sensitivity/history_gradients.hpp"

namespace pleuel {

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

}  // namespace pleuel
