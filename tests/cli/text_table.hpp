#pragma once

#include <string>
#include <vector>

namespace pleuel::test {

/// A table as people read it: what stands under a title.
class TextTable {
 public:
  /// The table whose first title is this one, in a report; its blocks side by side again if it was
  /// too wide, and cells in one line again that were broken. A test failure if there is none.
  TextTable(const std::string& report, const std::string& first_title);

  std::size_t rows() const { return rows_.size(); }
  const std::vector<std::string>& titles() const { return titles_; }
  bool has(const std::string& title) const;

  /// @param title  of the n-th column of this name
  std::string text(std::size_t row, const std::string& title, int n = 1) const;
  double number(std::size_t row, const std::string& title, int n = 1) const;

  /// The row that begins with a name.
  std::size_t row_of(const std::string& name) const;

 private:
  std::size_t column(const std::string& title, int n) const;

  std::vector<std::string> titles_;
  std::vector<std::vector<std::string>> rows_;
};

/// The number at the begin of a text such as "12.5 %" or "≤ 200.00"; a minus may be typographic.
double number_in(std::string text);

/// SI value of one of a unit of tables: written down here once more, from the definitions of units.
double si_of(const std::string& unit);

/// Half a unit of the last digit of a shown number.
double resolution_of(const std::string& text);

}  // namespace pleuel::test
