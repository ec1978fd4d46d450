// Optimizers of the caller (include/pleuel.h).

#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "core/jobs/worker.hpp"
#include "library/called_optimizer.hpp"
#include "library/guarded_call.hpp"
#include "library/open_problem.hpp"
#include "optimization/backends.hpp"

namespace {

using namespace pleuel;

Eigen::VectorXd checked_y(const CalledSearch& search, const double* y, size_t variables) {
  require_size(variables, static_cast<size_t>(search.variables()), "free variables");
  require_pointer(y, "y");
  const Eigen::Map<const Eigen::VectorXd> all(y, search.variables());
  for (Eigen::Index i = 0; i < all.size(); ++i) {
    if (!std::isfinite(all[i])) {
      throw CallError(fmt::format("y[{}] must be finite, got {}", i, all[i]));
    }
  }
  return all;
}

Eigen::VectorXd rows_of(const ScaledEvaluation& found) {
  Eigen::VectorXd rows(found.inequalities.size() + found.equalities.size());
  rows << found.inequalities, found.equalities;
  return rows;
}

Eigen::MatrixXd jacobian_of(const ScaledEvaluation& found) {
  const Eigen::Index inequalities = found.inequalities.size(), equalities = found.equalities.size();
  Eigen::MatrixXd jacobian(inequalities + equalities, found.objective_gradient.size());
  jacobian.topRows(inequalities) = found.inequality_jacobian;
  jacobian.bottomRows(equalities) = found.equality_jacobian;
  return jacobian;
}

}  // namespace

pleuel_status pleuel_register_backend(const char* name, int takes_equalities,
                                      pleuel_backend backend, void* user) {
  return guarded_call([&] {
    require_pointer(name, "name");
    if (backend == nullptr) return remove_optimizer(name);
    const CalledBackend called{name, takes_equalities != 0, backend, user};
    const auto here = std::make_shared<WorkersForbidden>();  // as long as it is registered
    add_optimizer(name, [called, here](const BackendOptions& options) {
      return make_called_optimizer(called, options);
    });
  });
}

pleuel_status pleuel_search_evaluate(uint64_t search, const double* y, size_t variables,
                                     double* objective, double* rows, size_t row_count,
                                     double* gradient, double* jacobian) {
  return guarded_call([&] {
    const std::shared_ptr<CalledSearch> running = find_called_search(search);
    const Eigen::VectorXd at = checked_y(*running, y, variables);
    require_size(row_count, static_cast<size_t>(running->rows()), "rows");
    require_pointer(objective, "objective");
    if (row_count > 0) require_pointer(rows, "rows");
    const bool wants_gradients = gradient != nullptr || jacobian != nullptr;
    const ScaledEvaluation found =
        running->evaluate(at, wants_gradients ? Request::values_and_gradients : Request::values);
    *objective = found.objective;
    copy_out(rows_of(found), rows);
    if (!wants_gradients) return;
    copy_out(found.objective_gradient, gradient);
    copy_out(jacobian_of(found), jacobian);
  });
}
