#include "library/search_document.hpp"

#include "cli/input/run_setting.hpp"
#include "cli/reports/optimum_document.hpp"
#include "core/base/stop.hpp"
#include "core/jobs/parallel.hpp"
#include "core/scene/reading/mistakes.hpp"
#include "core/scene/reading/number_reader.hpp"
#include "library/open_problem.hpp"
#include "optimization/design/multi_start.hpp"

namespace pleuel {

namespace {

pleuel_progress progress_of(const EvaluationRecord& record) {
  return {record.evaluation,
          record.iteration,
          static_cast<size_t>(record.x.size()),
          static_cast<size_t>(record.constraints.size()),
          record.x.data(),
          record.objective,
          record.constraints.data(),
          record.max_violation,
          record.failure.c_str()};
}

/// What the listener wants to end is ended as a signal ends it. What it throws stays here: backends are written in
/// other languages.
class Heard {
 public:
  explicit Heard(const Listener& listener) : listener_(listener) {}

  void hear(const EvaluationRecord& record) {
    if (listener_.observer == nullptr) return;
    const pleuel_progress progress = progress_of(record);
    try {
      wants_end_ = wants_end_ || listener_.observer(&progress, listener_.user) != 0;
    } catch (...) {
      has_thrown_ = wants_end_ = true;
    }
    if (wants_end_) throw Stopped{};
  }

  void require_no_throw() const {
    if (has_thrown_) throw CallError("the observer threw an exception; it must return instead");
  }

 private:
  const Listener& listener_;
  bool wants_end_ = false, has_thrown_ = false;
};

Json document_of(const WholeSearch& search) {
  Json document = optimum_document(optimum_of(search));
  document.erase("monitors");
  add_search(search, document);
  return document;
}

}  // namespace

SearchOptions read_search_options(const std::string& text, const ProblemFile& problem) {
  constexpr int most = 1'000'000;
  const std::string name = "options";
  const Json document = parse_json(text, name);
  const JsonNode node(document, name, "", "the whole");
  node.allow_keys({"backend", "tolerance", "max_iterations", "starts", "jobs", "checks"});
  const auto count = [&](const std::string& key, int standard) {
    const auto value = node.find(key);
    return value ? value->whole_number(1, most) : standard;
  };
  Arguments arguments;
  if (const auto backend = node.find("backend")) arguments.backend = backend->text();
  const auto checks = node.find("checks");
  if (checks && !checks->truth()) arguments.scrutiny = Scrutiny::none;
  SearchOptions options{solve_options(problem, arguments)};
  if (const auto tolerance = node.find("tolerance")) {
    options.solve.tolerance = tolerance->number();
    if (!is_within(Range::tolerance, options.solve.tolerance)) {
      tolerance->fail_with_value(rule_of(Range::tolerance, quantities::pure_number));
    }
  }
  options.solve.max_iterations = count("max_iterations", options.solve.max_iterations);
  options.starts = count("starts", problem.optimizer.starts);
  options.jobs = count("jobs", available_threads());
  return options;
}

Json search_document(const ProblemFile& problem, const Eigen::VectorXd& start,
                     const SearchOptions& options, const Listener& listener) {
  Heard heard(listener);
  const Observer observer = [&](const EvaluationRecord& record) { heard.hear(record); };
  try {
    const WholeSearch search =
        search_design(problem, starts_of(problem, start, options.starts),
                      {options.solve, {{options.jobs, 0.0, nullptr}, nullptr}, observer});
    heard.require_no_throw();
    return document_of(search);
  } catch (const Stopped&) {
    heard.require_no_throw();
    throw;
  }
}

}  // namespace pleuel
