#pragma once

#include <string>
#include <utility>
#include <vector>

namespace pleuel {

/// Aligned columns for the terminal: the first columns to the left, numbers to the right.
class Table {
 public:
  enum class Align { left, right };
  struct Column {
    Column(std::string title, Align align = Align::right) : title(std::move(title)), align(align) {}
    Column(const char* title) : title(title) {}

    std::string title;
    Align align = Align::right;
  };

  /// @param keys  so many of the first columns tell the rows apart
  explicit Table(std::vector<Column> columns, std::size_t keys = 1)
      : columns_(std::move(columns)), keys_(keys) {}

  /// @param cells  one a column; missing ones are empty
  void add_row(std::vector<std::string> cells);
  bool is_empty() const { return rows_.empty(); }

  /// Title line and rows, each indented by two spaces and ended by a newline. What is wider than a
  /// line has the texts of its last column broken, if that is enough, or is divided: into tables
  /// one below the other, each with the keys.
  std::string text() const;

 private:
  std::vector<std::size_t> widths() const;
  /// The tables that it is divided into, by their columns.
  std::vector<std::vector<std::size_t>> blocks(const std::vector<std::size_t>& widths) const;
  std::string line(const std::vector<std::string>& cells, const std::vector<std::size_t>& shown,
                   const std::vector<std::size_t>& widths) const;

  std::vector<Column> columns_;
  std::size_t keys_;
  std::vector<std::vector<std::string>> rows_;
};

/// A column of texts.
inline Table::Column left_aligned(const std::string& title) {
  return {title, Table::Align::left};
}

/// Filled with spaces to `width` characters.
std::string padded(const std::string& text, std::size_t width, Table::Align align);

}  // namespace pleuel
