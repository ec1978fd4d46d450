#pragma once

#include <cstddef>
#include <functional>
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

/// Peaks that are told apart: of the response of some rows itself, or of one that its formula has as factor · response.
struct DividedPeaks {
  std::size_t response = 0;
  double factor = 1.0;
  PeakDivision division = {};
};

/// Where some components of a design problem come from: of a case what stands for one constraint or, without
/// a constraint, for the objective: one component, or one for each peak that is told apart.
struct RowSource {
  std::size_t load_case = 0;
  std::optional<std::size_t> constraint = {};  ///< in the problem of the case
  /// Of a response that is the largest, or smallest, of others: one of them.
  std::optional<std::size_t> part = {};
  std::vector<DividedPeaks> divided = {};  ///< one component for each choice of a peak of each
  /// What a response by itself, neither limited nor minimized in its case, is multiplied with.
  std::optional<double> sign = {};
  /// In place of a case: a response of the joined problem that is made from several. One component.
  std::optional<std::size_t> over_cases = {};

  int count() const {
    int peaks = 1;
    for (const DividedPeaks& one : divided) peaks *= one.division.peaks();
    return peaks;
  }
};

/// Components of a design problem, with a name that tells them from others of the same file.
struct NamedRows {
  std::string name;
  std::vector<RowSource> sources;
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
  /// @param request  whether it is differentiated, too
  /// @throws SimulationError
  Analysis& analysis_at(const Eigen::VectorXd& x, Request request = Request::values);
  /// Gives the memory of the simulation back.
  void forget_analysis() { analysis_.reset(); }

  /// Index of the response of rows; none for a sum of variables.
  std::optional<std::size_t> response_of(const RowSource& rows) const;

  /// What the store knows of an evaluation. Asks this process: not for other threads.
  std::optional<StoredEvaluation> recall(const Eigen::VectorXd& x, Request request,
                                         const std::string& name,
                                         const std::vector<RowSource>& rows);
  /// The evaluation itself, or why there is none; may run beside those of other cases.
  StoredEvaluation compute(const Eigen::VectorXd& x, Request request,
                           const std::vector<RowSource>& rows);
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

  Evaluation simulated_rows(const Eigen::VectorXd& x, Request request,
                            const std::vector<RowSource>& rows);
  std::vector<Row> rows_at(const Analysis& analysis, const std::vector<RowSource>& rows) const;
  /// Of a row those of its peaks.
  void divide(const Analysis& analysis, const std::vector<DividedPeaks>& divided, const Row& whole,
              std::vector<Row>& rows) const;
  /// That of the choice, which was made for the first rows: the adjoint method, if it was to choose, is
  /// none for more rows than there are variables.
  GradientMethod method_for(const Analysis& analysis,
                            const std::vector<SampledValue>& values) const;
  /// @param at_x  rows_at() the design
  Eigen::MatrixXd gradients_of(Analysis& analysis, const std::vector<RowSource>& rows,
                               const std::vector<Row>& at_x);

  ProblemFile file_;
  int threads_;
  EvaluationStore* store_;
  std::string setting_;  ///< of its evaluations, for the store
  /// What the store was asked for last: the choice of gradients may have changed since.
  std::optional<EvaluationKey> asked_;
  /// What the store knew of an older run so far.
  std::vector<std::pair<EvaluationKey, std::vector<RowSource>>> recalled_;
  Eigen::VectorXd x_;
  std::unique_ptr<Analysis> analysis_;
  std::optional<GradientChoice> choice_;
  GradientMethod used_ = GradientMethod::automatic;  ///< for the gradients evaluated last
};

/// What may differ between the simulations of one optimization, as text from which doubles read back
/// exactly: steps, tolerances, elements, modes, effects that are left out, the design for which the
/// model decides, the method of gradients, the objective, and the responses that are limited. How far
/// they are limited is not part of it, as no evaluation depends on that.
std::string setting_text(const ProblemFile& file);

}  // namespace pleuel
