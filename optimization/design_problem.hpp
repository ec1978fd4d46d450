#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/response/analysis.hpp"
#include "core/scene/shown_unit.hpp"
#include "optimization/evaluation_store.hpp"
#include "optimization/problem.hpp"
#include "sensitivity/gradients.hpp"

namespace pleuel {

/// A constraint of the file, or one peak of the response that it limits; without a constraint the
/// same of the objective.
struct ConstraintRow {
  std::optional<std::size_t> constraint;
  std::optional<Reduction> peak;
};

/// What stands for the constraints at a simulated design: as many rows at each design.
using RowsOf = std::function<std::vector<ConstraintRow>(const Analysis&)>;

/// The same with a name that tells it from other rows of the same file.
struct NamedRows {
  std::string name;
  RowsOf of;
};

/// The optimization problem that a problem file describes: responses of the simulated mechanism as
/// objective (of a response that is maximized its negative) and constraints, gradients by the method of the file; where that leaves it open, by
/// the exact one that suits its first design.
class DesignProblem : public Problem {
 public:
  /// @throws InputError if the file has no variables or no objective
  /// @param threads  simulations at a time, of gradients by differences
  /// @param store    has evaluations that are known, and keeps those that are made; must outlive
  ///                 this
  explicit DesignProblem(ProblemFile file, int threads = 1, EvaluationStore* store = nullptr);

  /// Begins at another design, within the bounds, than the start of the file; what the model
  /// decides at the start of the file stays.
  void start_from(const Eigen::VectorXd& x);

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

  /// The simulation of the design seen last is kept, so that its gradients cost no second one.
  Evaluation evaluate(const Eigen::VectorXd& x, Request request) override;

  /// The same with other rows in place of the constraints; one run of the chosen method for
  /// all.
  Evaluation evaluate_rows(const Eigen::VectorXd& x, Request request, const NamedRows& rows);

  const ProblemFile& file() const { return file_; }
  /// How gradients are computed; none before the first one.
  const std::optional<GradientChoice>& method() const { return choice_; }
  /// From now on gradients are computed as another problem of this file has chosen.
  void decide_method(GradientChoice choice) { choice_ = std::move(choice); }

  /// Standard deviations of the variables, zero where the file does not say that they scatter.
  Eigen::VectorXd variable_deviations() const;

  /// The simulation of a design; kept until another one is asked for.
  /// @throws SimulationError
  Analysis& analysis_at(const Eigen::VectorXd& x);

  /// Index of the response of a row; none for a sum of variables.
  std::optional<std::size_t> response_of(const ConstraintRow& row) const;

  /// Index of a response of the file. @throws InputError if there is none of this name
  std::size_t response_index(const std::string& name) const;

 private:
  Evaluation simulated_rows(const Eigen::VectorXd& x, Request request, const RowsOf& rows_of);
  EvaluationKey key_of(const Eigen::VectorXd& x, Request request, const std::string& rows) const;
  Evaluation recalled(const StoredEvaluation& stored);
  double row_value(const Analysis& analysis, const ConstraintRow& row) const;
  Eigen::MatrixXd gradients_of(Analysis& analysis, const RowsOf& rows_of);

  ProblemFile file_;
  int threads_;
  EvaluationStore* store_;
  std::string setting_;  ///< of its evaluations, for the store
  std::vector<Variable> variables_;
  std::vector<Constraint> constraints_;
  std::vector<ShownUnit> variable_units_;
  Eigen::VectorXd x_;
  std::unique_ptr<Analysis> analysis_;
  std::optional<GradientChoice> choice_;
};

}  // namespace pleuel
