// Opening problems and what is known of them without simulation (include/pleuel.h).

#include "library/guarded_call.hpp"

namespace {

using namespace pleuel;

std::string text_or_none(const char* text) {
  return text == nullptr ? std::string() : std::string(text);
}

const std::string& entry_of(const std::vector<std::string>& entries, std::size_t index) {
  require_index(index, entries.size(), "index");
  return entries[index];
}

}  // namespace

pleuel_status pleuel_open(const char* file, const char* text, const char* const* overrides,
                          size_t override_count, const char* load_case, pleuel_problem* problem) {
  return guarded_call([&] {
    require_pointer(problem, "problem");
    require_pointer(file, "file");
    ProblemText source{text_or_none(text), file, {}, text_or_none(load_case)};
    if (override_count > 0) require_pointer(overrides, "overrides");
    for (size_t i = 0; i < override_count; ++i) {
      require_pointer(overrides[i], "overrides");
      source.overrides.emplace_back(overrides[i]);
    }
    *problem = add_open_problem(std::make_shared<OpenProblem>(source, text != nullptr));
  });
}

pleuel_status pleuel_close(pleuel_problem problem) {
  return guarded_call([&] { remove_open_problem(problem); });
}

pleuel_status pleuel_count(pleuel_problem problem, pleuel_list list, size_t* count) {
  return guarded_call(problem, [&](const OpenProblem& open) {
    require_pointer(count, "count");
    *count = open.names(list).size();
  });
}

pleuel_status pleuel_name(pleuel_problem problem, pleuel_list list, size_t index,
                          const char** name) {
  return guarded_call(problem, [&](const OpenProblem& open) {
    require_pointer(name, "name");
    *name = entry_of(open.names(list), index).c_str();
  });
}

pleuel_status pleuel_unit(pleuel_problem problem, pleuel_list list, size_t index,
                          const char** unit) {
  return guarded_call(problem, [&](const OpenProblem& open) {
    require_pointer(unit, "unit");
    *unit = entry_of(open.units(list), index).c_str();
  });
}

pleuel_status pleuel_bounds(pleuel_problem problem, double* start, double* lower, double* upper,
                            size_t variables) {
  return guarded_call(problem, [&](const OpenProblem& open) {
    const std::vector<DesignVariable>& all = open.file().variables;
    require_size(variables, all.size(), "variables");
    for (size_t i = 0; i < variables; ++i) {
      if (start != nullptr) start[i] = all[i].start;
      if (lower != nullptr) lower[i] = all[i].lower;
      if (upper != nullptr) upper[i] = all[i].upper;
    }
  });
}

pleuel_status pleuel_limits(pleuel_problem problem, double* lower, double* upper, size_t limits) {
  return guarded_call(problem, [&](const OpenProblem& open) {
    const std::vector<ConstraintSettings>& all = open.file().constraints;
    require_size(limits, all.size(), "limits");
    for (size_t i = 0; i < limits; ++i) {
      if (lower != nullptr) lower[i] = all[i].lower.value_or(-infinity);
      if (upper != nullptr) upper[i] = all[i].upper.value_or(infinity);
    }
  });
}
