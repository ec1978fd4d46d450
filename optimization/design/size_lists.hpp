#pragma once

#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/base/int_size.hpp"
#include "core/scene/problem_file.hpp"
#include "optimization/design/staged_solve.hpp"
#include "optimization/linear_choice.hpp"
#include "optimization/problem.hpp"
#include "optimization/result.hpp"

namespace pleuel {

using Sizes = std::vector<int>;  ///< place in its list, by chosen variable

/// The variables of a problem that are chosen from lists, and the lists.
class SizeLists {
 public:
  explicit SizeLists(const std::vector<DesignVariable>& variables);

  std::size_t count() const { return lists_.size(); }
  /// Index of the k-th chosen variable among all.
  Eigen::Index variable(std::size_t k) const { return lists_[k].variable; }
  int sizes(std::size_t k) const { return int_size(lists_[k].values); }
  double value(std::size_t k, int size) const { return lists_[k].values[size]; }
  /// Mean distance of the sizes in a list; zero of one.
  double mean_gap(std::size_t k) const;

  double combinations() const;
  std::vector<Sizes> all() const;  ///< the last list fastest

  /// @param x  values of the other variables [SI]
  Eigen::VectorXd design(const Sizes& choice, Eigen::VectorXd x) const;

  /// The sizes at or below those of a design; the nearest ones.
  Sizes below(const Eigen::VectorXd& x) const;
  Sizes nearest(const Eigen::VectorXd& x) const;

  /// Any other size in place of each.
  /// @param reach  so far up or down the list
  std::vector<Sizes> exchanges(const Sizes& from, int reach) const;

 private:
  struct List {
    Eigen::Index variable;
    std::vector<double> values;  ///< ascending [SI]
  };
  std::vector<List> lists_;
};

// Choices of sizes that are tried, each a task of its own (core/jobs/tasks.hpp).

/// A choice that was tried.
struct SizeTrial {
  Eigen::VectorXd x;  ///< [SI]
  double objective = 0.0, max_violation = std::numeric_limits<double>::infinity();
  Eigen::VectorXd constraints = {};
  History history = {};
  double seconds = 0.0;

  bool has_failed() const { return constraints.size() == 0 && !std::isfinite(max_violation); }
  bool keeps_limits() const { return max_violation <= Tolerances().violation; }
};

/// Whether each choice has to be optimized: there are other variables, or margins that follow from
/// gradients.
bool needs_optimization(const ProblemFile& file);

/// The problem with the sizes of a design fixed. Its start stays: what the model decides there stays
/// too.
ProblemFile with_sizes(ProblemFile file, const Eigen::VectorXd& x);

/// Simulates each design, or optimizes the other variables from it (needs_optimization()).
/// @param scales  of the constraints: what violations are relative to
/// @return        in the order of the designs; one whose task failed has a failure in its history
std::vector<SizeTrial> try_sizes(const ProblemFile& file,
                                 const std::vector<Eigen::VectorXd>& designs,
                                 const Eigen::VectorXd& scales, const SolveOptions& options,
                                 const Execution& execution);

/// The designs that are tried, made again on another rank (PackedWork).
inline constexpr const char* trial_work_name = "trials";
std::unique_ptr<TaskWork> make_trial_work(const std::string& content);

}  // namespace pleuel
