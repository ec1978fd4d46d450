#include "studies/uncertainty.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/find_named.hpp"
#include "core/base/int_size.hpp"
#include "core/base/stop.hpp"
#include "core/base/stopwatch.hpp"
#include "core/scene/packed_problem.hpp"
#include "core/trust/checks.hpp"
#include "optimization/design/design_case.hpp"
#include "optimization/verdict.hpp"
#include "sensitivity/method_choice.hpp"
#include "studies/missing_settings.hpp"
#include "studies/noise.hpp"

namespace pleuel {

namespace {

/// A number of each parameter.
template <class Number>
Eigen::VectorXd of_parameters(const std::vector<UncertainParameter>& parameters,
                              const Number& number) {
  Eigen::VectorXd all(parameters.size());
  for (Eigen::Index i = 0; i < all.size(); ++i) all(i) = std::invoke(number, parameters[i]);
  return all;
}

/// Mean and variance of numbers that come one by one (Welford 1962).
class Moments {
 public:
  void add(const Eigen::VectorXd& values) {
    if (count_ == 0) {
      mean_ = squares_ = Eigen::VectorXd::Zero(values.size());
      lowest_ = highest_ = values;
    }
    ++count_;
    const Eigen::VectorXd change = values - mean_;
    mean_ += change / count_;
    squares_ += change.cwiseProduct(values - mean_);
    lowest_ = lowest_.cwiseMin(values);
    highest_ = highest_.cwiseMax(values);
  }
  Eigen::VectorXd deviations() const { return (squares_ / std::max(1, count_ - 1)).cwiseSqrt(); }
  Sampled of(Eigen::Index i) const { return {mean_(i), deviations()(i), lowest_(i), highest_(i)}; }
  int count() const { return count_; }

 private:
  int count_ = 0;
  Eigen::VectorXd mean_, squares_, lowest_, highest_;
};

/// Whether a value is beyond a limit by more than an optimum may be.
bool breaks(const LimitScatter& limit, double value) {
  const double excess = limit.is_upper ? value - limit.limit : limit.limit - value;
  return excess > Tolerances().violation * std::abs(limit.limit);
}

/// Without values if the design could not be simulated, without histories if its steps differ.
struct Sample {
  Eigen::VectorXd values, histories;
};

/// So many samples a task, which take longer than to make a process for them.
constexpr int task_size = 8;

/// Simulations of samples.
struct SampleData {
  static constexpr const char* kind = sample_work_name;

  ProblemFile problem;  ///< with the steps of the design that they are drawn around
  std::vector<Eigen::VectorXd> designs;
  Eigen::Index instants = 0;           ///< of that design
  std::vector<std::size_t> responses;  ///< whose histories are sampled
  std::vector<int> places;             ///< of those histories

  std::string run(int task, const std::string& /*needed*/, TaskCaller& caller,
                  EvaluationStore* store) const {
    for (int i = task * task_size; i < end_of(task); ++i) {
      caller.tell(packed(store ? known(designs[i], *store) : simulated(designs[i])));
    }
    return "";
  }

  int size() const { return int_size(designs); }
  int end_of(int task) const { return std::min((task + 1) * task_size, size()); }

 private:
  /// From the store, or for it: values and histories one behind the other.
  Sample known(const Eigen::VectorXd& design, EvaluationStore& store) const {
    const std::string rows = responses.empty() ? "sample" : "sample with histories";
    const EvaluationKey key = {setting_text(problem), rows, "", Request::values, design};
    const Eigen::Index values = problem.responses.size();
    if (const auto stored = store.find(key)) {
      if (!stored->failure.empty()) return {};
      const Eigen::VectorXd& numbers = stored->evaluation.constraints;
      return {numbers.head(values), numbers.tail(numbers.size() - values)};
    }
    const Stopwatch stopwatch;
    const Sample sample = simulated(design);
    StoredEvaluation stored;
    stored.seconds = stopwatch.seconds();
    if (sample.values.size() == 0) stored.failure = "it could not be simulated";
    stored.evaluation.constraints.resize(sample.values.size() + sample.histories.size());
    stored.evaluation.constraints << sample.values, sample.histories;
    store.keep(key, stored);
    return sample;
  }

  Sample simulated(const Eigen::VectorXd& design) const {
    try {
      const auto analysis = analyze(problem, design, values_only);
      return {values_of(*analysis), histories_of(*analysis)};
    } catch (const SimulationError&) {
      return {};
    }
  }

  /// None where steps that were split add instants.
  Eigen::VectorXd histories_of(const Analysis& analysis) const {
    if (analysis.trajectory.time.size() != instants) return {};
    Eigen::VectorXd all(instants * static_cast<Eigen::Index>(responses.size()));
    for (std::size_t k = 0; k < responses.size(); ++k) {
      all.segment(static_cast<Eigen::Index>(k) * instants, instants) =
          analysis.histories[responses[k]].row(places[k]).transpose();
    }
    return all;
  }
};

/// Hears of samples and sums them up, batch by batch.
class Samples : public StoredTasks<SampleData> {
 public:
  Samples(SampleData data, std::vector<LimitScatter>& limits, EvaluationStore* store,
          const SampleObserver& observer, double expected_seconds)
      : StoredTasks(std::move(data), store), limits_(limits), observer_(observer) {
    if (observer_) observer_(0, expected_seconds);
  }

