#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tests/cli/program.hpp"
#include "tests/support/test.hpp"

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

/// What people read: every number of tables and CSV files is read back and compared with the
/// document, in millimetres and megapascals. Units are converted by factors of the test.

namespace pleuel::test {

/// One run of a command, with all that it leaves.
struct Report {
  std::string text;
  nlohmann::json document;
  std::map<std::string, CsvRows> files;

  /// The numbers of a column; empty cells are NaN.
  std::vector<double> column(const std::string& file, const std::string& title) const {
    const CsvRows& rows = files.at(file);
    const auto found = std::find(rows[0].begin(), rows[0].end(), title);
    EXPECT_NE(found, rows[0].end()) << file << " has no column " << title;
    std::vector<double> numbers;
    if (found == rows[0].end()) return numbers;
    const auto i = static_cast<std::size_t>(found - rows[0].begin());
    for (std::size_t row = 1; row < rows.size(); ++row) {
      EXPECT_EQ(rows[row].size(), rows[0].size());
      numbers.push_back(rows[row][i].empty() ? std::nan("") : std::stod(rows[row][i]));
    }
    return numbers;
  }
};

/// @param words  command, file, and options, which come after those of quick()
inline Report run(const std::vector<std::string>& words, int exit_code = 0) {
  const ProgramFolder folder;
  const ProgramRun run =
      folder.run(joined(joined(joined({words[0], words[1]}, {"-o", "run"}), quick()),
                        {words.begin() + 2, words.end()}));
  EXPECT_EQ(run.exit_code, exit_code) << run.err;
  Report report;
  report.text = run.out;
  report.document =
      nlohmann::json::parse(read_file(folder.path() / "run/result.json"), nullptr, false);
  for (const auto& entry : std::filesystem::directory_iterator(folder.path() / "run")) {
    if (entry.path().extension() != ".csv") continue;
    report.files[entry.path().filename().string()] = read_csv(entry.path());
  }
  return report;
}

/// What most of these tests run.
inline const std::string file = problem("slider_crank_round");

/// A number of a table against one of the document [SI].
inline void expect_shown(const std::string& shown, const std::string& unit, double si) {
  const double value = number_in(shown) * si_of(unit);
  EXPECT_NEAR(value, si, 1.001 * resolution_of(shown) * si_of(unit) + 1e-12 * std::abs(si))
      << shown << " " << unit;
}

inline double largest(const std::vector<double>& values) {
  double most = 0.0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

}  // namespace pleuel::test
