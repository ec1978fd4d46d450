#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/shown_unit.hpp"
#include "optimization/design/design_case.hpp"
#include "optimization/problem.hpp"

namespace pleuel {

/// A response of the joined problem by itself, neither limited nor minimized in its case.
RowSource response_row(const ProblemFile& joined, std::size_t response, double sign = 1.0);

/// The optimization problem that a problem file describes: responses of the simulated mechanism as
/// objective (of a response that is maximized its negative) and constraints. Of a file with load
/// cases each is simulated by itself (design_case.hpp), several at a time; responses and constraints
/// are those of all cases.
class DesignProblem : public Problem {
 public:
  /// @throws InputError if the file has no variables or no objective
  /// @param threads  simulations at a time, of cases and of gradients by differences
  /// @param store    has evaluations that are known, and keeps those that are made; must outlive
  ///                 this
  explicit DesignProblem(ProblemFile file, int threads = 1, EvaluationStore* store = nullptr);

  /// Begins at another design, within the bounds, than the start of the file; what the model
  /// decides at the start of the file stays.
  void start_from(const Eigen::VectorXd& x) { set_start(variables_, x); }

  const std::vector<Variable>& variables() const override { return variables_; }
  const std::vector<Constraint>& constraints() const override { return constraints_; }
  /// With a minus where the response is maximized.
  std::string objective_name() const override;
  /// In the units that the user wrote, or those of engineers.
  std::string variable_text(std::size_t variable, double value) const override;
  std::string constraint_text(std::size_t constraint, double value) const override;
  /// @param value  of the objective, the negative of a response that is maximized
  std::string objective_text(double value) const;
  /// 1, or −1 where the response is maximized: objective = sign · response.
  double objective_sign() const { return file_.objective->sign(); }

  /// The simulations of the design seen last are kept, so that its gradients cost no second ones.
  Evaluation evaluate(const Eigen::VectorXd& x, Request request) override;

  /// The same with other rows in place of the constraints; in each case one run of the chosen
  /// method for all. What fails says in which case.
  Evaluation evaluate_rows(const Eigen::VectorXd& x, Request request, const NamedRows& rows);

  /// Makes evaluations of an older run at these designs again.
  /// @throws InputError if they differ from what is known of them
  void confirm(const std::function<bool(const Eigen::VectorXd& x)>& counts) {
    for (const auto& one : cases_) one->confirm(counts);
  }

  const ProblemFile& file() const { return file_; }

  /// At least one.
  std::size_t case_count() const { return cases_.size(); }
  DesignCase& load_case(std::size_t index) { return *cases_[index]; }
  const DesignCase& load_case(std::size_t index) const { return *cases_[index]; }
  /// Gives the memory of the simulations back that are kept for the next question.
  void forget_analyses() {
    for (const auto& one : cases_) one->forget_analysis();
  }

  /// How gradients are computed; none before the first one. Of several cases that of the first.
  const std::optional<GradientChoice>& method() const { return cases_.front()->method(); }

  /// Standard deviations of the variables, zero where the file does not say that they scatter.
  Eigen::VectorXd variable_deviations() const;

  /// What a response of the joined problem is made from in the cases, to first order.
  /// @throws SimulationError
  LinearizedResponse linearized_at(const Eigen::VectorXd& x, std::size_t response);
  /// Its value.
  double value_at(const Eigen::VectorXd& x, std::size_t response);

  /// The response that a constraint limits; none of a sum of variables.
  std::optional<std::size_t> response_of(std::size_t constraint) const;

  /// Index of a response of the file. @throws InputError if there is none of this name
  std::size_t response_index(const std::string& name) const {
    return index_of_response(file_, name);
  }

  /// That of the objective; over cases a number made from several.
  std::size_t objective_response() const { return response_index(file_.objective->response); }

  /// Whether the objective is that of each case, or made from those by `over_cases`; otherwise it is
  /// an expression that names cases.
  bool has_objective_in_cases() const { return cases_.front()->has_objective(); }

  /// What of each case's objective counts in a sum; of the worst, the share is 1 for every case.
  double objective_weight(std::size_t load_case) const;
  /// Whether the objective is the worst of several cases: it has a kink where two of them tie.
  bool minimizes_worst() const;

 private:
  double objective_of(const std::vector<StoredEvaluation>& answers,
                      Eigen::VectorXd* gradient) const;
  std::vector<StoredEvaluation> answers_of(const Eigen::VectorXd& x, Request request,
                                           const std::string& name,
                                           const std::vector<std::vector<RowSource>>& rows);

  ProblemFile file_;
  int threads_;
  std::vector<std::unique_ptr<DesignCase>> cases_;
  std::vector<Variable> variables_;
  std::vector<Constraint> constraints_;
  std::vector<ShownUnit> variable_units_;
};

}  // namespace pleuel
