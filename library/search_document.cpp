#include "library/search_document.hpp"

#include "cli/reports/optimum_document.hpp"
#include "cli/reports/starts_report.hpp"
#include "core/base/stop.hpp"
#include "library/call_error.hpp"
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
  const StagedSolution& best = search.all.best;
  const ProblemFile& solved = best.problem->file();
  const Result& result = best.result;
  Optimum optimum{
      solved, result, {}, {}, {}, result.warnings, result.consequences, best.problem->method()};
  if (search.sizes) optimum.sizes = &*search.sizes;
  Json document = optimum_document(optimum);
  document.erase("monitors");
  if (search.all.runs.size() > 1) document["starts"] = starts_document(solved, search.all);
  if (search.sizes) document["choices"] = sizes_document(solved, *search.sizes, result);
  return document;
}

}  // namespace

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
