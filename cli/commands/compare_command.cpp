#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "cli/commands/commands.hpp"
#include "cli/commands/older_picture.hpp"
#include "cli/files/older_run.hpp"
#include "cli/files/output_file.hpp"
#include "cli/files/report_page.hpp"
#include "cli/files/run_folder.hpp"
#include "cli/reports/document_table.hpp"
#include "cli/text/wrapped_text.hpp"
#include "core/base/error.hpp"
#include "core/base/number_text.hpp"
#include "core/scene/problem_reader.hpp"
#include "core/scene/shown_unit.hpp"

/// What differs between two runs, in what went in and in what came out.
namespace pleuel {

namespace {

Json at_or_null(const Json& document, const Json::json_pointer& place) {
  return document.contains(place) ? document.at(place) : Json();
}

/// [{"place", "first", "second"}], null where it is missing: single values wherever both have them;
/// what only one has, as a whole. The order of keys is no difference.
void add_differences(const Json& first, const Json& second, const std::string& place,
                     Json& differences) {
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
  differences.push_back({{"place", place}, {"first", first}, {"second", second}});
}

Json input_differences(const OlderRun& first, const OlderRun& second) {
  Json differences = Json::array();
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

std::string value_text(const Json& value, std::size_t widest) {
  if (value.is_null()) return "–";
  return shortened(value.is_string() ? value.get<std::string>() : value.dump(), widest);
}

/// Both problems have the same keys and values.
std::string same_inputs_text(const OlderRun& first, const OlderRun& second) {
  const auto place =
      first_reordered(first.card.value("problem", Json()), second.card.value("problem", Json()));
  if (!place) return "The inputs are the same.\n";
  return fmt::format("The inputs are the same, but the keys of {} stand in another order.\n",
                     place->empty() ? "the file" : *place);
}

std::string inputs_text(const Json& differences) {
  constexpr std::size_t narrowest = 20, gaps = 6;
  std::size_t places = 0;
  for (const Json& one : differences) places = std::max(places, characters(text_at(one, "/place")));
  const std::size_t room = line_width() - std::min(line_width(), places + gaps);
  const auto value_column = [&](const std::string& key) {
    const auto text = [=](const std::string&, const Json& one) {
      return value_text(one.at(key), std::max(narrowest, room / 2));
    };
    return DocumentColumn{key, text, Table::Align::left};
  };
  return table_of(differences,
                  {text_column("input", "/place"), value_column("first"), value_column("second")})
      .text();
}

/// In which units the first run, or else the second, was asked for its numbers, by groups.
using Units = std::map<std::string, NamedUnits>;

/// A file that cannot be read any more, as where its catalogue is gone, has no units.
void add_units(const OlderRun& run, Units& units) try {
  const Json input = run.card.value("input", Json::object());
  const ProblemFile problem =
      read_problem_text(run.card.at("problem").dump(), input.value("file", ""), {}).complete();
  units["variables"].merge(units_of_variables(problem));
  units["responses"].merge(units_of_responses(problem));
  units["constraints"].merge(units_of_limits(problem));
} catch (const std::exception&) {
}

/// Of a number that both results have, or one of them.
ShownUnit unit_in(const Units& units, const Json& compared) {
  const std::string group = text_at(compared, "/group"), si = text_at(compared, "/unit");
  const auto of_group = units.find(group == "points" ? "responses" : group);
  if (group == "effort") return {};
  if (of_group == units.end()) return engineering_unit(si);
  const auto known = of_group->second.find(text_at(compared, "/name"));
  const bool fits =
      known != of_group->second.end() && (known->second.si == si || group == "variables");
  return fits ? known->second : engineering_unit(si);
}

/// An entry of "outcome": a number that both results have, or one of them [SI].
/// @param of  what of it, if that is not its value; of points their number
Json compared(const std::string& group, const std::string& name, const std::string& of,
              const std::string& unit, const Json& first, const Json& second) {
  Json entry = {{"group", group}, {"name", name}};
  if (!of.empty()) entry["of"] = of;
  entry.update({{"unit", unit}, {"first", first}, {"second", second}});
  return entry;
}

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
                Json& outcome) {
  constexpr ComparedKey keys[] = {{"value", ""}, {"deviation", "deviation"}};
  const Json one = part_of(first, group), other = part_of(second, group);
  Json all = one;
  all.update(other);
  for (const auto& [name, entry] : all.items()) {
    const Json& shown = one.contains(name) ? one[name] : entry;
    for (const auto& [key, title] : keys) {
      const Json a = member(one, name, key), b = member(other, name, key);
      if (!a.is_number() && !b.is_number()) continue;
      outcome.push_back(compared(group, name, title, text_at(shown, "/unit"), a, b));
    }
  }
}

/// What one percent more of each number changes of the optimum.
void add_prices(const OlderRun& first, const OlderRun& second, Json& outcome) {
  const Json one = part_of(first, "prices"), other = part_of(second, "prices");
  if (one.empty() || other.empty()) return;
  const Json objective = part_of(first, "objective"), of_other = part_of(second, "objective");
  if (objective.value("name", Json()) != of_other.value("name", Json())) return;
  const std::string unit = objective.value("unit", "");
  outcome.push_back(compared("objective", objective.value("name", ""), "", unit,
                             objective.value("value", Json()), of_other.value("value", Json())));
  for (const auto& [name, price] : one.items()) {
    const Json a = member(one, name, "per_percent"), b = member(other, name, "per_percent");
    if (!a.is_number() || !b.is_number() || (a == 0.0 && b == 0.0)) continue;
    outcome.push_back(compared("prices", name, "at +1 %", unit, a, b));
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
void add_points(const OlderRun& first, const OlderRun& second, Json& outcome) {
  const auto points_of = [](const OlderRun& run) {
    const Json points = run.result.is_object() ? run.result.value("points", Json()) : Json();
    return points.is_array() ? points : Json::array();
  };
  const Json one = points_of(first), other = points_of(second), units = part_of(first, "units");
  if (one.empty() || other.empty() || units != part_of(second, "units")) return;
  if (first.result.value("constraint", Json()) != second.result.value("constraint", Json())) return;
  outcome.push_back(compared("points", "number", "", "", one.size(), other.size()));
  for (std::size_t i = 0; i < one.size(); ++i) {
    const Json found = point_at(other, one[i].value("limit", Json()));
    if (!found.is_object()) continue;
    const Json here = one[i].value("objectives", Json::object());
    const Json there = found.value("objectives", Json::object());
    for (const auto& [name, value] : here.items()) {
      outcome.push_back(compared("points", name, std::to_string(i + 1), units.value(name, ""),
                                 value, there.value(name, Json())));
    }
  }
}

Json outcome_values(const OlderRun& first, const OlderRun& second) {
  Json outcome = Json::array();
  for (const char* group : {"variables", "constraints", "responses"}) {
    add_values(first, second, group, outcome);
  }
  add_prices(first, second, outcome);
  add_points(first, second, outcome);
  const auto add = [&](const char* name, const Json& a, const Json& b) {
    if (a.is_number() || b.is_number()) outcome.push_back(compared("effort", name, "", "", a, b));
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
  return outcome;
}

/// Numbers that say whether something went well, and not how much of it there is.
bool is_residual(const std::string& name) {
  return name == "kkt_residual" || name == "max_violation";
}

/// What of a limit of zero round-off leaves is zero.
double shown_value(const Json& value, const ShownUnit& unit) {
  constexpr double round_off = 1e-9;
  const double shown = unit.shown(value.get<double>());
  return std::abs(shown) < round_off ? 0.0 : shown;
}

std::string number_text(const std::string& name, const Json& value, const ShownUnit& unit) {
  if (!value.is_number()) return "–";
  if (is_residual(name)) return magnitude(value.get<double>());
  if (name == "seconds") return duration(value.get<double>());
  if (value.is_number_integer()) return value.dump();
  return significant(shown_value(value, unit), 6);
}

/// "+2.1 %"; nothing of numbers whose ratio says nothing.
std::string change_text(const Json& value, const ShownUnit& unit) {
  constexpr double hardly = 1e-4;  // two searches for the same optimum differ by that
  const Json &first = value["first"], &second = value["second"];
  if (!first.is_number() || !second.is_number() || is_residual(value["name"])) return "";
  const double before = shown_value(first, unit), after = shown_value(second, unit);
  if (before == after) return "same";
  if (before == 0.0) return "";
  const double share = (after - before) / std::abs(before);
  if (std::abs(share) < hardly) return "< 0.01 %";
  return signed_significant(100.0 * share, 3) + " %";
}

std::string outcomes_text(const OlderRun& first, const OlderRun& second, const Json& values) {
  Table table({left_aligned("outcome"), left_aligned("name"), "first", "second",
               left_aligned("unit"), "change"},
              2);
  table.add_row({"status", "–", first.status(), second.status(), "–", ""});
  Units units;
  add_units(first, units);
  add_units(second, units);
  for (const Json& value : values) {
    const std::string name = value["name"], of = text_at(value, "/of");
    const ShownUnit unit = unit_in(units, value);
    table.add_row(
        {text_at(value, "/group"), of.empty() ? name : name + ", " + of,
         number_text(name, value["first"], unit), number_text(name, value["second"], unit),
         unit.name.empty() || unit.name == "1" ? "–" : unit.name, change_text(value, unit)});
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
  const Json inputs = input_differences(first, second), values = outcome_values(first, second);
  Outcome outcome;
  outcome.document = {
      {"input", inputs}, {"status", {first.status(), second.status()}}, {"outcome", values}};
  outcome.text =
      fmt::format("first: {}, second: {}\n\n{}\n{}", first.folder.string(), second.folder.string(),
                  inputs.empty() ? same_inputs_text(first, second) : inputs_text(inputs),
                  outcomes_text(first, second, values));
  write_page(arguments, first, second, outcome);
  return outcome;
}

}  // namespace pleuel
