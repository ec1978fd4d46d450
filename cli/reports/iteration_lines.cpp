#include "cli/reports/iteration_lines.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "cli/text/console.hpp"
#include "cli/text/wrapped_text.hpp"
#include "core/base/number_text.hpp"
#include "optimization/verdict.hpp"

namespace pleuel {

namespace {

constexpr const char* line_columns = "  {:>9}  {:>16}  {:>13}  {:>9}  {:>9}\n";

/// What happened and where; history.csv keeps the rest of the sentence.
std::string first_clause(const std::string& message) {
  return message.substr(0, std::min(message.find("; "), message.find(". ")));
}

const char* describe(Purpose purpose) {
  static constexpr std::array<const char*, 5> texts = {
      "the backend goes on", "the answer is refined", "the limits alone",
      "of the answer, by designs beside it", "of choices of sizes, the best design of each"};
  return texts[static_cast<std::size_t>(purpose)];
}

/// Without limits broken before one with: an order in which the last is the best.
bool is_better(const EvaluationRecord& one, const EvaluationRecord& other) {
  const double allowed = Tolerances().violation;
  const bool are_inside = std::max(one.max_violation, other.max_violation) <= allowed;
  return are_inside ? one.objective < other.objective : one.max_violation < other.max_violation;
}

}  // namespace

IterationLines::IterationLines(std::FILE* out, const ProblemFile& problem)
    : out_(out),
      unit_(unit_of(find_response(problem, problem.objective->response))),
      sign_(problem.objective->sign()) {
  show(out_, fmt::format(line_columns, "iteration", fmt::format("objective [{}]", unit_.name),
                         "max violation", "step", "seconds"));
}

void IterationLines::see(const EvaluationRecord& record) {
  if (trial_ && (record.purpose != Purpose::trial || record.iteration != trial_->iteration)) {
    print(*std::exchange(trial_, std::nullopt));
  }
  if (record.purpose != purpose_) {
    purpose_ = record.purpose;
    step_ = 0.0;
    show(out_, fmt::format("  {:>9}  {}\n", to_string(purpose_), describe(purpose_)));
  }
  step_ = std::max(step_, record.step);
  if (record.has_failed()) {
    show(out_, wrapped(fmt::format("  evaluation {} failed: {}\n", record.evaluation,
                                   first_clause(record.failure)),
                       "    "));
  } else if (purpose_ == Purpose::trial) {
    if (!trial_ || is_better(record, *trial_)) trial_ = record;
  } else if (purpose_ != Purpose::audit && record.iteration > iteration_) {
    print(record);
  }
}

void IterationLines::print(const EvaluationRecord& record) {
  show(out_, fmt::format(line_columns, record.iteration,
                         significant(unit_.shown(sign_ * record.objective), 6),
                         magnitude(record.max_violation), magnitude(step_),
                         fmt::format("{:.1f}", record.seconds)));
  iteration_ = record.iteration;
  step_ = 0.0;
}

}  // namespace pleuel
