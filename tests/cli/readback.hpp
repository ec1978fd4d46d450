#pragma once

#include <map>
#include <string>
#include <vector>

#include "tests/cli/program.hpp"

/// What people read: every number of tables and CSV files is read back and compared with the
/// document, in millimetres and megapascals. Units are converted by factors of the test.

namespace pleuel::test {

/// A number of a table against one of the document [SI].
void expect_shown(const std::string& shown, const std::string& unit, double si);

/// A table as people read it: what stands under a title.
class TextTable {
 public:
  /// The table whose first title is this one, in a report; its blocks side by side again if it was
  /// too wide, and cells in one line again that were broken. A test failure if there is none.
  TextTable(const std::string& report, const std::string& first_title);

  std::size_t rows() const { return rows_.size(); }
  bool has(const std::string& title) const;

  std::string text(std::size_t row, const std::string& title) const;
  double number(std::size_t row, const std::string& title) const;
  void expect(std::size_t row, const std::string& title, const std::string& unit, double si) const {
    expect_shown(text(row, title), unit, si);
  }

  /// The row that begins with a name.
  std::size_t row_of(const std::string& name) const;
  std::string text(const std::string& row, const std::string& title) const {
    return text(row_of(row), title);
  }
  double number(const std::string& row, const std::string& title) const {
    return number(row_of(row), title);
  }
  void expect(const std::string& row, const std::string& title, const std::string& unit,
              double si) const {
    expect(row_of(row), title, unit, si);
  }
  /// The same in the unit that stands in the row.
  void expect(const std::string& row, const std::string& title, double si) const {
    expect(row, title, text(row, "unit"), si);
  }

 private:
  std::size_t column(const std::string& title) const;

  std::vector<std::string> titles_;
  std::vector<std::vector<std::string>> rows_;
};

/// The number at the begin of a text such as "12.5 %" or "≤ 200.00"; a minus may be typographic.
double number_in(std::string text);

/// What follows some words of a text, or of a report whose lines are broken anywhere.
std::string behind(const std::string& text, const std::string& words);

/// One run of a command, with all that it leaves.
struct Report {
  std::string text;
  json document;
  std::map<std::string, CsvRows> files;

  std::vector<double> column(const std::string& file, const std::string& title) const {
    return numbers(files.at(file), title);
  }
};

/// @param options  those of the command, behind those of $quick
Report report_of(const std::string& command, const std::string& options = "", int exit_code = 0);

double largest(const std::vector<double>& values);

}  // namespace pleuel::test
