#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "core/scene/reading/syntax_error.hpp"
#include "core/scene/reading/time_function_reader.hpp"
#include "core/scene/reading/unit_scanner.hpp"
#include "core/scene/units.hpp"

namespace pleuel {

namespace {

/// Two columns of a file, in SI units, one entry a row.
struct TableColumns {
  std::vector<double> arguments;  ///< ascending, at least two
  std::vector<double> values;
};

namespace fs = std::filesystem;

/// Around cells.
constexpr std::string_view covers = " \t\r\"";

struct Row {
  int line = 0;  ///< from 1
  std::vector<std::string> cells;
};

/// The first of ; tab , that the line has, else blanks.
char separator_of(const std::string& line) {
  for (const char c : {';', '\t', ','}) {
    if (line.find(c) != std::string::npos) return c;
  }
  return ' ';
}

/// Where the cell that begins here ends: separators between quotes are its own.
std::size_t end_of_cell(const std::string& line, std::size_t begin, char separator) {
  bool is_quoted = false;
  for (std::size_t i = begin; i < line.size(); ++i) {
    if (line[i] == '"') is_quoted = !is_quoted;
    if (line[i] == separator && !is_quoted) return i;
  }
  return line.size();
}

/// Without empty cells at the end, which some programs write.
std::vector<std::string> split(const std::string& line, char separator) {
  std::vector<std::string> cells;
  std::size_t begin = 0;
  while (begin <= line.size()) {
    const std::size_t end = end_of_cell(line, begin, separator);
    const std::string cell = trimmed(line.substr(begin, end - begin), covers);
    if (separator != ' ' || !cell.empty()) cells.push_back(cell);
    begin = end + 1;
  }
  while (!cells.empty() && cells.back().empty()) cells.pop_back();
  return cells;
}

/// Rows that are not empty and no remark. @pre the text has no byte-order mark
std::vector<Row> rows_of(const std::string& text) {
  std::vector<Row> rows;
  int line_number = 0;
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string line = trimmed(text.substr(begin, end - begin), " \r");
    ++line_number;
    begin = end + 1;
    const std::string content = trimmed(line, covers);
    if (content.empty() || content.starts_with('#')) continue;
    rows.push_back({line_number, split(line, separator_of(line))});
  }
  return rows;
}

/// "angle [deg]" or "angle (deg)".
struct Head {
  std::string name, unit;
};

Head head_of(const std::string& cell) {
  for (const auto& [open, close] : {std::pair('[', ']'), std::pair('(', ')')}) {
    const std::size_t at = cell.find(open);
    if (at == std::string::npos || !cell.ends_with(close)) continue;
    return {trimmed(cell.substr(0, at), covers),
            trimmed(cell.substr(at + 1, cell.size() - at - 2), covers)};
  }
  return {cell, ""};
}

/// {"file": "gas_force.csv", "columns": ["angle", "force"], "units": ["deg", "N"]}: a text file
/// from the folder of the problem file on. Cells are separated by commas, semicolons, tabs or blanks;
/// decimals have a point; lines that begin with # are left out. Columns have names, which are those
/// of the first line, or numbers from 1. Units stand in the first line, "angle [deg]", or in "units".
/// @param node  has the keys "file" and "columns"
/// @throws InputError with the number of the line
class TableFile {
 public:
  explicit TableFile(const JsonNode& node) : name_(node.at("file")), columns_(node.at("columns")) {
    if (const auto given = node.find("units")) units_node_.emplace(*given);
    std::string text = read_text_file(name_.named_file());
    if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
    rows_ = rows_of(text);
    if (rows_.empty()) name_.fail(fmt::format("names the file {}, which is empty", name_.text()));
    const auto is_number = [](const std::string& cell) { return plain_number(cell).has_value(); };
    const std::vector<std::string>& first = rows_.front().cells;
    if (std::ranges::none_of(first, is_number)) {
      for (const std::string& cell : first) heads_.push_back(head_of(cell));
      rows_.erase(rows_.begin());
    }
  }

  TableColumns read(const std::array<Quantity, 2>& quantities) const {
    const std::vector<JsonNode> names = columns_.items(2);
    std::array<std::size_t, 2> places{};
    std::array<double, 2> scales{};
    for (std::size_t i = 0; i < 2; ++i) {
      places[i] = place_of(names[i]);
      scales[i] = scale_of(i, places[i], quantities[i]);
    }
    TableColumns table;
    for (const Row& row : rows_) {
      check_length(row);
      table.arguments.push_back(scales[0] * entry(row, places[0]));
      table.values.push_back(scales[1] * entry(row, places[1]));
      const std::size_t n = table.arguments.size();
      if (n > 1 && !(table.arguments[n - 1] > table.arguments[n - 2])) {
        fail(row, fmt::format("the first column must ascend, got {} after a value that is not less",
                              row.cells[places[0]]));
      }
    }
    if (table.arguments.size() < 2) {
      name_.fail(fmt::format("names the file {}, which must have two rows of numbers at least",
                             name_.text()));
    }
    return table;
  }

 private:
  /// More cells than columns are decimal commas, or names that stand above the wrong columns.
  void check_length(const Row& row) const {
    const std::size_t columns = heads_.empty() ? rows_.front().cells.size() : heads_.size();
    if (row.cells.size() <= columns) return;
    fail(row, fmt::format("it has {} values, but the first line {} (decimals have a point)",
                          row.cells.size(), columns));
  }