  int count() const override { return (data().size() + task_size - 1) / task_size; }

  void hear(int task, const std::string& message) override {
    // After a stop, samples are missing before those of later tasks.
    if (task == heard_ / task_size) add(unpacked<Sample>(message));
  }

  void take(int /*task*/, const std::string& /*answer*/) override {}

  void fail(int task, const std::string& /*failure*/) override {
    while (heard_ < data().end_of(task)) add({});
  }

  int failures() const { return failures_; }
  const Moments& responses() const { return responses_; }
  const Moments& histories() const { return histories_; }

 private:
  static constexpr int batch_size = 64;

  void add(Sample sample) {
    batch_.push_back(std::move(sample));
    ++heard_;
    if (batch_.size() < batch_size && heard_ < data().size()) return;
    for (const Sample& one : batch_) sum_up(one);
    batch_.clear();
    const double a_sample = stopwatch_.seconds() / heard_;
    if (observer_) observer_(heard_, a_sample * (data().size() - heard_));
  }

  void sum_up(const Sample& sample) {
    if (!sample.values.allFinite() || sample.values.size() == 0) {
      ++failures_;
      return;
    }
    responses_.add(sample.values);
    for (LimitScatter& limit : limits_)
      limit.broken += breaks(limit, sample.values(limit.response));
    if (sample.histories.size() > 0) histories_.add(sample.histories);
  }

  std::vector<LimitScatter>& limits_;
  const SampleObserver& observer_;
  Stopwatch stopwatch_;
  std::vector<Sample> batch_;  ///< that is not yet whole
  int heard_ = 0, failures_ = 0;
  Moments responses_, histories_;
};

class Study {
 public:
  Study(const ProblemFile& problem, const UncertaintySettings& settings)
      : settings_(settings),
        x_(start_design(problem)),
        deviations_(of_parameters(settings.parameters, &UncertainParameter::standard_deviation)),
        analysis_(analyze(problem, x_)),
        simulation_seconds_(stopwatch_.seconds()),
        with_same_steps_(with_steps_of(analysis_->trajectory, problem)) {
    for (const UncertainParameter& one : settings.parameters) columns_.push_back(one.variable);
    const Monitors monitors = monitor(analysis_->model, analysis_->trajectory);
    Trust trust = judge_run(TrustedRun{problem, x_, *analysis_, monitors});
    study_.findings = std::move(trust.findings);
    study_.errors = std::move(trust.errors);
  }

  void linearize() {
    const Stopwatch stopwatch;
    const auto values = response_values(*analysis_);
    const Eigen::MatrixXd all =
        sampled_gradients(*analysis_, values, choose_method(*analysis_, values).method);
    for (Eigen::Index i = 0; i < all.rows(); ++i) {
      study_.responses.push_back(
          first_order(settings_, analysis_->reductions[i].value, all.row(i)));
    }
    linearize_limits();
    linearize_histories();
    study_.gradient_seconds = stopwatch.seconds();
  }

  void sample(const Execution& execution, const SampleObserver& observer, SampledNumbers numbers) {
    if (settings_.samples == 0) return;
    const Stopwatch stopwatch;
    Samples samples(sample_data(numbers), study_.limits, execution.store, observer,
                    settings_.samples * simulation_seconds_ / std::max(1, execution.tasks.jobs));
    try {
      run_tasks(samples, execution.tasks);
    } catch (const Stopped&) {
      study_.is_interrupted = true;  // whole batches only: so the numbers can be made again
    }
    study_.failures = samples.failures();
    study_.samples = samples.responses().count();
    store(samples.responses(), samples.histories());
    study_.sampling_seconds = stopwatch.seconds();
  }

  UncertaintyStudy take() { return std::move(study_); }

 private:
  void linearize_limits() {
    const auto& constraints = with_same_steps_.constraints;
    for (std::size_t c = 0; c < constraints.size(); ++c) {
      const auto response = index_of_named(with_same_steps_.responses, constraints[c].response);
      if (!response) continue;  // a limit on variables alone
      const UncertainResponse& of = study_.responses[*response];
      const auto add = [&](bool is_upper, const std::optional<double>& limit) {
        if (!limit) return;
        // Infinite where nothing scatters.
        const double distance = (is_upper ? *limit - of.value : of.value - *limit) / of.deviation;
        study_.limits.push_back({c, *response, is_upper, *limit,
                                 of.value + (is_upper ? of.bound : -of.bound), distance});
      };
      add(true, constraints[c].upper);
      add(false, constraints[c].lower);
    }
  }

