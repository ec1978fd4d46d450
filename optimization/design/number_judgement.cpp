#include "optimization/design/number_judgement.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/number_text.hpp"
#include "core/response/monitors.hpp"
#include "core/scene/load_cases.hpp"
#include "core/trust/finding.hpp"
#include "optimization/design/margin_problem.hpp"
#include "optimization/scaling.hpp"

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

/// The error of Σ weight · response. The runs of a case are its own: errors cancel within a case only.
/// @param parts      responses of single cases, by their places in the joined problem
/// @param magnitude  what errors are small beside
/// @returns nothing where no error is known
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

/// How far the numbers of a design can be trusted, of all load cases: one error, one evidence and
/// one band a response of the joined problem. Findings say which cases they are of; one that all cases
/// share stands once.
/// @param x  that can be simulated
Trust judge_cases(DesignProblem& design, const Eigen::VectorXd& x, Scrutiny scrutiny) {
  const ProblemFile& file = design.file();
  if (!file.has_cases()) return trust_of(design.load_case(0), x, scrutiny);
  std::vector<std::vector<Finding>> findings;
  Trust all;
  for (std::size_t c = 0; c < design.case_count(); ++c) {
    Trust one = trust_of(design.load_case(c), x, scrutiny);
    findings.push_back(std::move(one.findings));
    if (all.failed_run.empty()) all.failed_run = std::move(one.failed_run);
    for (std::size_t i = 0; i < file.responses.size(); ++i) {
      if (is_over_cases(file, i) || file.case_responses[i].load_case != c) continue;
      const auto keep = [&](auto& numbers, const auto& of_case) {
        if (of_case.empty()) return;
        numbers.resize(file.responses.size());
        numbers[i] = of_case[file.case_responses[i].index];
      };
      keep(all.errors, one.errors);
      keep(all.evidence, one.evidence);
      keep(all.bands, one.bands);
    }
  }
  all.evidence.resize(all.errors.size());
  if (!all.errors.empty()) add_errors_over_cases(design, x, all);
  all.findings = joined_findings(file, findings);
  return all;
}

/// Steps that are proposed aim at so much of the target.
constexpr double proposed_share = 0.7;

/// What would bring an error below the target.
std::string advice(const ProblemFile& file, const ErrorBar& bar, double excess) {
  if (bar.effects.bound > std::max(bar.elements.bound, bar.step.bound)) {
    return "Try a smaller /effects/tolerance";
  }
  if (bar.elements.bound > bar.step.bound && bar.elements.is_resolved) {
    return "Try twice the elements";
  }
  const double factor =
      bar.step.is_resolved ? std::clamp(std::sqrt(proposed_share / excess), 1.0 / 16.0, 0.9) : 0.25;
  if (file.has_cases()) return fmt::format("Try {:.2g} times the /simulation/step", factor);
  return fmt::format("Try a /simulation/step of {:.2g} s", factor * file.simulation.step);
}

/// Where nobody asks for an accuracy, an optimum is verified to what it is known; beyond this no number is to
/// be trusted (core/trust/resolution.hpp).
constexpr double most_unasked_error = 0.1;

double relative_error(const ErrorBar& bar, double size) {
  return size > 0.0 ? bar.bound() / size : 0.0;
}

/// @param size  what the error is compared with
/// @returns empty if the target is met
std::string complaint(const ProblemFile& file, const std::string& what, const ErrorBar& bar,
                      double size, const std::string& failed_run) {
  const bool is_asked = file.accuracy.chooses_setting;
  const double target = is_asked ? file.accuracy.target : most_unasked_error;
  const double share = relative_error(bar, size);
  if (!bar.is_modelled) return "";  // it is a finding that forbids more
  if (bar.is_resolved() && share <= target) return "";
  const std::string amount =
      bar.is_resolved() ? fmt::format("is known to ± {} % only", significant(100.0 * share, 2))
                        : std::string("is not resolved by steps and elements");
  const std::string asked =
      is_asked ? fmt::format(", /accuracy/target is {:g} %", 100.0 * target) : "";
  return fmt::format("{} {}{}. {}", what, amount, asked,
                     std::isfinite(share) ? advice(file, bar, share / target)
                                          : "A run that would tell failed: " + failed_run);
}

/// Whether a limit could be broken by the error of its value.
bool may_break(const ConstraintSettings& limit, double value, double error) {
  return (limit.upper && value + error > *limit.upper) ||
         (limit.lower && value - error < *limit.lower);
}

