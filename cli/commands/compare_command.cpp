#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cli/commands/commands.hpp"
#include "cli/commands/older_picture.hpp"
#include "cli/files/older_run.hpp"
#include "cli/files/output_file.hpp"
#include "cli/files/report_page.hpp"
#include "cli/files/run_folder.hpp"
#include "cli/text/characters.hpp"
#include "cli/text/table.hpp"
#include "cli/text/wrapped_text.hpp"
#include "core/base/error.hpp"
#include "core/base/number_text.hpp"
#include "core/scene/problem_reader.hpp"
#include "core/scene/shown_unit.hpp"

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

/// Single values wherever both have them; what only one has, as a whole. The order of keys is no
/// difference.
void add_differences(const Json& first, const Json& second, const std::string& place,
                     std::vector<Difference>& differences) {
  if (nlohmann::json(first) == nlohmann::json(second)) return;
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

/// The end of what is too long is left out, at the beginning of a character.
std::string value_text(const Json& value, std::size_t widest) {
  if (value.is_null()) return "–";
  std::string text = value.is_string() ? value.get<std::string>() : value.dump();
  if (characters(text) <= widest) return text;
  while (characters(text) > widest - 1) text.pop_back();
  return text + "…";
}

/// Both problems have the same keys and values.
std::string same_inputs_text(const OlderRun& first, const OlderRun& second) {
  const auto place =
      first_reordered(first.card.value("problem", Json()), second.card.value("problem", Json()));
  if (!place) return "The inputs are the same.\n";
  return fmt::format("The inputs are the same, but the keys of {} stand in another order.\n",
                     place->empty() ? "the file" : *place);
}

std::string inputs_text(const std::vector<Difference>& differences) {
  constexpr std::size_t narrowest = 20, gaps = 6;
  Table table({{"input", Table::Align::left},
               {"first", Table::Align::left},
               {"second", Table::Align::left}});
  std::size_t places = 0;
  for (const Difference& one : differences) places = std::max(places, characters(one.place));
  const std::size_t room = line_width() - std::min(line_width(), places + gaps);
  const std::size_t widest = std::max(narrowest, room / 2);
  for (const Difference& one : differences) {
    table.add_row({one.place, value_text(one.first, widest), value_text(one.second, widest)});
  }
  return table.text();
}

/// A number that both results have, or one of them.
struct Compared {
  std::string group, name, unit;  ///< SI
  Json first, second;
  std::string title;  ///< what of it, if that is not its value; of points their number

  bool has_both() const { return first.is_number() && second.is_number(); }
  std::string shown_name() const { return title.empty() ? name : name + ", " + title; }
};

/// In which units the first run, or else the second, was asked for its numbers.
class Units {
 public:
  Units(const OlderRun& first, const OlderRun& second) {
    add(second);
    add(first);
  }

  ShownUnit of(const Compared& value) const {
    const auto known =
        units_.find({value.group == "points" ? "responses" : value.group, value.name});
    const bool fits =
        known != units_.end() && (known->second.si == value.unit || value.group == "variables");
    return fits ? known->second : engineering_unit(value.unit);
  }

 private:
  /// A file that cannot be read any more, as where its catalogue is gone, has no units.
  void add(const OlderRun& run) try {
    const Json input = run.card.value("input", Json::object());
    const ProblemFile problem =
        read_problem_text(run.card.at("problem").dump(), input.value("file", ""), {}).complete();
    const std::vector<ShownUnit> units = variable_units(problem);
    for (std::size_t i = 0; i < units.size(); ++i) {
      units_[{"variables", problem.variables[i].name}] = units[i];
    }
    for (const auto& one : problem.responses) units_[{"responses", one.name}] = unit_of(one);
    for (const auto& one : problem.constraints) {
      units_[{"constraints", one.name}] = unit_of(problem, one);
    }
  } catch (const std::exception&) {
  }

  std::map<std::pair<std::string, std::string>, ShownUnit> units_;
};

/// A part of a result, by name; nothing where it is not there.
Json part_of(const OlderRun& run, const std::string& name) {
  const Json part = run.result.is_object() ? run.result.value(name, Json()) : Json();
  return part.is_object() ? part : Json::object();
}

Json member(const Json& values, const std::string& name, const char* key) {
  const Json value = values.value(name, Json());
  return value.is_object() ? value.value(key, Json()) : Json();
}

/// What there is of each name of a group, which has one unit: a key of its entry in the results,
/// and what it is called.
struct ComparedKey {
  const char* key;
  const char* title;
};

/// The numbers of {NAME: {"value", "deviation", "unit"}} in both results.
void add_values(const OlderRun& first, const OlderRun& second, const std::string& group,
                std::vector<Compared>& compared) {
  constexpr ComparedKey keys[] = {{"value", ""}, {"deviation", "deviation"}};
  const Json one = part_of(first, group), other = part_of(second, group);
  Json all = one;
  all.update(other);
  for (const auto& entry : all.items()) {
    const std::string& name = entry.key();
    const Json unit = member(one.contains(name) ? one : other, name, "unit");
    for (const auto& [key, title] : keys) {
      const Json a = member(one, name, key), b = member(other, name, key);
      if (!a.is_number() && !b.is_number()) continue;
      compared.push_back(
          {group, name, unit.is_string() ? unit.get<std::string>() : "", a, b, title});
    }
  }
}

/// What one percent more of each number changes of the optimum.
void add_prices(const OlderRun& first, const OlderRun& second, std::vector<Compared>& compared) {
  const Json one = part_of(first, "prices"), other = part_of(second, "prices");
  if (one.empty() || other.empty()) return;
  const Json objective = part_of(first, "objective"), of_other = part_of(second, "objective");
  if (objective.value("name", Json()) != of_other.value("name", Json())) return;
  const std::string unit = objective.value("unit", "");
  compared.push_back({"objective", objective.value("name", ""), unit,
                      objective.value("value", Json()), of_other.value("value", Json()), ""});
  for (const auto& entry : one.items()) {
    const Json a = member(one, entry.key(), "per_percent");
    const Json b = member(other, entry.key(), "per_percent");
    if (!a.is_number() || !b.is_number() || (a == 0.0 && b == 0.0)) continue;
    compared.push_back({"prices", entry.key(), unit, a, b, "at +1 %"});
  }
}

/// The point of a front with this limit; nothing if there is none.
Json point_at(const Json& points, const Json& limit) {
  constexpr double same = 1e-9;
  for (const Json& point : points) {
    const Json other = point.value("limit", Json());
    if (!limit.is_number() || !other.is_number()) continue;
    const double a = limit.get<double>(), b = other.get<double>();
    if (std::abs(a - b) <= same * std::max(std::abs(a), std::abs(b))) return point;
  }
  return {};
}

/// Points of fronts of the same limit, those with the same bound, by their number in the first.
void add_points(const OlderRun& first, const OlderRun& second, std::vector<Compared>& compared) {
  const auto points_of = [](const OlderRun& run) {
    const Json points = run.result.is_object() ? run.result.value("points", Json()) : Json();
    return points.is_array() ? points : Json::array();
  };
  const Json one = points_of(first), other = points_of(second), units = part_of(first, "units");
  if (one.empty() || other.empty() || units != part_of(second, "units")) return;
  if (first.result.value("constraint", Json()) != second.result.value("constraint", Json())) return;
  compared.push_back({"points", "number", "", one.size(), other.size(), ""});
  for (std::size_t i = 0; i < one.size(); ++i) {
    const Json found = point_at(other, one[i].value("limit", Json()));
    if (!found.is_object()) continue;
    const Json here = one[i].value("objectives", Json::object());
    const Json there = found.value("objectives", Json::object());
    for (const auto& entry : here.items()) {
      const Json unit = units.value(entry.key(), Json());
      compared.push_back({"points", entry.key(), unit.is_string() ? unit.get<std::string>() : "",
                          entry.value(), there.value(entry.key(), Json()),
                          fmt::format("{}", i + 1)});
    }
  }
}

std::vector<Compared> outcome_values(const OlderRun& first, const OlderRun& second) {
  std::vector<Compared> compared;
  for (const char* group : {"variables", "constraints", "responses"}) {
    add_values(first, second, group, compared);
  }
  add_prices(first, second, compared);
  add_points(first, second, compared);
  const auto add = [&](const char* name, const Json& a, const Json& b) {
    if (a.is_number() || b.is_number()) compared.push_back({"effort", name, "", a, b, ""});
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

/// Numbers that say whether something went well, and not how much of it there is.
bool is_residual(const Compared& value) {
  return value.name == "kkt_residual" || value.name == "max_violation";
}

/// What of a limit of zero round-off leaves is zero.
double shown_value(const Json& value, const ShownUnit& unit) {
  constexpr double round_off = 1e-9;
  const double shown = unit.shown(value.get<double>());
  return std::abs(shown) < round_off ? 0.0 : shown;
}

std::string number_text(const Compared& compared, const Json& value, const ShownUnit& unit) {
  if (!value.is_number()) return "–";
  if (is_residual(compared)) return magnitude(value.get<double>());
  if (compared.name == "seconds") return duration(value.get<double>());
  if (value.is_number_integer()) return value.dump();
  return significant(shown_value(value, unit), 6);
}

/// "+2.1 %"; nothing of numbers whose ratio says nothing.
std::string change_text(const Compared& value, const ShownUnit& unit) {
  constexpr double hardly = 1e-4;  // two searches for the same optimum differ by that
  if (!value.has_both() || is_residual(value)) return "";
  const double before = shown_value(value.first, unit), after = shown_value(value.second, unit);
  if (before == after) return "same";
  if (before == 0.0) return "";
  const double share = (after - before) / std::abs(before);
  if (std::abs(share) < hardly) return "< 0.01 %";
  return signed_significant(100.0 * share, 3) + " %";
}

std::string outcomes_text(const OlderRun& first, const OlderRun& second,
                          const std::vector<Compared>& values) {
  Table table({{"outcome", Table::Align::left},
               {"name", Table::Align::left},
               {"first"},
               {"second"},
               {"unit", Table::Align::left},
               {"change"}},
              2);
  table.add_row({"status", "–", first.status(), second.status(), "–", ""});
  const Units units(first, second);
  for (const Compared& value : values) {
    const bool is_effort = value.group == "effort";
    const ShownUnit unit = is_effort ? ShownUnit{} : units.of(value);
    table.add_row({value.group, value.shown_name(), number_text(value, value.first, unit),
                   number_text(value, value.second, unit),
                   unit.name.empty() || unit.name == "1" ? "–" : unit.name,
                   change_text(value, unit)});
  }
  return table.text();
}

/// The last design of each run, which the page lets move together.
Json both_pictures(const OlderRun& first, const OlderRun& second, Notes& notes) {
  Json picture = picture_of_run(first.card, first.result, first.folder, notes);
  Json other = picture_of_run(second.card, second.result, second.folder, notes);
  if (picture.is_object() && other.is_object()) picture["compared"] = std::move(other);
  return picture;
}

Json compared_run(const OlderRun& run) {
  Json document = {{"folder", run.folder.string()},
                   {"command", run.command()},
                   {"problem", run.problem()},
                   {"status", run.status()}};
  if (run.objective()) document["objective"] = run.result.at("objective");
  return document;
}

/// A page of both, where pages can be made.
void write_page(const Arguments& arguments, const OlderRun& first, const OlderRun& second,
                Outcome& outcome) {
  const auto page_template = find_report_template();
  if (!page_template) return;
  Json picture, result = outcome.document;
  Notes notes;
  try {
    picture = both_pictures(first, second, notes);
  } catch (const std::exception& error) {
    outcome.text +=
        wrapped(fmt::format("Note: the mechanisms are not shown: {}\n", error.what()), "  ");
  }
  result["runs"] = {compared_run(first), compared_run(second)};
  const Json card = {{"command", "compare"},
                     {"arguments", arguments.words},
                     {"problem", second.card.value("problem", Json())},
                     {"input", {{"file", first.folder.string() + ", " + second.folder.string()}}}};
  const std::filesystem::path page = arguments.output.value_or(free_page("compare"));
  make_folder_of(page);
  WriteFailures failures;
  if (write_file({page, &failures},
                 report_page(*page_template, report_data(card, result, picture, "")))) {
    outcome.document["page"] = page.string();
    outcome.text += fmt::format("\nDrawn in {}\n", page.string());
  }
  outcome.unwritten = failures.files();
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
    Json entry = {{"group", one.group}, {"name", one.name}};
    if (!one.title.empty()) entry["of"] = one.title;
    entry.update({{"unit", one.unit}, {"first", one.first}, {"second", one.second}});
    document["outcome"].push_back(std::move(entry));
  }
  outcome.text =
      fmt::format("first: {}, second: {}\n\n{}\n{}", first.folder.string(), second.folder.string(),
                  inputs.empty() ? same_inputs_text(first, second) : inputs_text(inputs),
                  outcomes_text(first, second, values));
  write_page(arguments, first, second, outcome);
  return outcome;
}

}  // namespace pleuel
