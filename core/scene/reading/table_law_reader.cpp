#include "core/scene/reading/table_law_reader.hpp"

#include <utility>

#include <fmt/format.h>

#include "core/scene/reading/csv_table.hpp"

namespace pleuel {
namespace {

/// What a table is a function of, and the key of its list.
struct TableArgument {
  LawArgument argument = LawArgument::time;
  std::string_view name, list;
  Quantity quantity;
};

std::vector<TableArgument> arguments_of(const LawSource& source) {
  std::vector<TableArgument> all = {{LawArgument::time, "time", "times", quantities::time}};
  if (!source.state) return all;
  const StateNames& state = *source.state;
  all.push_back(
      {LawArgument::coordinate, state.coordinate, state.coordinates, state.coordinate_quantity});
  all.push_back({LawArgument::rate, "speed", "speeds", state.rate_quantity});
  return all;
}

/// By the list that the table has, or, of a file, by the key "over".
TableArgument find_argument(const LawSource& source, const std::vector<TableArgument>& all) {
  for (const TableArgument& one : all) {
    if (source.node.find(std::string(one.list))) return one;
  }
  const bool is_given = source.node.find("over").has_value();
  if (!source.node.find("file") || (all.size() == 1 && !is_given)) return all.front();
  const JsonNode over = source.node.at("over");
  std::vector<std::string> words;
  for (const TableArgument& one : all) {
    if (over.value() == one.name) return one;
    words.emplace_back(one.name);
  }
  fail_choice(over, words);
}

std::vector<double> read_ascending(const JsonNode& node, const TableArgument& argument,
                                   const NumberReader& numbers) {
  const bool is_time = argument.argument == LawArgument::time;
  std::vector<double> points;
  for (const JsonNode& item : node.items()) {
    const double point = numbers.fixed(item, argument.quantity);
    if (!points.empty() && point <= points.back()) {
      item.fail_with_value(is_time ? "must be later than the time before it"
                                   : "must be larger than what is before it");
    }
    points.push_back(point);
  }
  if (points.size() < 2) {
    node.fail_with_value(fmt::format("must have at least two {}", argument.list));
  }
  return points;
}

void read_points(const LawSource& source, const TableArgument& argument, NumberReader& numbers,
                 TableFunction& table) {
  if (!source.node.find("file")) {
    table.times = read_ascending(source.node.at(std::string(argument.list)), argument, numbers);
    for (const JsonNode& value : source.node.at("values").items(table.times.size())) {
      table.values.push_back(numbers.designable(value, source.value));
    }
    return;
  }
  TableColumns columns =
      read_table_file(source.node, {argument.quantity, source.value}, numbers.units());
  table.times = std::move(columns.arguments);
  table.values.assign(columns.values.begin(), columns.values.end());
}

Interpolation read_interpolation(const JsonNode& node, LawPurpose purpose, LawArgument argument) {
  if (purpose == LawPurpose::load && argument == LawArgument::time) {
    return read_choice<Interpolation>(node, {{"linear", Interpolation::linear},
                                             {"step", Interpolation::step},
                                             {"monotone", Interpolation::monotone},
                                             {"spline", Interpolation::spline}});
  }
  if (node.value() == "step") {
    node.fail_with_value(
        purpose == LawPurpose::drive
            ? "would move a drive in no time; take \"monotone\", \"spline\" or \"linear\""
            : "is for tables over time: a force that jumps with the motion has no tangent; take "
              "\"monotone\", \"spline\" or \"linear\"");
  }
  return read_choice<Interpolation>(node, {{"monotone", Interpolation::monotone},
                                           {"spline", Interpolation::spline},
                                           {"linear", Interpolation::linear}});
}

bool are_same(const Number& one, const Number& other) {
  return one.constant == other.constant && one.variable == other.variable &&
         one.factor == other.factor &&
         (one.expression == other.expression ||
          (one.expression && other.expression && one.expression->text == other.expression->text));
}

/// A period that is longer than the table goes back to its first value at the end.
void read_table_period(const JsonNode& node, const TableArgument& argument,
                       const NumberReader& numbers, TableFunction& table) {
  constexpr double rounding = 1e-9;
  const double period = numbers.fixed(node, argument.quantity, Range::positive);
  const double span = table.times.back() - table.times.front();
  if (period < span * (1.0 - rounding)) {
    node.fail_with_value(fmt::format("must be at least what the table covers, {:g} {}", span,
                                     argument.quantity.unit));
  }
  table.repetition = Repetition::periodic;
  if (period > span * (1.0 + rounding)) {
    table.times.push_back(table.times.front() + period);
    table.values.push_back(table.values.front());
  } else if (!are_same(table.values.front(), table.values.back())) {
    node.fail(
        "needs a last value that is the first, as it is the same point; or leave out the last "
        "point of the table");
  }
}

}  // namespace

TableFunction read_table(const LawSource& source, NumberReader& numbers) {
  const std::vector<TableArgument> arguments = arguments_of(source);
  const bool has_file = source.node.find("file").has_value();
  const TableArgument argument = find_argument(source, arguments);
  std::vector<std::string_view> keys = {"interpolation", "period"};
  if (has_file) {
    keys.insert(keys.end(), {"file", "columns", "units", "over"});
  } else {
    keys.insert(keys.end(), {argument.list, "values"});
  }
  source.allow_keys(keys);
  TableFunction table;
  table.argument = argument.argument;
  read_points(source, argument, numbers, table);
  const bool is_straight =
      source.purpose == LawPurpose::load && argument.argument == LawArgument::time;
  table.interpolation = is_straight ? Interpolation::linear : Interpolation::monotone;
  if (const auto interpolation = source.node.find("interpolation")) {
    table.interpolation = read_interpolation(*interpolation, source.purpose, argument.argument);
  }
  if (const auto period = source.node.find("period")) {
    read_table_period(*period, argument, numbers, table);
  }
  return table;
}

}  // namespace pleuel
