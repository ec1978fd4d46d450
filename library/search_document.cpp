#include "library/search_document.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "cli/input/run_setting.hpp"
#include "cli/reports/optimum_document.hpp"
#include "cli/reports/starts_report.hpp"
#include "core/base/error.hpp"
#include "core/base/stop.hpp"
#include "core/jobs/parallel.hpp"
#include "core/scene/reading/suggestion.hpp"
#include "library/open_problem.hpp"
#include "optimization/design/multi_start.hpp"

namespace pleuel {

namespace {

const std::vector<std::string> known_keys = {"backend", "tolerance", "max_iterations",
                                             "starts",  "jobs",      "checks"};

[[noreturn]] void refuse(const std::string& key, const std::string& rule, const Json& value) {
  throw InputError(fmt::format("options: /{} must be {}, got {}", key, rule, value.dump()));
}

Json parsed_object(const std::string& text) {
  Json document = Json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!document.is_object()) throw InputError("options: must be a JSON object");
  for (const auto& [key, value] : document.items()) {
    if (std::find(known_keys.begin(), known_keys.end(), key) != known_keys.end()) continue;
    throw InputError(
        fmt::format("options: the key \"{}\" is unknown{}", key, hint(key, known_keys)));
  }
  return document;
}

/// @param standard  where the object does not have it
int count_of(const Json& document, const std::string& key, int standard) {
  if (!document.contains(key)) return standard;
  const Json& value = document[key];
  constexpr int most = 1'000'000;
  if (!value.is_number_integer() || value < 1 || value > most) {
    refuse(key, fmt::format("a whole number from 1 to {}", most), value);
  }
  return value.get<int>();
}

double share_of(const Json& document, const std::string& key, double standard) {
  if (!document.contains(key)) return standard;
  const Json& value = document[key];
  if (!value.is_number() || value <= 0.0 || value >= 1.0) {
    refuse(key, "a number between 0 and 1", value);
  }
  return value.get<double>();
}

bool choice_of(const Json& document, const std::string& key) {
  if (!document.contains(key)) return true;
  if (!document[key].is_boolean()) refuse(key, "true or false", document[key]);
  return document[key].get<bool>();
}

Arguments arguments_for(const Json& document) {
  Arguments arguments;
  if (document.contains("backend")) {
    if (!document["backend"].is_string()) refuse("backend", "a text", document["backend"]);
    arguments.backend = document["backend"].get<std::string>();
  }
  if (!choice_of(document, "checks")) arguments.scrutiny = Scrutiny::none;
  return arguments;
}

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

SearchOptions read_search_options(const std::string& text, const ProblemFile& problem) {
  const Json document = parsed_object(text);
  SearchOptions options{solve_options(problem, arguments_for(document))};
  options.solve.tolerance = share_of(document, "tolerance", options.solve.tolerance);
  options.solve.max_iterations = count_of(document, "max_iterations", options.solve.max_iterations);
  options.starts = count_of(document, "starts", problem.optimizer.starts);
  options.jobs = count_of(document, "jobs", available_threads());
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
