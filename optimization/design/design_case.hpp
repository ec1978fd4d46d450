#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "core/response/analysis.hpp"
#include "core/response/value_over_cases.hpp"
#include "core/scene/problem_file.hpp"
#include "optimization/design/peak_rows.hpp"
#include "optimization/evaluation_store.hpp"
#include "optimization/problem.hpp"
#include "sensitivity/gradients.hpp"

namespace pleuel {

/// Index of a response of a file. @throws InputError if there is none of this name
std::size_t index_of_response(const ProblemFile& file, const std::string& name);

/// What stands for one constraint of a file at each design, or, without a constraint, for the
/// objective: one row, or one for each peak that is told apart.
struct ConstraintRows {
  std::optional<std::size_t> constraint = {};
  /// Of a response that is the largest, or smallest, of others: one of them.
  std::optional<std::size_t> part = {};
  std::optional<PeakDivision> division = {};
  /// Of `part` by itself, neither limited nor minimized in its case: what it is multiplied with.
  std::optional<double> sign = {};

  int count() const { return division ? division->peaks() : 1; }
};

/// The mechanism that a problem file describes, simulated at designs: the part of a design problem
/// that belongs to one load case. Values and gradients of its objective and of rows, gradients by
/// the method of the file; where that leaves it open, by the exact one that suits its first design.
class DesignCase {
 public:
  /// @param file     without cases
  /// @param threads  simulations at a time, of gradients by differences
  /// @param store    has evaluations that are known, and keeps those that are made; may be null
  DesignCase(ProblemFile file, int threads, EvaluationStore* store);

  const ProblemFile& file() const { return file_; }
  /// Whether the case has an objective of its own: not where it is made from several cases.
  bool has_objective() const { return file_.objective.has_value(); }
  double objective_sign() const { return file_.objective ? file_.objective->sign() : 1.0; }
  /// How gradients are computed; none before the first one.
  const std::optional<GradientChoice>& method() const { return choice_; }
  /// From now on gradients are computed as another problem of this file has chosen.
  void decide_method(GradientChoice choice) { choice_ = std::move(choice); }

  /// The simulation of a design; kept until another one is asked for.
  /// @throws SimulationError
  Analysis& analysis_at(const Eigen::VectorXd& x);
  /// Gives the memory of the simulation back.
  void forget_analysis() { analysis_.reset(); }

  /// Index of the response of rows; none for a sum of variables.
  std::optional<std::size_t> response_of(const ConstraintRows& rows) const;

  /// What the store knows of an evaluation. Asks this process: not for other threads.
  std::optional<StoredEvaluation> recall(const Eigen::VectorXd& x, Request request,
                                         const std::string& name,
                                         const std::vector<ConstraintRows>& rows);
  /// The evaluation itself, or why there is none; may run beside those of other cases.
  StoredEvaluation compute(const Eigen::VectorXd& x, Request request,
                           const std::vector<ConstraintRows>& rows);
  /// Tells the store of what recall() asked it for last.
  void keep(const StoredEvaluation& answer) {
    if (store_) store_->keep(*asked_, answer);
  }
  /// Makes what was recalled of an older run at these designs again, for the store to compare.
  void confirm(const std::function<bool(const Eigen::VectorXd& x)>& counts);

 private:
  /// One of them at a simulated design: a value, and the instants that it comes from where it is of
  /// a response.
  struct Row {
    double value = 0.0;
    std::optional<SampledValue> sampled = {};
    double sign = 1.0;              ///< value = sign · what the samples give
    Eigen::VectorXd gradient = {};  ///< of a sum of variables, which has no samples
  };

  /// The rows, before them the objective, if there is one.
  std::vector<ConstraintRows> with_objective(const std::vector<ConstraintRows>& rows) const;
  Evaluation simulated_rows(const Eigen::VectorXd& x, Request request,
                            const std::vector<ConstraintRows>& rows);
  EvaluationKey key_of(const Eigen::VectorXd& x, Request request, const std::string& rows) const;
  Row linear_row(std::size_t constraint) const;
  std::vector<Row> rows_at(const Analysis& analysis, const std::vector<ConstraintRows>& rows) const;
  /// That of the choice, which was made for the first rows: the adjoint method, if it was to choose, is
  /// none for more rows than there are variables.
  GradientMethod method_for(const Analysis& analysis,
                            const std::vector<SampledValue>& values) const;
  /// @param at_x  rows_at() the design
  Eigen::MatrixXd gradients_of(Analysis& analysis, const std::vector<ConstraintRows>& rows,
                               const std::vector<Row>& at_x);

  ProblemFile file_;
  int threads_;
  EvaluationStore* store_;
  std::string setting_;  ///< of its evaluations, for the store
  /// What the store was asked for last: the choice of gradients may have changed since.
  std::optional<EvaluationKey> asked_;
  /// What the store knew of an older run so far.
  std::vector<std::pair<EvaluationKey, std::vector<ConstraintRows>>> recalled_;
  Eigen::VectorXd x_;
  std::unique_ptr<Analysis> analysis_;
  std::optional<GradientChoice> choice_;
  GradientMethod used_ = GradientMethod::automatic;  ///< for the gradients evaluated last
};

/// Where some components of a design problem come from: a case, or several.
struct RowSource {
  std::size_t load_case = 0;
  ConstraintRows rows = {};  ///< in the problem of the case
  /// In place of a case: a response of the joined problem that is made from several. One component, multiplied
  /// with the sign of `rows`.
  std::optional<std::size_t> over_cases = {};

  int count() const { return over_cases ? 1 : rows.count(); }
};

/// A response of the joined problem by itself, neither limited nor minimized in its case.
RowSource response_row(const ProblemFile& joined, std::size_t response, double sign = 1.0);

/// Components of a design problem, with a name that tells them from others of the same file.
struct NamedRows {
  std::string name;
  std::vector<RowSource> sources;
};

/// Rows that each case is asked for.
using RowsOfCases = std::vector<std::vector<ConstraintRows>>;

/// What responses over cases are made from, as further rows of the cases: asked for behind their
/// own, and put together when all are known.
class PartRows {
 public:
  /// @param responses  over cases, or of one case, by their places in the joined problem
  PartRows(const ProblemFile& joined, const std::vector<std::size_t>& responses);

  /// Adds the rows of the parts behind others, and to their name.
  void add_to(RowsOfCases& rows, std::string& name) const;

  /// Value of one of the responses, and its gradient where it is asked for.
  /// @param answers   one a case, to the rows of add_to()
  /// @param gradient  may be null
  double combined(std::size_t response, const Eigen::VectorXd& x,
                  const std::vector<StoredEvaluation>& answers, Eigen::VectorXd* gradient) const;

 private:
  const ProblemFile& joined_;
  /// Each part by its place in the joined problem: the number of its row, counted from the last of
  /// its case.
  std::map<std::size_t, Eigen::Index> from_end_;
};

/// What may differ between the simulations of one optimization, as text from which doubles read back
/// exactly: steps, tolerances, elements, modes, effects that are left out, the design for which the
/// model decides, the method of gradients, the objective, and the responses that are limited. How far
/// they are limited is not part of it, as no evaluation depends on that.
std::string setting_text(const ProblemFile& file);

}  // namespace pleuel