/// What f + Σ μ c is made of: the objective and what is limited, each a response of one case. Where f is
/// maximized it is f − Σ μ c, as the multipliers are those of −f.
std::vector<WeightedResponse> parts_of_optimum(DesignProblem& design, const Result& result) {
  const ProblemFile& file = design.file();
  std::vector<WeightedResponse> parts;
  const std::size_t objective = design.objective_response();
  if (file.objective->over_cases == OverCases::same) {
    parts = design.linearized_at(result.x, objective).parts;
  } else {
    const std::size_t of_case = file.case_responses[objective].index;
    const bool has_shares = result.case_shares.size() > 0;
    for (std::size_t c = 0; c < design.case_count(); ++c) {
      const double factor = has_shares ? result.case_shares(c) : design.objective_weight(c);
      if (factor != 0.0) parts.push_back({joined_response(file, {c, of_case}), factor});
    }
  }
  for (std::size_t i = 0; i < design.constraints().size(); ++i) {
    const auto response = design.response_of(i);
    const double multiplier = result.constraint_multipliers(i);
    if (!response || multiplier == 0.0) continue;
    for (const WeightedResponse& part : design.linearized_at(result.x, *response).parts) {
      parts.push_back({part.response, part.weight * design.objective_sign() * multiplier});
    }
  }
  return parts;
}

double nearest_limit(const ConstraintSettings& limit, double value) {
  if (!limit.lower) return *limit.upper;
  if (!limit.upper) return *limit.lower;
  return *limit.upper - value < value - *limit.lower ? *limit.upper : *limit.lower;
}

/// A limit that the error of its value could break, and what the error is compared with.
struct OpenLimit {
  const std::string& response;
  const ErrorBar& error;
  double size;
};

std::vector<OpenLimit> open_limits(DesignProblem& design, const Result& result,
                                   const Trust& trust) {
  std::vector<OpenLimit> open;
  const std::vector<ConstraintSettings>& limits = design.file().constraints;
  for (std::size_t i = 0; i < limits.size(); ++i) {
    const auto response = design.response_of(i);
    if (!response || !trust.errors[*response]) continue;
    const ErrorBar& error = *trust.errors[*response];
    const double value = result.evaluation.constraints(i);
    if (!may_break(limits[i], value, error.bound())) continue;
    open.push_back({limits[i].response, error, std::abs(nearest_limit(limits[i], value))});
  }
  return open;
}

}  // namespace

std::optional<ErrorBar> optimum_error(DesignProblem& design, const Result& result,
                                      const Trust& trust) {
  if (trust.errors.empty() || !has_prices(result)) return std::nullopt;
  return error_of_sum(design.file(), trust, parts_of_optimum(design, result),
                      std::abs(result.evaluation.objective))
      .value_or(ErrorBar());
}

double optimum_change(DesignProblem& design, const Result& result, const Eigen::VectorXd& changes) {
  double change = 0.0;
  for (const WeightedResponse& part : parts_of_optimum(design, result)) {
    change += part.weight * changes(part.response);
  }
  return change;
}

std::string inaccuracy(DesignProblem& design, const Result& result, const Trust& trust) {
  const std::optional<ErrorBar> bar = optimum_error(design, result, trust);
  if (!bar) return "";
  const ProblemFile& file = design.file();
  const std::string of_objective =
      complaint(file, fmt::format("the optimum of {}", file.objective->response), *bar,
                std::abs(result.evaluation.objective), trust.failed_run);
  if (!of_objective.empty()) return of_objective;
  for (const OpenLimit& limit : open_limits(design, result, trust)) {
    const std::string of_limit =
        complaint(file, fmt::format("\"{}\", which is limited,", limit.response), limit.error,
                  limit.size, trust.failed_run);
    if (!of_limit.empty()) return of_limit;
  }
  return "";
}

namespace {

/// How well it is known: "to ± 0.3 %, the limit on "sideways" to ± 1.3 %".
/// @pre result.error, and an objective that is not zero
std::string accuracy_text(DesignProblem& design, const Result& result, const Trust& trust) {
  const auto percent = [](double share) {
    return fmt::format("± {} %", significant(100.0 * share, 2));
  };
  std::string text =
      "to " + percent(relative_error(*result.error, std::abs(result.evaluation.objective)));
  for (const OpenLimit& limit : open_limits(design, result, trust)) {
    const double ratio = relative_error(limit.error, limit.size);
    if (ratio <= design.file().accuracy.target) continue;
    text += fmt::format(", the limit on \"{}\" to {}", limit.response, percent(ratio));
  }
  return text;
}

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
            std::ranges::any_of(finding.responses,
                                [&](const std::string& name) { return asked.contains(name); }));
  };
  const auto found = std::ranges::find_if(findings, counts);
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
