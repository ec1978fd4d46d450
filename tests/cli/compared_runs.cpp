#include "tests/cli/compared_runs.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <sqlite3.h>

namespace pleuel::test {

namespace fs = std::filesystem;

namespace {

/// A document without times, which differ from run to run.
nlohmann::json timeless(nlohmann::json document) {
  if (document.is_object()) {
    for (const char* key : {"seconds", "choice_seconds"}) document.erase(key);
  }
  if (document.is_structured()) {
    for (auto& part : document) part = timeless(std::move(part));
  }
  return document;
}

/// The cells of a table, but for the column of times.
CsvRows timeless(CsvRows rows) {
  const auto column = std::find(rows.at(0).begin(), rows.at(0).end(), "seconds") - rows[0].begin();
  if (column == std::ssize(rows[0])) return rows;
  for (auto& row : rows) row.erase(row.begin() + column);
  return rows;
}

}  // namespace

int count_evaluations(const fs::path& folder) {
  sqlite3* database = nullptr;
  sqlite3_stmt* statement = nullptr;
  EXPECT_EQ(sqlite3_open((folder / "run.sqlite").c_str(), &database), SQLITE_OK);
  EXPECT_EQ(
      sqlite3_prepare_v2(database, "SELECT count(*) FROM evaluations", -1, &statement, nullptr),
      SQLITE_OK);
  EXPECT_EQ(sqlite3_step(statement), SQLITE_ROW);
  const int count = sqlite3_column_int(statement, 0);
  sqlite3_finalize(statement);
  sqlite3_close(database);
  return count;
}

std::string quick_line() {
  std::string line;
  for (const std::string& word : quick()) line += " '" + word + "'";
  return line;
}

std::string quick_run(const std::string& command) {
  return command + " " + problem("slider_crank_round") + quick_line();
}

void ComparedRuns::kill_and_end(const std::string& words, const std::string& name, int kills,
                                std::mt19937& random, int exit_code) const {
  std::uniform_real_distribution<double> seconds(0.02, 0.6);
  std::string line = "--version >/dev/null";
  for (int i = 0; i < kills; ++i) {
    line += fmt::format(
        "\n{{ {} {} -o {} --resume & p=$!; sleep {:.3f}; kill -9 $p; wait $p; }} "
        ">/dev/null 2>&1",
        PLEUEL_PROGRAM, words, name, seconds(random));
  }
  run_line(folder_.path(), line);
  const ProgramRun run = run_line(folder_.path(), words + " -o " + name + " --resume");
  EXPECT_EQ(run.exit_code, exit_code) << run.out << run.err;
}

nlohmann::json ComparedRuns::result(const std::string& name) const {
  return timeless(read_json(folder_.path() / name / "result.json"));
}

CsvRows ComparedRuns::table(const std::string& name, const std::string& file) const {
  return timeless(read_csv(folder_.path() / name / file));
}

void ComparedRuns::expect_same(const std::string& name, const std::string& other,
                               const std::string& file) const {
  EXPECT_EQ(result(name), result(other));
  EXPECT_EQ(table(name, file), table(other, file));
  EXPECT_EQ(count_evaluations(folder_.path() / name), count_evaluations(folder_.path() / other));
}

}  // namespace pleuel::test
