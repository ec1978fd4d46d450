#include "tests/cli/program.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>

#include <fmt/format.h>
#include <sqlite3.h>
#include <sys/wait.h>

#include "tests/support/files.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test {

namespace fs = std::filesystem;

namespace {

/// The page is that of the tests, whether the real one is built or not.
std::string report_template() {
  return source_folder() + "/tests/cli/report_template.html";
}

/// For the shell; no word of these tests has a single quote.
std::string quoted(const std::string& word) {
  return "'" + word + "'";
}

}  // namespace

nlohmann::json ProgramRun::document() const {
  const auto document = nlohmann::json::parse(out, nullptr, /*allow_exceptions=*/false);
  EXPECT_FALSE(document.is_discarded()) << "not one JSON document: " << out << err;
  return document;
}

ProgramRun run_program(const fs::path& folder, const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) line += quoted(word) + " ";
  return run_line(folder, line);
}

ProgramRun run_line(const fs::path& folder, const std::string& line) {
  const TemporaryFolder streams;
  const fs::path out = streams.path() / "out", err = streams.path() / "err";
  const std::string command =
      fmt::format("cd {} && export PLEUEL_REPORT_TEMPLATE={} && {{ {} {}\n}} >{} 2>{}",
                  quoted(folder.string()), quoted(report_template()), quoted(PLEUEL_PROGRAM), line,
                  quoted(out.string()), quoted(err.string()));
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_file(out), read_file(err)};
}

std::string problem(const std::string& name) {
  return source_folder() + "/problems/" + name + ".json";
}

std::vector<std::string> quick() {
  return {"--set", "/simulation/step=0.2 ms",
          "--set", "/simulation/end_time=20 ms",
          "--set", "/scene/joints/bearing/drive/ramp=20 ms",
          "--set", "/optimizer/backend=nlopt-mma"};
}

std::vector<std::string> joined(std::vector<std::string> words,
                                const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

std::string unwrapped(const std::string& text) {
  std::istringstream words(text);
  std::string joined;
  for (std::string word; words >> word;) joined += (joined.empty() ? "" : " ") + word;
  return joined;
}

std::string read_file(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

nlohmann::json read_json(const fs::path& path) {
  return nlohmann::json::parse(read_file(path));
}

ProgramRun ProgramFolder::run_quick(const std::vector<std::string>& words) const {
  return run(joined(words, quick()));
}

CsvRows read_csv(const fs::path& path) {
  return parse_csv(read_file(path));
}

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
