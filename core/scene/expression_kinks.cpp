#include "core/scene/expression_kinks.hpp"

#include <algorithm>
#include <cmath>

namespace pleuel {

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
  std::sort(kinks.begin(), kinks.end());
  return kinks;
}

}  // namespace pleuel
