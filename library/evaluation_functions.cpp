// Values, derivatives and motion at a design (include/pleuel.h).

#include <string>

#include "cli/reports/constant_gradients_report.hpp"
#include "cli/text/json.hpp"
#include "core/scene/load_cases.hpp"
#include "library/guarded_call.hpp"
#include "library/motion_document.hpp"

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
