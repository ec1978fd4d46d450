#include "optimization/design/design_case.hpp"

#include <variant>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/find_named.hpp"
#include "core/base/stopwatch.hpp"
#include "core/scene/body_source.hpp"
#include "sensitivity/method_choice.hpp"

namespace pleuel {

namespace {

std::string beam_text(const std::string& name, const BeamBody& beam) {
  std::string text = fmt::format("; {}:", name);
  for (const Segment& segment : beam.segments) {
    text += fmt::format(" {}", segment.elements);
    if (segment.fraction) text += fmt::format(" of {}", *segment.fraction);
  }
  if (beam.reduction) text += fmt::format(" +{} modes", beam.reduction->more_modes);
  return text;
}

std::string effects_text(const EffectSettings& effects) {
  std::string text = fmt::format("; effects {}", effects.tolerance);
  for (const auto& [body, estimates] : effects.decisions.estimates) {
    const auto& [elasticity, axial, torsional, stiffening, rotary] = estimates;
    text +=
        fmt::format(" {} {} {} {} {} {}", body, elasticity, axial, torsional, stiffening, rotary);
  }
  for (const auto& [name, effect] : effects.decisions.measured) {
    if (!effect.is_needed) text += fmt::format(" -{}/{}", name.first, name.second);
  }
  return text;
}

/// What is minimized and what is limited: the searches for the ends of a front differ in both.
std::string goals_text(const ProblemFile& file) {
  std::string text;
  if (file.objective) {
    const bool is_maximized = file.objective->aim == Aim::maximize;
    text +=
        fmt::format("; {} {}", is_maximized ? "maximize" : "minimize", file.objective->response);
  }
  text += "; limited";
  for (const ConstraintSettings& one : file.constraints) {
    text += fmt::format(" {}", one.response.empty() ? one.name : one.response);
  }
  return text;
}

}  // namespace

std::string setting_text(const ProblemFile& file) {
  const SimulationSettings& simulation = file.simulation;
  std::string text =
      fmt::format("step {} s, local error {}, smallest step {} s, newton {}", simulation.step,
                  simulation.local_error, simulation.smallest_step, simulation.newton_tolerance);
  for (const Body& body : file.scene.bodies) {
    if (const auto* beam = std::get_if<BeamBody>(&body.shape)) text += beam_text(body.name, *beam);
    const auto* imported = std::get_if<ImportedBody>(&body.shape);
    if (imported && imported->maker) {
      text += fmt::format("; {} made by {}", body.name, imported->maker->identity());
    }
  }
  text +=
      effects_text(file.effects) + "; gradients " + to_string(file.sensitivity.method) + "; start";
  for (const DesignVariable& variable : file.variables) text += fmt::format(" {}", variable.start);
  text += goals_text(file);
  if (!file.load_case.empty()) text += fmt::format("; case {}", file.load_case);
  return text;
}

std::size_t index_of_response(const ProblemFile& file, const std::string& name) {
  if (const auto index = index_of_named(file.responses, name)) return *index;
  throw InputError(fmt::format("there is no response \"{}\"", name));
}

DesignCase::DesignCase(ProblemFile file, int threads, EvaluationStore* store)
    : file_(std::move(file)), threads_(threads), store_(store) {
  if (store_) setting_ = setting_text(file_);
}

Analysis& DesignCase::analysis_at(const Eigen::VectorXd& x, Request request) {
  const bool has_derivatives = request == Request::values_and_gradients;
  if (!analysis_ || x != x_) {
    analysis_.reset();  // a failing simulation leaves nothing stale behind
    analysis_ = analyze(file_, x, {.has_derivatives = has_derivatives});
    x_ = x;
  }
  if (has_derivatives) analysis_ = with_derivatives(file_, std::move(analysis_));
  return *analysis_;
}

std::optional<std::size_t> DesignCase::response_of(const RowSource& rows) const {
  if (rows.part) return rows.part;
  if (!rows.constraint) return index_of_response(file_, file_.objective->response);
  const std::string& name = file_.constraints[*rows.constraint].response;
  if (name.empty()) return std::nullopt;
  return index_of_response(file_, name);
}

/// One after the other.
std::vector<DesignCase::Row> DesignCase::rows_at(const Analysis& analysis,
                                                 const std::vector<RowSource>& rows) const {
  std::vector<Row> all;
  for (const RowSource& of : rows) {
    const auto response = response_of(of);
    if (!response) {
      Row& row = all.emplace_back();
      row.gradient = Eigen::VectorXd::Zero(x_.size());
      for (const auto& [variable, factor] : file_.constraints[*of.constraint].linear) {
        row.value += factor * x_(variable);
        row.gradient(variable) += factor;
      }
    } else {
      const double sign = of.sign.value_or(of.constraint ? 1.0 : objective_sign());
      const Reduction& reduction = analysis.reductions[*response];
      divide(analysis, of.divided,
             {sign * reduction.value, SampledValue{*response, reduction.samples}, sign}, all);
    }
  }
  return all;
}

void DesignCase::divide(const Analysis& analysis, const std::vector<DividedPeaks>& divided,
                        const Row& whole, std::vector<Row>& rows) const {
  if (divided.empty()) {
    rows.push_back(whole);
    return;
  }
  const auto& [response, factor, division] = divided.front();
  const std::vector<DividedPeaks> others(divided.begin() + 1, divided.end());
  const double highest = analysis.reductions[response].value;
  for (const Reduction& peak : divided_peaks(analysis, file_, response, division)) {
    Row row = whole;
    if (response == whole.sampled->response) {
      row.value = whole.sign * peak.value;
      row.sampled->samples = peak.samples;
    } else {
      row.value += whole.sign * factor * (peak.value - highest);
      row.sampled->replaced.push_back({response, peak.samples});
    }
    divide(analysis, others, row, rows);
  }
}

GradientMethod DesignCase::method_for(const Analysis& analysis,
                                      const std::vector<SampledValue>& values) const {
  const bool may_differ = file_.sensitivity.method == GradientMethod::automatic &&
                          choice_->method == GradientMethod::adjoint;
  const bool has_more_rows = may_differ && values_of_motion(analysis, values) >= x_.size();
  return has_more_rows ? GradientMethod::direct : choice_->method;
}

Eigen::MatrixXd DesignCase::gradients_of(Analysis& analysis, const std::vector<RowSource>& rows,
                                         const std::vector<Row>& at_x) {
  std::vector<SampledValue> values;
  for (const Row& row : at_x) {
    if (row.sampled) values.push_back(*row.sampled);
  }
  Eigen::MatrixXd sampled;
  if (!values.empty()) {
    if (!choice_) choice_ = choose_gradients(file_.sensitivity.method, analysis, values);
    used_ = method_for(analysis, values);
  }
  const bool has_signs = is_difference(used_);
  if (!values.empty() && has_signs) {
    const ValuesOf numbers = [&](const Analysis& at) {
      std::vector<double> all;
      for (const Row& row : rows_at(at, rows)) {
        if (row.sampled) all.push_back(row.value);
      }
      return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(all.data(), std::ssize(all)));
    };
    sampled = gradients_by_differences(file_, x_, analysis, used_, numbers,
                                       {file_.sensitivity.difference_step, threads_});
  } else if (!values.empty()) {
    sampled = sampled_gradients(analysis, values, exact_method(used_));
  }
  Eigen::MatrixXd gradients(at_x.size(), x_.size());
  Eigen::Index row = 0, next = 0;
  for (const Row& one : at_x) {
    if (one.sampled) {
      gradients.row(row++) = (has_signs ? 1.0 : one.sign) * sampled.row(next++);
    } else {
      gradients.row(row++) = one.gradient;
    }
  }
  return gradients;
}

