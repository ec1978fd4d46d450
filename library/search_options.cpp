#include "library/search_options.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "cli/input/run_setting.hpp"
#include "cli/text/json.hpp"
#include "core/base/error.hpp"
#include "core/jobs/parallel.hpp"
#include "core/scene/reading/suggestion.hpp"

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

}  // namespace pleuel