  /// σ(t) of every history: one value a response and instant.
  void linearize_histories() {
    study_.time = analysis_->trajectory.time;
    for (const HistoryGradients& history : history_gradients(*analysis_)) {
      const Eigen::MatrixXd parts =
          history.gradients(Eigen::all, columns_) * deviations_.asDiagonal();
      study_.histories.push_back({history.response, history.values, parts.rowwise().norm(), {}});
      places_.push_back(history.place);
    }
  }

  /// All samples at once, so that they do not depend on who simulates them.
  std::vector<Eigen::VectorXd> draw() const {
    RandomNumbers numbers(settings_.seed);
    std::vector<Eigen::VectorXd> designs(settings_.samples, x_);
    for (Eigen::VectorXd& design : designs) {
      for (const UncertainParameter& parameter : settings_.parameters) {
        double change = 0.0;
        do {
          change = parameter.deviation > 0.0 ? parameter.deviation * numbers.normal()
                                             : parameter.interval * (2.0 * numbers.uniform() - 1.0);
        } while (std::abs(change) > sample_extent(parameter));
        design(parameter.variable) += change;
      }
    }
    return designs;
  }

  SampleData sample_data(SampledNumbers numbers) const {
    SampleData data{with_same_steps_, draw(), study_.time.size(), {}, {}};
    if (numbers == SampledNumbers::values) return data;
    for (const UncertainHistory& history : study_.histories) {
      data.responses.push_back(history.response);
    }
    data.places = places_;
    return data;
  }

  void store(const Moments& responses, const Moments& histories) {
    if (responses.count() < 2) return;
    for (std::size_t i = 0; i < study_.responses.size(); ++i) {
      study_.responses[i].sampled = responses.of(i);
    }
    check_first_order(responses.count());
    if (histories.count() < 2) return;
    const Eigen::VectorXd deviations = histories.deviations();
    const Eigen::Index instants = study_.time.size();
    for (std::size_t k = 0; k < study_.histories.size(); ++k) {
      study_.histories[k].sampled_deviations =
          deviations.segment(static_cast<Eigen::Index>(k) * instants, instants);
    }
  }

  /// Where samples deviate by others than first order says, by more than their own scatter.
  void check_first_order(int samples) {
    constexpr double small = 0.1;       // of a deviation
    constexpr double round_off = 1e-9;  // of a value
    const double scatter = 3.0 / std::sqrt(2.0 * (samples - 1.0));
    for (std::size_t i = 0; i < study_.responses.size(); ++i) {
      const UncertainResponse& response = study_.responses[i];
      const double first = response.deviation, sampled = response.sampled->deviation;
      const double larger = std::max(first, sampled);
      if (larger <= round_off * std::abs(response.value)) continue;
      if (std::abs(sampled - first) <= std::max(small, scatter) * larger) continue;
      const std::string& name = analysis_->responses[i].name;
      const std::string share = first <= round_off * sampled
                                    ? "samples deviate, where first order says that nothing does"
                                    : fmt::format(
                                          "its deviation by samples is {:.3g} times that of "
                                          "first order",
                                          sampled / first);
      study_.findings.push_back(
          {fmt::format("\"{}\" is not linear over the range of the parameters: "
                       "{}. Rely on the samples.",
                       name, share),
           false,
           {name}});
    }
  }

  const UncertaintySettings& settings_;
  Eigen::VectorXd x_, deviations_;
  std::vector<Eigen::Index> columns_;  ///< the variables that are uncertain
  Stopwatch stopwatch_;
  std::unique_ptr<Analysis> analysis_;
  double simulation_seconds_;
  ProblemFile with_same_steps_;
  UncertaintyStudy study_;
  std::vector<int> places_;  ///< of the histories
};

}  // namespace

UncertainResponse first_order(const UncertaintySettings& settings, double value,
                              const Eigen::VectorXd& gradient) {
  const std::vector<UncertainParameter>& parameters = settings.parameters;
  UncertainResponse response;
  response.value = value;
  response.gradient = of_parameters(
      parameters, [&](const UncertainParameter& one) { return gradient(one.variable); });
  const Eigen::VectorXd parts = response.gradient.cwiseProduct(
      of_parameters(parameters, &UncertainParameter::standard_deviation));
  response.deviation = parts.norm();
  response.bound =
      response.gradient.cwiseAbs().dot(of_parameters(parameters, &UncertainParameter::half_width));
  response.shares = parts.cwiseAbs2();
  if (response.deviation > 0.0) response.shares /= parts.squaredNorm();
  return response;
}

std::unique_ptr<TaskWork> make_sample_work(const std::string& content) {
  return make_stored_work<SampleData>(content);
}

UncertaintyStudy uncertainty_study(const ProblemFile& problem, const Execution& execution,
                                   const SampleObserver& observer, SampledNumbers numbers) {
  require_uncertainty(problem);
  Study study(problem, *problem.uncertainty);
  study.linearize();
  study.sample(execution, observer, numbers);
  return study.take();
}

}  // namespace pleuel
