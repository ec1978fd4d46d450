#include "optimization/design/case_trust.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/response/monitors.hpp"
#include "core/scene/load_cases.hpp"
#include "core/trust/finding.hpp"

namespace pleuel {

namespace {

Trust trust_of(DesignCase& of_case, const Eigen::VectorXd& x, Scrutiny scrutiny) {
  const Analysis& analysis = of_case.analysis_at(x);
  const Monitors monitors = monitor(analysis.model, analysis.trajectory);
  return judge_run(TrustedRun{of_case.file(), x, analysis, monitors, scrutiny});
}

/// The evidence of zero, from the runs of another value.
Evidence nothing_beside(const Evidence& value) {
  Evidence nothing = value;
  nothing.add(value, -1.0);
  nothing.local = 0.0;
  return nothing;
}

/// Of numbers made from several cases, by what they are made from to first order.
void add_errors_over_cases(DesignProblem& design, const Eigen::VectorXd& x, Trust& trust) {
  const ProblemFile& file = design.file();
  for (std::size_t i = 0; i < file.responses.size(); ++i) {
    if (!is_over_cases(file, i)) continue;
    try {
      trust.errors[i] = error_of_sum(file, trust, design.linearized_at(x, i).parts,
                                     std::abs(design.value_at(x, i)));
    } catch (const SimulationError&) {  // it has no derivative here
    }
  }
}

}  // namespace

std::optional<ErrorBar> error_of_sum(const ProblemFile& joined, const Trust& trust,
                                     const std::vector<WeightedResponse>& parts, double magnitude) {
  std::map<std::size_t, Evidence> sums;
  ErrorBar model;  // of what is left out
  // A sum may cancel: what is small of it is small beside its terms.
  for (const WeightedResponse& part : parts) {
    if (!trust.evidence[part.response]) continue;
    magnitude = std::max(magnitude, std::abs(part.weight * trust.evidence[part.response]->value));
  }
  for (const WeightedResponse& part : parts) {
    if (!trust.errors[part.response] || part.weight == 0.0) continue;
    model.effects.add(trust.errors[part.response]->effects, part.weight);
    model.add_left_out(*trust.errors[part.response], part.weight);
    model.is_modelled = model.is_modelled && trust.errors[part.response]->is_modelled;
    const Evidence& evidence = *trust.evidence[part.response];
    const std::size_t load_case = case_of_response(joined, part.response).load_case;
    auto& sum = sums.try_emplace(load_case, nothing_beside(evidence)).first->second;
    sum.magnitude = magnitude;
    sum.add(evidence, part.weight);
  }
  if (sums.empty()) return std::nullopt;
  ErrorBar all;
  for (auto sum = sums.begin(); sum != sums.end(); ++sum) {
    const ErrorBar bar = error_bar(sum->second);
    if (sum == sums.begin()) {
      all = bar;
    } else {
      all.add(bar);
    }
  }
  all.effects = model.effects;
  all.left_out = std::move(model.left_out);
  all.is_modelled = model.is_modelled;
  return all;
}

Trust judge_cases(DesignProblem& design, const Eigen::VectorXd& x, Scrutiny scrutiny) {
  const ProblemFile& file = design.file();
  if (!file.has_cases()) return trust_of(design.load_case(0), x, scrutiny);
  std::vector<std::vector<Finding>> findings;
  Trust all;
  all.errors.resize(file.responses.size());
  all.evidence.resize(file.responses.size());
  all.bands.resize(file.responses.size());
  bool has_errors = false, has_bands = false;
  for (std::size_t c = 0; c < design.case_count(); ++c) {
    Trust one = trust_of(design.load_case(c), x, scrutiny);
    findings.push_back(std::move(one.findings));
    if (all.failed_run.empty()) all.failed_run = std::move(one.failed_run);
    for (std::size_t i = 0; i < file.responses.size(); ++i) {
      if (is_over_cases(file, i) || file.case_responses[i].load_case != c) continue;
      const std::size_t here = file.case_responses[i].index;
      has_errors = has_errors || !one.errors.empty();
      has_bands = has_bands || !one.bands.empty();
      if (!one.errors.empty()) all.errors[i] = one.errors[here];
      if (!one.evidence.empty()) all.evidence[i] = one.evidence[here];
      if (!one.bands.empty()) all.bands[i] = one.bands[here];
    }
  }
  if (!has_errors) {
    all.errors.clear();
    all.evidence.clear();
  }
  if (has_errors) add_errors_over_cases(design, x, all);
  if (!has_bands) all.bands.clear();
  all.findings = joined_findings(file, findings);
  return all;
}

}  // namespace pleuel