  [[noreturn]] void fail(const Row& row, const std::string& why) const {
    name_.fail(fmt::format("names the file {}, line {}: {}", name_.text(), row.line, why));
  }

  std::size_t place_of(const JsonNode& column) const {
    constexpr int most_columns = 10000;
    if (column.value().is_number()) {
      return static_cast<std::size_t>(column.whole_number(1, most_columns)) - 1;
    }
    const std::string name = column.text();
    std::vector<std::string> known;
    for (const Head& head : heads_) known.push_back(head.name);
    const auto found = std::ranges::find(known, name);
    if (found != known.end()) {
      if (std::find(found + 1, known.end(), name) != known.end()) {
        column.fail_with_value(fmt::format(
            "must be a number from 1, as the file {} has two columns of that name", name_.text()));
      }
      return static_cast<std::size_t>(found - known.begin());
    }
    if (known.empty()) {
      column.fail_with_value(fmt::format(
          "must be a number from 1, as the file {} has no line of names", name_.text()));
    }
    fail_unknown_name(column, "column", name, known);
  }

  double scale_of(std::size_t i, std::size_t place, const Quantity& quantity) const {
    const bool is_head = !units_node_ && place < heads_.size();
    const JsonNode at = units_node_ ? units_node_->items(2)[i] : columns_.items(2)[i];
    const std::string unit = units_node_ ? at.text() : is_head ? heads_[place].unit : "";
    if (unit.empty()) {
      at.fail(
          fmt::format("has no unit; write it in the first line of {}, as in \"{} [{}]\", or in "
                      "\"units\"",
                      name_.text(), is_head ? heads_[place].name : "value", quantity.unit));
    }
    try {
      const double scale = unit_scale(unit, quantity);
      check_unit_of_file(at, place, scale, quantity);
      return scale;
    } catch (const UnitError& error) {
      at.fail(fmt::format("has the unit \"{}\", but must be {}: {}", unit, describe(quantity),
                          error.what()));
    }
  }

  /// What the problem file says must not contradict the first line of the table.
  void check_unit_of_file(const JsonNode& at, std::size_t place, double scale,
                          const Quantity& quantity) const {
    if (!units_node_ || place >= heads_.size() || heads_[place].unit.empty()) return;
    const Head& head = heads_[place];
    try {
      if (unit_scale(head.unit, quantity) == scale) return;
    } catch (const UnitError&) {  // a remark in brackets
      return;
    }
    at.fail_with_value(
        fmt::format("must be the unit of the first line of {}, \"{} [{}]\", or "
                    "leave \"units\" out",
                    name_.text(), head.name, head.unit));
  }

  double entry(const Row& row, std::size_t place) const {
    if (place >= row.cells.size()) {
      fail(row, fmt::format("there is no column {}", place + 1));
    }
    const std::optional<double> number = plain_number(row.cells[place]);
    if (!number) {
      fail(row, fmt::format("\"{}\" is no number (decimals have a point)", row.cells[place]));
    }
    return *number;
  }

  JsonNode name_, columns_;
  std::optional<JsonNode> units_node_;
  std::vector<Row> rows_;
  std::vector<Head> heads_;  ///< none: the file begins with numbers
};

/// What a table is a function of, and the key of its list.
struct TableArgument {
  LawArgument argument = LawArgument::time;
  std::string_view word, list;
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
  return read_row(source.node.at("over"), all);
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
  TableColumns columns = TableFile(source.node).read({argument.quantity, source.value});
  table.times = std::move(columns.arguments);
  table.values.assign(columns.values.begin(), columns.values.end());
}

constexpr Choice<Interpolation> of_any_table[] = {{"monotone", Interpolation::monotone},
                                                  {"spline", Interpolation::spline},
                                                  {"linear", Interpolation::linear}};
constexpr Choice<Interpolation> of_load_over_time[] = {{"linear", Interpolation::linear},
                                                       {"step", Interpolation::step},
                                                       {"monotone", Interpolation::monotone},
                                                       {"spline", Interpolation::spline}};

/// How a table goes from point to point; by default as the first of its choices.
Interpolation read_interpolation(const LawSource& source, LawArgument argument) {
  const auto node = source.node.find("interpolation");
  if (source.purpose == LawPurpose::load && argument == LawArgument::time) {
    return node ? read_choice(*node, of_load_over_time) : Interpolation::linear;
  }
  if (!node) return Interpolation::monotone;
  if (node->value() == "step") {
    node->fail_with_value(
        source.purpose == LawPurpose::drive
            ? "would move a drive in no time; take \"monotone\", \"spline\" or \"linear\""
            : "is for tables over time: a force that jumps with the motion has no tangent; take "
              "\"monotone\", \"spline\" or \"linear\"");
  }
  return read_choice(*node, of_any_table);
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

TableFunction read_table_law(const LawSource& source, NumberReader& numbers) {
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
  table.interpolation = read_interpolation(source, argument.argument);
  if (const auto period = source.node.find("period")) {
    read_table_period(*period, argument, numbers, table);
  }
  return table;
}

}  // namespace pleuel