std::optional<StoredEvaluation> DesignCase::recall(const Eigen::VectorXd& x, Request request,
                                                   const std::string& name,
                                                   const std::vector<RowSource>& rows) {
  if (!store_) return std::nullopt;
  const GradientMethod method = choice_ ? choice_->method : file_.sensitivity.method;
  const bool is_open = method == GradientMethod::automatic;
  const bool has_method = request == Request::values_and_gradients && !is_open;
  asked_ = {setting_, name, has_method ? to_string(method) : "", request, x};
  auto stored = store_->find(*asked_);
  if (!stored) return std::nullopt;
  if (stored->older_row > 0) recalled_.emplace_back(*asked_, rows);
  if (!choice_ && !stored->method.empty()) {
    choice_ = GradientChoice{gradient_method(stored->method), stored->reason};
  }
  return stored;
}

StoredEvaluation DesignCase::compute(const Eigen::VectorXd& x, Request request,
                                     const std::vector<RowSource>& rows) {
  const Stopwatch stopwatch;
  StoredEvaluation answer;
  try {
    answer.evaluation = simulated_rows(x, request, rows);
    if (request == Request::values_and_gradients && choice_) {
      answer.method = to_string(used_);
      answer.reason = choice_->reason;
    }
  } catch (const SimulationError& error) {
    answer.failure = error.what();
  }
  answer.seconds = stopwatch.seconds();
  return answer;
}

void DesignCase::confirm(const std::function<bool(const Eigen::VectorXd& x)>& counts) {
  for (const auto& [key, rows] : std::exchange(recalled_, {})) {
    if (counts(key.x)) store_->confirm(key, compute(key.x, key.request, rows));
  }
}

Evaluation DesignCase::simulated_rows(const Eigen::VectorXd& x, Request request,
                                      const std::vector<RowSource>& rows) {
  Analysis& analysis = analysis_at(x, request);
  std::vector<RowSource> asked = rows;
  if (has_objective()) asked.insert(asked.begin(), RowSource());
  const std::vector<Row> all = rows_at(analysis, asked);
  const Eigen::Index first = has_objective() ? 1 : 0, count = std::ssize(all) - first;
  Evaluation evaluation;
  if (has_objective()) evaluation.objective = all.front().value;
  evaluation.constraints.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) evaluation.constraints(i) = all[first + i].value;
  if (request == Request::values) return evaluation;

  const Eigen::MatrixXd gradients = gradients_of(analysis, asked, all);
  evaluation.objective_gradient = Eigen::VectorXd::Zero(x.size());
  if (has_objective()) evaluation.objective_gradient = gradients.row(0);
  evaluation.constraint_jacobian = gradients.bottomRows(count);
  return evaluation;
}

}  // namespace pleuel
