#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "cli/commands/commands.hpp"
#include "cli/files/older_run.hpp"
#include "cli/text/characters.hpp"
#include "cli/text/table.hpp"
#include "core/base/error.hpp"
#include "core/base/number_text.hpp"

/// What differs between two runs, in what went in and in what came out.
namespace pleuel {

namespace {

/// A place where the inputs differ: null where it is missing.
struct Difference {
  std::string place;
  Json first, second;
};

Json at_or_null(const Json& document, const Json::json_pointer& place) {
  return document.contains(place) ? document.at(place) : Json();
}

/// Single values wherever both have them; what only one has, as a whole.
void add_differences(const Json& first, const Json& second, const std::string& place,
                     std::vector<Difference>& differences) {
  if (first == second) return;
  if (first.is_object() && second.is_object()) {
    Json all = first;
    all.update(second);
    for (const auto& [key, unused] : all.items()) {
      const Json::json_pointer pointer = Json::json_pointer() / key;
      add_differences(at_or_null(first, pointer), at_or_null(second, pointer),
                      place + pointer.to_string(), differences);
    }
    return;
  }
  differences.push_back({place, first, second});
}

std::vector<Difference> input_differences(const OlderRun& first, const OlderRun& second) {
  std::vector<Difference> differences;
  const auto compare = [&](const char* key, const std::string& place) {
    add_differences(first.card.value(key, Json()), second.card.value(key, Json()), place,
                    differences);
  };
  compare("command", "command");
  compare("problem", "");
  compare("options", "options");
  compare("versions", "versions");
  return differences;
}

constexpr std::size_t widest = 32;  ///< characters of an input that are shown

/// The end of what is too long is left out, at the beginning of a character.
std::string value_text(const Json& value) {
  if (value.is_null()) return "–";
  std::string text = value.is_string() ? value.get<std::string>() : value.dump();
  if (characters(text) <= widest) return text;
  while (characters(text) > widest - 1) text.pop_back();
  return text + "…";
}

std::string inputs_text(const std::vector<Difference>& differences) {
  if (differences.empty()) return "The inputs are the same.\n";
  Table table({{"input", Table::Align::left},
               {"first", Table::Align::left},
               {"second", Table::Align::left}});
  for (const Difference& one : differences) {
    table.add_row({one.place, value_text(one.first), value_text(one.second)});
  }
  return table.text();
}

/// A number that both results have, or one of them.
struct Compared {
  std::string group, name, unit;
  Json first, second;

  bool has_both() const { return first.is_number() && second.is_number(); }
  double change() const { return second.get<double>() - first.get<double>(); }
};

/// The values of {NAME: {"value", "unit"}} in both results.
void add_values(const OlderRun& first, const OlderRun& second, const std::string& group,
                std::vector<Compared>& compared) {
  const auto part = [&](const OlderRun& run) {
    const Json values = run.result.is_object() ? run.result.value(group, Json()) : Json();
    return values.is_object() ? values : Json::object();
  };
  const Json one = part(first), other = part(second);
  Json all = one;
  all.update(other);
  for (const auto& [name, unused] : all.items()) {
    const auto value_of = [&](const Json& values, const char* key) {
      const Json value = values.value(name, Json());
      return value.is_object() ? value.value(key, Json()) : Json();
    };
    const Json unit = value_of(one.contains(name) ? one : other, "unit");
    const Json a = value_of(one, "value"), b = value_of(other, "value");
    if (!a.is_number() && !b.is_number()) continue;
    compared.push_back({group, name, unit.is_string() ? unit.get<std::string>() : "", a, b});
  }
}

std::vector<Compared> outcome_values(const OlderRun& first, const OlderRun& second) {
  std::vector<Compared> compared;
  for (const char* group : {"variables", "constraints", "responses"}) {
    add_values(first, second, group, compared);
  }
  const auto add = [&](const char* name, const Json& a, const Json& b) {
    if (a.is_number() || b.is_number()) compared.push_back({"effort", name, "", a, b});
  };
  const auto of = [](const OlderRun& run, const char* key) {
    return run.result.is_object() ? run.result.value(key, Json()) : Json();
  };
  for (const char* key : {"evaluations", "iterations", "kkt_residual", "max_violation"}) {
    add(key, of(first, key), of(second, key));
  }
  const auto seconds = [](const OlderRun& run) {
    return run.seconds() ? Json(*run.seconds()) : Json();
  };
  add("seconds", seconds(first), seconds(second));
  return compared;
}

std::string change_text(const Compared& value) {
  if (!value.has_both()) return "";
  const double before = value.first.get<double>();
  if (value.change() == 0.0) return "0";
  if (before == 0.0) return "";
  return signed_percent(value.change() / std::abs(before));
}

std::string outcomes_text(const OlderRun& first, const OlderRun& second,
                          const std::vector<Compared>& values) {
  Table table({{"outcome", Table::Align::left},
               {"", Table::Align::left},
               {"first"},
               {"second"},
               {"change"}},
              2);
  table.add_row({"status", "", first.status(), second.status(), ""});
  const auto number = [](const Json& value) {
    if (value.is_number_integer()) return value.dump();
    return value.is_number() ? significant(value.get<double>(), 6) : "–";
  };
  for (const Compared& value : values) {
    table.add_row({value.group,
                   value.unit.empty() ? value.name : fmt::format("{} [{}]", value.name, value.unit),
                   number(value.first), number(value.second), change_text(value)});
  }
  return table.text();
}

}  // namespace

Outcome run_compare(const Arguments& arguments) {
  if (arguments.files.size() != 2) {
    throw InputError(fmt::format("two run folders are compared, got {}", arguments.files.size()));
  }
  const OlderRun first = read_older_run(arguments.files[0]);
  const OlderRun second = read_older_run(arguments.files[1]);
  const std::vector<Difference> inputs = input_differences(first, second);
  const std::vector<Compared> values = outcome_values(first, second);
  Outcome outcome;
  Json& document = outcome.document;
  document = {{"input", Json::array()},
              {"status", {first.status(), second.status()}},
              {"outcome", Json::array()}};
  for (const Difference& one : inputs) {
    document["input"].push_back(
        {{"place", one.place}, {"first", one.first}, {"second", one.second}});
  }
  for (const Compared& one : values) {
    document["outcome"].push_back({{"group", one.group},
                                   {"name", one.name},
                                   {"unit", one.unit},
                                   {"first", one.first},
                                   {"second", one.second}});
  }
  outcome.text =
      fmt::format("first: {}, second: {}\n\n{}\n{}", first.folder.string(), second.folder.string(),
                  inputs_text(inputs), outcomes_text(first, second, values));
  return outcome;
}

}  // namespace pleuel
