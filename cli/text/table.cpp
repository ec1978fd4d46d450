#include "cli/text/table.hpp"

#include <algorithm>
#include <numeric>
#include <sstream>

#include "cli/text/wrapped_text.hpp"

namespace pleuel {

namespace {

constexpr std::size_t gap = 2;           ///< before each column
constexpr std::size_t narrow_text = 24;  ///< a text in a narrower column cannot be read

std::size_t total(const std::vector<std::size_t>& widths, const std::vector<std::size_t>& shown) {
  return std::accumulate(shown.begin(), shown.end(), std::size_t{0},
                         [&](std::size_t sum, std::size_t i) { return sum + gap + widths[i]; });
}

std::vector<std::size_t> all(std::size_t count) {
  std::vector<std::size_t> indices(count);
  std::iota(indices.begin(), indices.end(), std::size_t{0});
  return indices;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  if (lines.empty()) lines.emplace_back();
  return lines;
}

}  // namespace

void Table::add_row(std::vector<std::string> cells) {
  cells.resize(columns_.size());
  rows_.push_back(std::move(cells));
}

std::vector<std::size_t> Table::widths() const {
  std::vector<std::size_t> widths;
  for (const Column& column : columns_) widths.push_back(characters(column.title));
  for (const auto& row : rows_) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      widths[i] = std::max(widths[i], characters(row[i]));
    }
  }
  const std::size_t whole = total(widths, all(widths.size()));
  const bool ends_with_text = !columns_.empty() && columns_.back().align == Align::left;
  const std::size_t before = widths.empty() ? 0 : whole - widths.back();
  if (whole > line_width() && ends_with_text && before + narrow_text <= line_width()) {
    widths.back() = line_width() - before;
  }
  return widths;
}

std::vector<std::vector<std::size_t>> Table::blocks(const std::vector<std::size_t>& widths) const {
  const std::vector<std::size_t> keys = all(std::min(keys_, columns_.size()));
  std::vector<std::vector<std::size_t>> blocks = {keys};
  for (std::size_t i = keys.size(); i < columns_.size(); ++i) {
    std::vector<std::size_t> wider = blocks.back();
    wider.push_back(i);
    const bool is_first = blocks.back().size() == keys.size();
    if (total(widths, wider) > line_width() && !is_first) {
      blocks.push_back(keys);
      blocks.back().push_back(i);
    } else {
      blocks.back() = wider;
    }
  }
  return blocks;
}

std::string Table::line(const std::vector<std::string>& cells,
                        const std::vector<std::size_t>& shown,
                        const std::vector<std::size_t>& widths) const {
  std::string begin;
  for (std::size_t k = 0; k + 1 < shown.size(); ++k) {
    const std::size_t i = shown[k];
    begin += std::string(gap, ' ') + padded(cells[i], widths[i], columns_[i].align);
  }
  const std::size_t last = shown.back();
  std::string text;
  for (const std::string& part : lines_of(wrapped(cells[last], "", widths[last]))) {
    std::string line =
        begin + std::string(gap, ' ') + padded(part, widths[last], columns_[last].align);
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
    begin.assign(characters(begin), ' ');
  }
  return text;
}

std::string Table::text() const {
  if (columns_.empty()) return "";
  std::vector<std::string> titles;
  for (const Column& column : columns_) titles.push_back(column.title);
  const std::vector<std::size_t> widths = this->widths();
  std::string text;
  for (const std::vector<std::size_t>& shown : blocks(widths)) {
    if (!text.empty()) text += "\n";
    text += line(titles, shown, widths);
    for (const auto& row : rows_) text += line(row, shown, widths);
  }
  return text;
}

std::string padded(const std::string& text, std::size_t width, Table::Align align) {
  const std::string space(width - std::min(width, characters(text)), ' ');
  return align == Table::Align::left ? text + space : space + text;
}

}  // namespace pleuel
