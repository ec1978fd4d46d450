
#include "cli/commands/commands.hpp"
#include "cli/files/report_page.hpp"
#include "cli/files/run_folder.hpp"

/// What differs between two runs, in what went in and in what came out.
namespace pleuel {

namespace {

/// [{"place", "first", "second"}], null where it is missing: single values wherever both have them;
/// what only one has, as a whole. The order of keys is no difference.
void add_differences(const Json& first, const Json& second, const std::string& place,
                     Json& differences) {
  if (nlohmann::json(first) == nlohmann::json(second)) return;
  if (first.is_object() && second.is_object()) {
    Json all = first;
    all.update(second);
    for (const auto& [key, unused] : all.items()) {
      add_differences(first.value(key, Json()), second.value(key, Json()),
                      place + (Json::json_pointer() / key).to_string(), differences);
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

void add_units(const OlderRun& run, Units& units) {
  const std::optional<ProblemFile> problem = problem_on_card(run.folder);
  if (!problem) return;
  units["variables"].merge(units_of_variables(*problem));
  units["responses"].merge(units_of_responses(*problem));
  units["constraints"].merge(units_of_limits(*problem));
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

/// A part of a result, by name; empty where it is not there.
Json part_of(const OlderRun& run, const std::string& name) {
  const Json part = run.result.is_object() ? run.result.value(name, Json()) : Json();
  return part.is_structured() ? part : Json::object();
}

/// The numbers of one side of the comparison [SI]: {GROUP: {KEY: entry}}. What has the same key in
/// both results is the same number.
class Side {
 public:
  /// @param name    "first" or "second"
  /// @param groups  that the numbers go into, beside those of the other side
  Side(const OlderRun& run, const char* name, Json& groups)
      : run_(run), name_(name), groups_(groups) {
    for (const char* group : {"variables", "constraints", "responses"}) add_values(group);
    add_prices();
    add_points();
    for (const char* key : {"evaluations", "iterations", "kkt_residual", "max_violation"}) {
      add({{"group", "effort"}, {"name", key}, {"unit", ""}}, run.result, key);
    }
    add({{"group", "effort"}, {"name", "seconds"}, {"unit", ""}}, run.card.value("seconds", Json()),
        "total");
  }

 private:
  /// The number that stands there in a document, if there is one.
  /// @param entry  {"group", "name", "of": what of it, if that is not its value; of points their
  ///               number, "unit"}
  void add(Json entry, const Json& document, const std::string& key, const std::string& same = "") {
    const Json value = document.is_object() ? document.value(key, Json()) : Json();
    if (!value.is_number()) return;
    const std::string of = same.empty() ? text_at(entry, "/of") : same;
    Json& known = groups_[text_at(entry, "/group")][text_at(entry, "/name") + "\n" + of];
    if (known.is_null()) {
      entry.update({{"first", nullptr}, {"second", nullptr}});
      known = std::move(entry);
    }
    known[name_] = value;
  }

  /// Of {NAME: {"value", "deviation", "unit"}}.
  void add_values(const char* group) {
    const Json entries = part_of(run_, group);
    for (const auto& [name, entry] : entries.items()) {
      const std::string unit = text_at(entry, "/unit");
      add({{"group", group}, {"name", name}, {"unit", unit}}, entry, "value");
      add({{"group", group}, {"name", name}, {"of", "deviation"}, {"unit", unit}}, entry,
          "deviation");
    }
  }

  /// What one percent more of each number changes of the optimum.
  void add_prices() {
    const Json prices = part_of(run_, "prices"), objective = part_of(run_, "objective");
    if (prices.empty()) return;
    const std::string optimum = text_at(objective, "/name"), unit = text_at(objective, "/unit");
    add({{"group", "objective"}, {"name", optimum}, {"unit", unit}}, objective, "value");
    for (const auto& [name, price] : prices.items()) {
      add({{"group", "prices"}, {"name", name}, {"of", "at +1 %"}, {"unit", unit}}, price,
          "per_percent", optimum);
    }
  }

  /// Points of fronts are the same at the same limit, to nine digits.
  void add_points() {
    const Json points = part_of(run_, "points"), units = part_of(run_, "units");
    if (!points.is_array() || points.empty()) return;
    const std::string front = text_at(run_.result, "/constraint") + units.dump();
    add({{"group", "points"}, {"name", "number"}, {"unit", ""}}, {{"size", points.size()}}, "size",
        front);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto limit = number_at(points[i], "/limit");
      if (!limit) continue;
      const Json objectives = points[i].value("objectives", Json::object());
      for (const auto& [name, value] : objectives.items()) {
        add({{"group", "points"},
             {"name", name},
             {"of", std::to_string(i + 1)},
             {"unit", units.value(name, "")}},
            objectives, name, fmt::format("{}{:.8e}", front, *limit));
      }
    }
  }

  const OlderRun& run_;
  const char* name_;
  Json& groups_;
};

/// What both results have, or one of them; of prices and fronts what both have.
Json outcome_values(const OlderRun& first, const OlderRun& second) {
  Json groups, outcome = Json::array();
  for (const char* group :
       {"variables", "constraints", "responses", "objective", "prices", "points", "effort"}) {
    groups[group] = Json::object();
  }
  Side(first, "first", groups);
  Side(second, "second", groups);
  for (const auto& [group, entries] : groups.items()) {
    const bool takes_both = group == "objective" || group == "prices" || group == "points";
    for (const Json& entry : entries) {
      const Json &a = entry["first"], &b = entry["second"];
      const bool is_free = group == "prices" && a == 0.0 && b == 0.0;
      if (is_free || (takes_both && (a.is_null() || b.is_null()))) continue;
      outcome.push_back(entry);
    }
  }
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
  Json picture = picture_of_run(first, notes);
  Json other = picture_of_run(second, notes);
  if (picture.is_object() && other.is_object()) picture["compared"] = std::move(other);
  return picture;
}

Json compared_run(const OlderRun& run) {
  Json document = summary_of(run);
  if (run.objective()) document["objective"] = run.result.at("objective");
  return document;
}

/// A page of both, where pages can be made.
void draw_both(const Arguments& arguments, const OlderRun& first, const OlderRun& second,
               Outcome& outcome) {
  if (!find_report_template()) return;
  Json picture, result = outcome.document;
  Notes notes;
  try {
    for (const OlderRun* run : {&first, &second}) {
      if (const std::string damage = damage_of(*run); !damage.empty()) throw InputError(damage);
    }
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
  outcome.text += "\n";
  draw_page(arguments.output.value_or(free_page("compare")), report_data(card, result, picture),
            outcome);
}

}  // namespace

Outcome run_compare(const Arguments& arguments) {
  if (arguments.files.size() != 2) {
    throw InputError(fmt::format("two run folders are compared, got {}", arguments.files.size()));
  }
  if (arguments.output) require_free(*arguments.output, arguments);
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
  draw_both(arguments, first, second, outcome);
  return outcome;
}

}  // namespace pleuel
