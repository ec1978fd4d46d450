#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "cli/reports/derivative_report.hpp"
#include "cli/text/json.hpp"
#include "core/base/error.hpp"
#include "core/jobs/child_program.hpp"
#include "core/jobs/worker.hpp"
#include "core/response/analysis.hpp"
#include "core/scene/body_source.hpp"
#include "core/scene/load_cases.hpp"
#include "library/guarded_call.hpp"
#include "library/motion_document.hpp"
#include "library/search_document.hpp"

// Opening problems and what is known of them without simulation (include/pleuel.h).
namespace {

using namespace pleuel;

std::string text_or_none(const char* text) {
  return text == nullptr ? std::string() : std::string(text);
}

const std::string& entry_of(const std::vector<std::string>& entries, std::size_t index) {
  require_index(index, entries.size(), "index");
  return entries[index];
}

}  // namespace

pleuel_status pleuel_open(const char* file, const char* text, const char* const* overrides,
                          size_t override_count, const char* load_case, pleuel_problem* problem) {
  return guarded_call([&] {
    require_pointer(problem, "problem");
    require_pointer(file, "file");
    ProblemText source{text_or_none(text), file, {}, text_or_none(load_case)};
    if (override_count > 0) require_pointer(overrides, "overrides");
    for (size_t i = 0; i < override_count; ++i) {
      require_pointer(overrides[i], "overrides");
      source.overrides.emplace_back(overrides[i]);
    }
    *problem = add_open_problem(std::make_shared<OpenProblem>(source, text != nullptr));
  });
}

pleuel_status pleuel_close(pleuel_problem problem) {
  return guarded_call([&] { remove_open_problem(problem); });
}

pleuel_status pleuel_count(pleuel_problem problem, pleuel_list list, size_t* count) {
  return guarded_call(problem, [&](const OpenProblem& open) {
    require_pointer(count, "count");
    *count = open.names(list).size();
  });
}

pleuel_status pleuel_name(pleuel_problem problem, pleuel_list list, size_t index,
                          const char** name) {
  return guarded_call(problem, [&](const OpenProblem& open) {
    require_pointer(name, "name");
    *name = entry_of(open.names(list), index).c_str();
  });
}

pleuel_status pleuel_unit(pleuel_problem problem, pleuel_list list, size_t index,
                          const char** unit) {
  return guarded_call(problem, [&](const OpenProblem& open) {
    require_pointer(unit, "unit");
    *unit = entry_of(open.units(list), index).c_str();
  });
}

pleuel_status pleuel_bounds(pleuel_problem problem, double* start, double* lower, double* upper,
                            size_t variables) {
  return guarded_call(problem, [&](const OpenProblem& open) {
    const std::vector<DesignVariable>& all = open.file().variables;
    require_size(variables, all.size(), "variables");
    for (size_t i = 0; i < variables; ++i) {
      if (start != nullptr) start[i] = all[i].start;
      if (lower != nullptr) lower[i] = all[i].lower;
      if (upper != nullptr) upper[i] = all[i].upper;
    }
  });
}

pleuel_status pleuel_limits(pleuel_problem problem, double* lower, double* upper, size_t limits) {
  return guarded_call(problem, [&](const OpenProblem& open) {
    const std::vector<ConstraintSettings>& all = open.file().constraints;
    require_size(limits, all.size(), "limits");
    for (size_t i = 0; i < limits; ++i) {
      if (lower != nullptr) lower[i] = all[i].lower.value_or(-infinity);
      if (upper != nullptr) upper[i] = all[i].upper.value_or(infinity);
    }
  });
}

// Values, derivatives and motion at a design (include/pleuel.h).
namespace {

using namespace pleuel;

Request request_for(const double* first, const double* second = nullptr) {
  const bool wants_gradients = first != nullptr || second != nullptr;
  return wants_gradients ? Request::values_and_gradients : Request::values;
}

}  // namespace

pleuel_status pleuel_evaluate(pleuel_problem problem, const double* x, size_t variables,
                              double* objective, double* values, size_t limits, double* gradient,
                              double* jacobian) {
  return guarded_call(problem, [&](OpenProblem& open) {
    const Eigen::VectorXd design = checked_design(open, x, variables);
    require_pointer(objective, "objective");
    require_size(limits, open.names(PLEUEL_LIMITS).size(), "limits");
    if (limits > 0) require_pointer(values, "values");
    const Evaluation found = open.evaluate(design, request_for(gradient, jacobian));
    *objective = found.objective;
    copy_out(found.constraints, values);
    if (!found.has_gradients()) return;
    copy_out(found.objective_gradient, gradient);
    copy_out(found.constraint_jacobian, jacobian);
  });
}

