#include "optimization/design/number_judgement.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/base/eager_matrices.hpp"
#include "core/trust/checks.hpp"
#include "core/trust/finding.hpp"
#include "core/trust/trusted_run.hpp"
#include "optimization/design/case_trust.hpp"
#include "optimization/design/margin_problem.hpp"
#include "optimization/design/optimum_error.hpp"
#include "optimization/scaling.hpp"

namespace pleuel {

namespace {

/// The response of an objective over cases in each of them; empty elsewhere.
Eigen::VectorXd objectives_in_cases(DesignProblem& design, const Eigen::VectorXd& x) {
  if (design.file().objective->over_cases == OverCases::same) return {};
  Eigen::VectorXd values(design.case_count());
  for (std::size_t c = 0; c < design.case_count(); ++c) {
    DesignCase& one = design.load_case(c);
    values(c) = one.analysis_at(x).reductions[*one.response_of({})].value;
  }
  return values;
}

/// The first serious finding about what is minimized, limited or asked for; those about other responses do
/// not touch an optimum. Of files with cases all count.
const Finding* find_serious(const std::vector<Finding>& findings, const ProblemFile& file) {
  std::set<std::string> asked;
  for (const std::size_t i : asked_responses(file)) asked.insert(file.responses[i].name);
  for (const std::size_t i : asked_parts(file)) asked.insert(file.responses[i].name);
  const auto counts = [&](const Finding& finding) {
    return finding.is_serious &&
           (file.has_cases() || finding.responses.empty() ||
            std::any_of(finding.responses.begin(), finding.responses.end(),
                        [&](const std::string& name) { return asked.contains(name); }));
  };
  const auto found = std::find_if(findings.begin(), findings.end(), counts);
  return found == findings.end() ? nullptr : &*found;
}

/// How near to an answer its gradients and margins are differences.
constexpr double beside = 1e-3;

/// A verdict rests on evaluations of this run: those of the answer and beside it, those of audits, and
/// that of the start, by which small is measured.
void confirm_answer(DesignProblem& design, const Result& result) {
  const Eigen::VectorXd scales = local_scales(design, result.x);
  design.confirm([&](const Eigen::VectorXd& x) {
    const auto is_judged = [&](const EvaluationRecord& record) {
      return record.purpose == Purpose::audit && record.x == x;
    };
    return (x - result.x).cwiseQuotient(scales).lpNorm<Eigen::Infinity>() <= beside ||
           x == result.history.front().x || std::ranges::any_of(result.history, is_judged);
  });
}

}  // namespace

void judge_numbers(DesignProblem& design, Scrutiny scrutiny, Result& result) {
  if (!result.evaluation.has_gradients()) return;
  confirm_answer(design, result);
  result.case_objectives = objectives_in_cases(design, result.x);
  Trust trust = judge_cases(design, result.x, scrutiny);
  for (Finding finding : check_margins(design, result.x)) {
    finding.cause = Cause::limit;
    trust.findings.push_back(std::move(finding));
  }
  rank_findings(trust.findings);
  result.warnings = texts_of(trust.findings);
  result.consequences = count_consequences(trust.findings);
  result.error = optimum_error(design, result, trust);
  if (result.status == Status::verified) {
    const std::string inaccurate = inaccuracy(design, result, trust);
    if (const Finding* serious = find_serious(trust.findings, design.file())) {
      result.status = Status::unresolved;
      result.message = "optimal by its numbers, but these are not to be trusted: " + serious->text;
    } else if (!inaccurate.empty()) {
      result.status = Status::unresolved;
      result.message = "optimal by its numbers, but " + inaccurate;
    } else if (result.error && result.evaluation.objective != 0.0) {
      result.message += "; steps and elements: " + accuracy_text(design, result, trust);
    }
  }
  result.response_errors = std::move(trust.errors);
  result.response_bands = std::move(trust.bands);
}

}  // namespace pleuel
