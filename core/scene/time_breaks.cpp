#include "core/scene/time_breaks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/scene/acting_laws.hpp"

namespace pleuel {

namespace {

/// Steps between points of a table that are resolved one by one.
constexpr double sparse = 4.0;
/// Points of all periods: more are no events, but an oscillation.
constexpr double most_points = 1e5;
/// In which kinks of a formula are looked for.
constexpr int formula_samples = 4096;

/// The points of a law, of all periods.
struct LawTimes {
  std::vector<double> times;  ///< ascending
  bool jumps = false;
  bool is_smooth_inside = false;  ///< enough for loads, at all points but the first and the last
  bool is_repeated = false;
};

/// @param times  of the first period
std::vector<double> repeated(const std::vector<double>& times, double period, double end_time) {
  const double first = times.front(), last = times.back();
  const auto before = std::ceil(std::max(0.0, first) / period);
  const double periods = before + std::ceil(std::max(0.0, end_time - first) / period);
  const bool is_closed = last - first > period * (1.0 - 1e-9);
  if (periods * static_cast<double>(times.size()) > most_points) return times;
  std::vector<double> all;
  for (double k = -before; k <= periods - before; ++k) {
    for (std::size_t i = 0; i + (is_closed ? 1 : 0) < times.size(); ++i) {
      all.push_back(times[i] + k * period);
    }
  }
  return all;
}

LawTimes times_of(const TimeFunction& function, double end_time) {
  LawTimes law;
  double period = 0.0;
  if (const auto* table = std::get_if<TableFunction>(&function)) {
    if (table->argument != LawArgument::time) return {};
    law.times = table->times;
    law.jumps = table->interpolation == Interpolation::step;
    law.is_smooth_inside = !law.jumps && table->interpolation != Interpolation::linear;
    if (table->repetition == Repetition::periodic) period = law.times.back() - law.times.front();
  } else if (const auto* ramp = std::get_if<RampFunction>(&function)) {
    law.times = {ramp->begin, ramp->end};
    const double r = ramp->rounding;
    if (r > 0.0) law.times = {ramp->begin, ramp->begin + r, ramp->end - r, ramp->end};
    law.is_smooth_inside = true;
  } else if (const auto* wave = std::get_if<HalfSineFunction>(&function)) {
    law.times = {wave->begin, wave->begin + wave->duration};
    period = wave->period;
  } else if (const auto* formula = std::get_if<ExpressionFunction>(&function)) {
    law.times = kinks_in_time(*formula->expression, end_time, formula_samples);
  }
  if (period > 0.0) {
    law.is_repeated = true;
    law.times = repeated(law.times, period, end_time);
  }
  return law;
}

double closest(const std::vector<double>& times, std::size_t i) {
  double distance = std::numeric_limits<double>::infinity();
  if (i > 0) distance = times[i] - times[i - 1];
  if (i + 1 < times.size()) distance = std::min(distance, times[i + 1] - times[i]);
  return distance;
}

void add_breaks(const ActingLaw& acting, const TimeIntegration& integration,
                std::vector<double>& breaks) {
  const LawTimes law = times_of(acting.function, integration.end_time);
  const double least = law.jumps ? 0.0 : sparse * integration.step * (1.0 - 1e-9);
  for (std::size_t i = 0; i < law.times.size(); ++i) {
    const bool is_inside = law.is_repeated || (i > 0 && i + 1 < law.times.size());
    if (is_inside && !acting.is_motion() && law.is_smooth_inside) continue;
    if (closest(law.times, i) >= least) breaks.push_back(law.times[i]);
  }
}

}  // namespace

std::vector<double> time_breaks(const Scene& scene, const TimeIntegration& integration) {
  std::vector<double> breaks;
  for (const ActingLaw& law : acting_laws(scene)) add_breaks(law, integration, breaks);
  return breaks;
}

std::vector<double> sharp_times(const TimeFunction& function, double end_time) {
  return times_of(function, end_time).times;
}

namespace {

bool has_kink(const ExpressionStep& step) {
  return step.operation == Operation::smaller || step.operation == Operation::larger ||
         step.operation == Operation::magnitude;
}

class KinkSearch {
 public:
  explicit KinkSearch(const Expression& expression) : expression_(expression) {}

  /// Whether a result depends on nothing but time.
  bool is_of_time(int index) const {
    if (index < 0) return true;
    const ExpressionStep& step = expression_.steps[index];
    if (step.operation == Operation::constant) return true;
    if (step.operation == Operation::argument) {
      return expression_.arguments[step.first].kind == ExpressionArgument::Kind::time;
    }
    return is_of_time(step.first) && is_of_time(step.second);
  }

  /// What changes its sign where the sides change.
  double difference(const ExpressionStep& step, double time) const {
    const double first = result(step.first, time);
    return step.second < 0 ? first : first - result(step.second, time);
  }

  double bisect(const ExpressionStep& step, double from, double to) const {
    const bool is_negative = difference(step, from) < 0.0;
    for (int i = 0; i < 60 && from < to; ++i) {
      const double middle = 0.5 * (from + to);
      (difference(step, middle) < 0.0) == is_negative ? from = middle : to = middle;
    }
    return to;
  }

 private:
  double result(int index, double time) const {
    Expression part;
    part.arguments = expression_.arguments;
    part.steps.assign(expression_.steps.begin(), expression_.steps.begin() + index + 1);
    return evaluate(part, std::vector<double>(part.arguments.size(), time)).value;
  }

  const Expression& expression_;
};

}  // namespace

std::vector<double> kinks_in_time(const Expression& expression, double end_time, int samples) {
  const KinkSearch search(expression);
  std::vector<double> kinks;
  for (const ExpressionStep& step : expression.steps) {
    if (!has_kink(step) || !search.is_of_time(step.first) || !search.is_of_time(step.second)) {
      continue;
    }
    double before = search.difference(step, 0.0);
    for (int i = 1; i <= samples; ++i) {
      const double from = end_time * (i - 1) / samples, to = end_time * i / samples;
      const double now = search.difference(step, to);
      if ((before < 0.0) != (now < 0.0)) kinks.push_back(search.bisect(step, from, to));
      before = now;
    }
  }
  std::ranges::sort(kinks);
  const auto is_same = [&](double one, double next) { return next - one <= 1e-9 * end_time; };
  kinks.erase(std::unique(kinks.begin(), kinks.end(), is_same),
              kinks.end());  // one may occur twice
  return kinks;
}

}  // namespace pleuel