pleuel_status pleuel_responses(pleuel_problem problem, const double* x, size_t variables,
                               double* values, size_t responses, double* jacobian) {
  return guarded_call(problem, [&](OpenProblem& open) {
    const Eigen::VectorXd design = checked_design(open, x, variables);
    require_size(responses, open.names(PLEUEL_RESPONSES).size(), "responses");
    if (responses > 0) require_pointer(values, "values");
    const Evaluation found = open.evaluate_responses(design, request_for(jacobian));
    copy_out(found.constraints, values);
    if (found.has_gradients()) copy_out(found.constraint_jacobian, jacobian);
  });
}

pleuel_status pleuel_history_size(pleuel_problem problem, const double* x, size_t variables,
                                  size_t response, size_t* instants) {
  return guarded_call(problem, [&](OpenProblem& open) {
    const Eigen::VectorXd design = checked_design(open, x, variables);
    require_index(response, open.names(PLEUEL_RESPONSES).size(), "response");
    require_pointer(instants, "instants");
    *instants = static_cast<size_t>(open.history(design, response).time.size());
  });
}

pleuel_status pleuel_history(pleuel_problem problem, const double* x, size_t variables,
                             size_t response, double* time, double* values, size_t instants,
                             double* derivatives) {
  return guarded_call(problem, [&](OpenProblem& open) {
    const Eigen::VectorXd design = checked_design(open, x, variables);
    require_index(response, open.names(PLEUEL_RESPONSES).size(), "response");
    OpenProblem::Curve curve = open.history(design, response);
    require_size(instants, static_cast<size_t>(curve.time.size()), "instants");
    if (instants == 0) return;
    require_pointer(time, "time");
    require_pointer(values, "values");
    if (derivatives != nullptr) {
      const HistoryGradients of_peak = open.history_gradients(design, response).value();
      curve.values = of_peak.values;
      copy_out(of_peak.gradients, derivatives);
    }
    copy_out(curve.time, time);
    copy_out(curve.values, values);
  });
}

pleuel_status pleuel_motion(pleuel_problem problem, const double* x, size_t variables,
                            char** document) {
  return guarded_call(problem, [&](const OpenProblem& open) {
    const Eigen::VectorXd design = checked_design(open, x, variables);
    require_pointer(document, "document");
    *document = text_out(to_text(motion_document(open.file(), design)));
  });
}

pleuel_status pleuel_by_invariants(pleuel_problem problem, const double* x, size_t variables,
                                   const char* body, char** document) {
  return guarded_call(problem, [&](const OpenProblem& open) {
    const Eigen::VectorXd design = checked_design(open, x, variables);
    require_pointer(body, "body");
    require_pointer(document, "document");
    const ConstantGradients found = constant_gradients(open.file(), design, body);
    *document = text_out(to_text(constant_gradients_document(open.file(), body, found)));
  });
}

// Optimization (include/pleuel.h).

using namespace pleuel;

pleuel_status pleuel_optimize(pleuel_problem problem, const double* x, size_t variables,
                              const char* options, pleuel_observer observer, void* user,
                              char** result) {
  return guarded_call(problem, [&](const OpenProblem& open) {
    require_pointer(result, "result");
    const Eigen::VectorXd start =
        x == nullptr ? start_design(open.file()) : checked_design(open, x, variables);
    const SearchOptions asked =
        read_search_options(options == nullptr ? "{}" : options, open.file());
    *result = text_out(to_text(search_document(open.file(), start, asked, {observer, user})));
  });
}

// Bodies that functions of the caller make, and permission for programs (include/pleuel.h).
namespace {

using namespace pleuel;

std::string text_of(pleuel_body_maker make, void* user, const Eigen::VectorXd& values) {
  const char* text = nullptr;
  const int code = make(values.data(), static_cast<std::size_t>(values.size()), &text, user);
  std::string copy = text == nullptr ? "" : text;
  if (code == 0) return copy;
  throw SimulationError(copy.empty() ? "it failed without a word" : copy);
}

/// Whatever it throws is a failure of the design.
std::string guarded_text_of(pleuel_body_maker make, void* user, const Eigen::VectorXd& values) {
  try {
    return text_of(make, user, values);
  } catch (const std::exception& error) {
    throw SimulationError(error.what());
  } catch (...) {
    throw SimulationError("it threw what is no exception of the standard library");
  }
}

}  // namespace

pleuel_status pleuel_register_body(const char* body, pleuel_body_maker make, void* user) {
  return guarded_call([&] {
    require_pointer(body, "body");
    BodyFunction function;
    if (make != nullptr) {
      const auto here = std::make_shared<WorkersForbidden>();  // as long as it is registered
      function = [make, user, here](const Eigen::VectorXd& values) {
        return guarded_text_of(make, user, values);
      };
    }
    register_body(body, std::move(function));
  });
}

pleuel_status pleuel_allow_programs(int allowed) {
  return guarded_call([&] {
    static std::mutex mutex;
    static std::optional<ProgramPermission> permission;
    const std::lock_guard<std::mutex> lock(mutex);
    permission.reset();
    if (allowed != 0) permission.emplace();
  });
}
