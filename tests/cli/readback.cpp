#include "tests/cli/readback.hpp"

#include <map>
#include <sstream>

namespace pleuel::test {

namespace {

struct Cell {
  std::string text;
  std::size_t begin = 0;  ///< in characters
};

/// Cells stand two or more spaces apart.
std::vector<Cell> cells_of(const std::string& line) {
  std::vector<Cell> cells;
  std::size_t place = 0, spaces = 2;
  for (const char c : line) {
    if (c == ' ') {
      ++spaces;
    } else {
      if (spaces >= 2) {
        cells.push_back({"", place});
      } else if (spaces == 1) {
        cells.back().text += ' ';
      }
      cells.back().text += c;
      spaces = 0;
    }
    // Bytes 10xxxxxx continue a character.
    if ((static_cast<unsigned char>(c) & 0xC0) != 0x80) ++place;
  }
  return cells;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
    text.replace(at, from.size(), to);
  }
  return text;
}

std::string digits_of(const std::string& text) {
  const std::string plain = replaced(text, "−", "-");
  const std::size_t begin = plain.find_first_of("0123456789");
  if (begin == std::string::npos) return "";
  const bool has_sign = begin > 0 && plain[begin - 1] == '-';
  const std::size_t from = has_sign ? begin - 1 : begin;
  return plain.substr(from, plain.find_first_not_of("0123456789.e+-", from) - from);
}

}  // namespace

TextTable::TextTable(const std::string& report, const std::string& first_title) {
  std::istringstream lines(report);
  std::size_t row = 0;
  std::vector<Cell> titles;  // of the block at hand
  std::size_t first = 0;     // its first column
  for (std::string line; std::getline(lines, line);) {
    const std::vector<Cell> cells = cells_of(line);
    const bool is_title = !cells.empty() && cells.front().text == first_title && cells.size() > 1;
    if (is_title) {
      titles = cells;
      first = titles_.size();
      row = 0;
      for (const Cell& title : titles) titles_.push_back(title.text);
      continue;
    }
    if (line.empty()) titles.clear();
    if (titles.empty()) continue;
    if (cells.size() == 1 && row > 0 && cells.front().begin > 2) {  // the rest of a broken cell
      rows_[row - 1].back() += " " + cells.front().text;
      continue;
    }
    if (row == rows_.size()) rows_.emplace_back();
    std::vector<std::string>& texts = rows_[row++];
    texts.resize(first);
    if (cells.front().begin > 2 && row > 1 && cells.size() + 1 == titles.size()) {  // as above
      texts.push_back(rows_[row - 2][first]);
    }
    for (const Cell& cell : cells) texts.push_back(cell.text);
  }
  EXPECT_FALSE(rows_.empty()) << "no table of \"" << first_title << "\" in\n" << report;
}

std::size_t TextTable::column(const std::string& title) const {
  const auto found = std::ranges::find(titles_, title);
  EXPECT_NE(found, titles_.end()) << "no column \"" << title << "\"";
  return static_cast<std::size_t>(found == titles_.end() ? 0 : found - titles_.begin());
}

bool TextTable::has(const std::string& title) const {
  return std::ranges::find(titles_, title) != titles_.end();
}

std::string TextTable::text(std::size_t row, const std::string& title) const {
  const std::size_t i = column(title);
  return row < rows_.size() && i < rows_[row].size() ? rows_[row][i] : "";
}

double TextTable::number(std::size_t row, const std::string& title) const {
  return number_in(text(row, title));
}

std::size_t TextTable::row_of(const std::string& name) const {
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (!rows_[i].empty() && rows_[i].front() == name) return i;
  }
  ADD_FAILURE() << "no row \"" << name << "\"";
  return 0;
}

double number_in(std::string text) {
  const std::string digits = digits_of(text);
  EXPECT_FALSE(digits.empty()) << "no number in \"" << text << "\"";
  return digits.empty() ? std::nan("") : std::stod(digits);
}

std::string behind(const std::string& text, const std::string& words) {
  const std::string line = unwrapped(text);
  const std::size_t at = line.find(words);
  EXPECT_NE(at, std::string::npos) << "no \"" << words << "\" in\n" << line;
  return at == std::string::npos ? "nan" : line.substr(at + words.size(), 24);
}

namespace {

/// SI value of one of a unit of tables: written down here once more, from the definitions of units.
double si_of(const std::string& unit) {
  static const std::map<std::string, double> units = {
      {"m", 1},   {"mm", 1e-3}, {"kg", 1},    {"g", 1e-3}, {"Pa", 1},    {"MPa", 1e6},    {"N", 1},
      {"N m", 1}, {"s", 1},     {"ms", 1e-3}, {"1", 1},    {"rad/s", 1}, {"Hz", 2 * M_PI}};
  const auto found = units.find(unit);
  if (found != units.end()) return found->second;
  const std::size_t slash = unit.rfind('/');
  if (slash != std::string::npos)
    return si_of(unit.substr(0, slash)) / si_of(unit.substr(slash + 1));
  ADD_FAILURE() << "unknown unit \"" << unit << "\"";
  return std::nan("");
}

/// Half a unit of the last digit of a shown number.
double resolution_of(const std::string& text) {
  const std::string digits = digits_of(text);
  const std::size_t mantissa = std::min(digits.find('e'), digits.size());
  const std::size_t point = digits.find('.');
  const auto decimals = point == std::string::npos ? 0 : static_cast<int>(mantissa - point) - 1;
  const double exponent = mantissa < digits.size() ? std::stod(digits.substr(mantissa + 1)) : 0.0;
  return 0.5 * std::pow(10.0, exponent - decimals);
}

}  // namespace

void expect_shown(const std::string& shown, const std::string& unit, double si) {
  const double value = number_in(shown) * si_of(unit);
  EXPECT_NEAR(value, si, 1.001 * resolution_of(shown) * si_of(unit) + 1e-12 * std::abs(si))
      << shown << " " << unit;
}

Report report_of(const std::string& command, const std::string& options, int exit_code) {
  const ProgramFolder folder;
  Report report;
  report.text = folder.run(command + " $crank -o run $quick " + options, exit_code).out;
  report.document = folder.result();
  for (const auto& entry : std::filesystem::directory_iterator(folder / "run")) {
    if (entry.path().extension() != ".csv") continue;
    report.files[entry.path().filename().string()] = parse_csv(read_file(entry.path()));
  }
  return report;
}

double largest(const std::vector<double>& values) {
  double most = 0.0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

}  // namespace pleuel::test
