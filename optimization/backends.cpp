#include "optimization/backends.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <mutex>
#include <utility>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/quoted.hpp"

namespace pleuel {

namespace {

/// Relative violation that counts as none on the way, and the relative gain that counts as progress.
constexpr double nearly_kept = 1e-4;
constexpr double least_progress = 1e-4;

}  // namespace

ScaledProblem::ScaledProblem(EvaluationCache& cache, const EvaluatedDesign& around, Budget budget,
                             const Eigen::VectorXd& factors)
    : cache_(cache),
      iterations_(cache.iterations()),
      evaluations_(cache.evaluations()),
      best_objective_(around.evaluation.objective),
      best_violation_(around.max_violation),
      best_iteration_(cache.iterations()),
      around_(around.x),
      budget_(budget),
      variable_scales_(variable_scales(cache.problem(), around.x)),
      objective_scale_(objective_scale(cache.problem(), around.evaluation, variable_scales_)) {
  if (factors.size() > 0) variable_scales_ = variable_scales_.cwiseProduct(factors);
  const std::vector<Variable>& variables = cache.problem().variables();
  for (Eigen::Index i = 0; i < around_.size(); ++i) {
    if (!variables[i].is_fixed()) free_.push_back(i);
  }
  for (const LimitSide& side : limit_sides(cache.problem(), cache.scales().constraints)) {
    if (!cache.problem().constraints()[side.constraint].is_equality()) {
      inequalities_.push_back(side);
    } else if (side.sign > 0.0) {
      equalities_.push_back(side);
    }
  }
  update_stop();
}

Eigen::VectorXd ScaledProblem::scaled_bounds(double Variable::*bound) const {
  Eigen::VectorXd bounds(around_.size());
  for (Eigen::Index i = 0; i < bounds.size(); ++i) {
    bounds[i] = cache_.problem().variables()[i].*bound;
  }
  return to_scaled(bounds);
}

std::optional<ScaledEvaluation> ScaledProblem::evaluate(const Eigen::VectorXd& y,
                                                        Request request) noexcept {
  has_left_numbers_ = has_left_numbers_ || !y.allFinite();
  should_stop_ = should_stop_ || has_left_numbers_;
  if (should_stop_) return std::nullopt;
  try {
    const Evaluation* evaluation = cache_.evaluate(to_design(y), request);
    update_stop();
    if (evaluation == nullptr) return std::nullopt;
    return scale(*evaluation);
  } catch (...) {
    exception_ = std::current_exception();
    should_stop_ = true;
    return std::nullopt;
  }
}

void ScaledProblem::rethrow() const {
  if (exception_) std::rethrow_exception(exception_);
}

void ScaledProblem::update_stop() {
  if (cache_.iterations() > iterations_) {
    iterations_ = cache_.iterations();
    evaluations_ = cache_.evaluations();
  }
  see_progress();
  should_stop_ =
      cache_.iterations() >= budget_.iterations || cache_.evaluations() >= budget_.evaluations ||
      cache_.consecutive_failures() >= budget_.consecutive_failures ||
      cache_.evaluations() - evaluations_ >= budget_.line_search ||
      (budget_.patience > 0 && cache_.iterations() - best_iteration_ >= budget_.patience);
}

void ScaledProblem::see_progress() {
  const EvaluationRecord& last = cache_.history().back();
  if (last.has_failed()) return;
  const bool was_within = best_violation_ <= nearly_kept;
  const bool is_within = last.max_violation <= nearly_kept;
  const bool is_better =
      was_within ? is_within &&
                       last.objective < best_objective_ - least_progress * std::abs(best_objective_)
                 : last.max_violation < (1.0 - least_progress) * best_violation_;
  if (!is_better) return;
  best_objective_ = last.objective;
  best_violation_ = last.max_violation;
  best_iteration_ = cache_.iterations();
}

Eigen::VectorXd ScaledProblem::to_design(const Eigen::VectorXd& y) const {
  Eigen::VectorXd x = around_;
  for (Eigen::Index k = 0; k < y.size(); ++k) {
    const Eigen::Index i = free_[k];
    const Variable& variable = cache_.problem().variables()[i];
    x[i] = std::clamp(y[k] * variable_scales_[i], variable.lower, variable.upper);
  }
  return x;
}

Eigen::VectorXd ScaledProblem::to_scaled(const Eigen::VectorXd& x) const {
  return x.cwiseQuotient(variable_scales_)(free_);
}

Eigen::VectorXd ScaledProblem::values(const std::vector<LimitSide>& rows,
                                      const Evaluation& evaluation) const {
  Eigen::VectorXd result(rows.size());
  for (Eigen::Index k = 0; k < result.size(); ++k) {
    result[k] = rows[k].violation(evaluation.constraints);
  }
  return result;
}

Eigen::MatrixXd ScaledProblem::jacobian(const std::vector<LimitSide>& rows,
                                        const Evaluation& evaluation) const {
  Eigen::MatrixXd result(rows.size(), variables());
  for (Eigen::Index k = 0; k < result.rows(); ++k) {
    const Eigen::VectorXd gradient = evaluation.constraint_jacobian.row(rows[k].constraint)
                                         .transpose()
                                         .cwiseProduct(variable_scales_);
    result.row(k) = rows[k].sign / rows[k].magnitude * gradient(free_).transpose();
  }
  return result;
}

ScaledEvaluation ScaledProblem::scale(const Evaluation& evaluation) const {
  ScaledEvaluation scaled;
  scaled.objective = evaluation.objective / objective_scale_;
  scaled.inequalities = values(inequalities_, evaluation);
  scaled.equalities = values(equalities_, evaluation);
  if (!evaluation.has_gradients()) return scaled;
  scaled.objective_gradient =
      evaluation.objective_gradient.cwiseProduct(variable_scales_)(free_) / objective_scale_;
  scaled.inequality_jacobian = jacobian(inequalities_, evaluation);
  scaled.equality_jacobian = jacobian(equalities_, evaluation);
  return scaled;
}

namespace {

using Makers = std::vector<std::pair<std::string, OptimizerMaker>>;

const Makers& own_makers() {
  static const Makers list = {{"nlopt-mma", make_nlopt_mma},
                              {"nlopt-ccsaq", make_nlopt_ccsaq},
                              {"nlopt-slsqp", make_nlopt_slsqp},
                              {"ipopt", make_ipopt}};
  return list;
}

/// Those of programs that call the library.
struct CallersBackends {
  std::mutex mutex;
  Makers makers;
};

/// Never destroyed: threads of the caller may outlive what the program ends with.
CallersBackends& callers_backends() {
  static CallersBackends& one = *new CallersBackends;
  return one;
}

auto with_name(const std::string& name) {
  return [&name](const auto& maker) { return maker.first == name; };
}

Makers all_makers() {
  Makers all = own_makers();
  const std::lock_guard lock(callers_backends().mutex);
  all.insert(all.end(), callers_backends().makers.begin(), callers_backends().makers.end());
  return all;
}

void check_name(const std::string& name) {
  const auto is_of_word = [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '-' || c == '_';
  };
  if (name.empty() || !std::ranges::all_of(name, is_of_word)) {
    throw InputError(
        fmt::format("the name of a backend must be letters, digits, '-' and '_', got \"{}\"",
                    excerpt(name, 60)));
  }
  if (std::any_of(own_makers().begin(), own_makers().end(), with_name(name))) {
    throw InputError(fmt::format("the backend \"{}\" is one of Pleuel: take another name", name));
  }
}

}  // namespace

std::vector<std::string> optimizer_names() {
  std::vector<std::string> names;
  for (const auto& [name, make] : all_makers()) names.push_back(name);
  return names;
}

void add_optimizer(const std::string& name, OptimizerMaker make) {
  check_name(name);
  const std::lock_guard lock(callers_backends().mutex);
  std::erase_if(callers_backends().makers, with_name(name));
  callers_backends().makers.emplace_back(name, std::move(make));
}

void remove_optimizer(const std::string& name) {
  const std::lock_guard lock(callers_backends().mutex);
  if (std::erase_if(callers_backends().makers, with_name(name)) == 0) {
    throw InputError(fmt::format("no backend \"{}\" was added", excerpt(name, 60)));
  }
}

std::unique_ptr<Optimizer> make_optimizer(const std::string& name, const BackendOptions& options) {
  for (const auto& [known, make] : all_makers()) {
    if (known == name) return make(options);
  }
  throw InputError(fmt::format("there is no optimizer backend \"{}\"; known are {}", name,
                               fmt::join(optimizer_names(), ", ")));
}

BackendEnd run_backend(EvaluationCache& cache, const EvaluatedDesign& from, const std::string& name,
                       double tolerance, const ScaledProblem::Budget& budget,
                       const Eigen::VectorXd& factors) {
  BackendEnd end{from.x};
  ScaledProblem scaled(cache, from, budget, factors);
  if (scaled.variables() == 0) return end;
  const BackendResult result = make_optimizer(name, {tolerance})->minimize(scaled);
  scaled.rethrow();
  end.has_left_numbers = scaled.has_left_numbers();
  end.reason = end.has_left_numbers ? "it asked for a design that is not a number" : result.reason;
  if (result.y.allFinite()) end.x = scaled.to_design(result.y);
  return end;
}

}  // namespace pleuel
