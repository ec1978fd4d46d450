#include "tests/cli/program.hpp"

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <sstream>

#include <fmt/format.h>
#include <sqlite3.h>
#include <sys/wait.h>

namespace pleuel::test {

namespace fs = std::filesystem;

namespace {

/// For the shell; no word of these tests has a single quote.
std::string quoted(const std::string& word) {
  return "'" + word + "'";
}

/// A line with what stands for words of it.
std::string expanded(std::string line) {
  static const std::vector<std::pair<std::string, std::string>> words = {
      {"$crank", quoted(problem("slider_crank_round"))},
      {"$problems", source_folder() + "/problems"},
      {"$quick",
       "--set '/simulation/step=0.2 ms' --set '/simulation/end_time=20 ms' "
       "--set '/scene/joints/bearing/drive/ramp=20 ms' --set /optimizer/backend=nlopt-mma"},
      {"$pleuel", quoted(PLEUEL_PROGRAM)}};
  for (const auto& [name, word] : words) {
    for (std::size_t at = 0; (at = line.find(name, at)) != std::string::npos; at += word.size()) {
      line.replace(at, name.size(), word);
    }
  }
  return line;
}

}  // namespace

json ProgramRun::document() const {
  const json document = json::parse(out, nullptr, /*allow_exceptions=*/false);
  EXPECT_FALSE(document.is_discarded()) << "not one JSON document: " << out << err;
  return document;
}

ProgramRun run_line(const fs::path& folder, const std::string& line) {
  const TemporaryFolder streams;
  const fs::path out = streams.path() / "out", err = streams.path() / "err";
  // The page is that of the tests, whether the real one is built or not.
  const std::string page = source_folder() + "/tests/cli/report_template.html";
  const std::string command =
      fmt::format("cd {} && export PLEUEL_REPORT_TEMPLATE={} && {{ {} {}\n}} >{} 2>{}",
                  quoted(folder.string()), quoted(page), quoted(PLEUEL_PROGRAM), expanded(line),
                  quoted(out.string()), quoted(err.string()));
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_file(out), read_file(err)};
}

std::string wait_until(const std::string& condition) {
  return "i=0; while ! { " + condition +
         "; } && [ $i -lt 3000 ]; do sleep 0.01; i=$((i + 1)); done; ";
}

ProgramRun ProgramFolder::run(const std::string& line, int exit_code) const {
  const ProgramRun run = run_line(path(), line);
  EXPECT_EQ(run.exit_code, exit_code) << line << "\n" << run.out << run.err;
  return run;
}

json ProgramFolder::document(const std::string& line, int exit_code) const {
  return run(line + " --json", exit_code).document();
}

std::string ProgramFolder::refusal(const std::string& line) const {
  return unwrapped(run(line, 2).err);
}

std::string ProgramFolder::text(const std::string& name) const {
  return read_file(*this / name);
}

std::string problem(const std::string& name) {
  return source_folder() + "/problems/" + name + ".json";
}

json read_problem(const std::string& name) {
  return read_json(problem(name));
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

json read_json(const fs::path& path) {
  return json::parse(read_file(path));
}

json at(const json& document, const std::string& path) {
  return document.at(json::json_pointer("/" + path));
}

double number(const json& document, const std::string& path) {
  return at(document, path).get<double>();
}

std::string overrides_of(const json& setting) {
  std::string options;
  for (const auto& [pointer, value] : setting.at("overrides").items()) {
    options += " --set '" + pointer + "=" + value.dump() + "'";
  }
  return options;
}

json named(const json& list, const std::string& name) {
  const auto found =
      std::ranges::find_if(list, [&](const json& one) { return one.at("name") == name; });
  if (found == list.end()) throw std::runtime_error("nothing is called " + name);
  return *found;
}

std::vector<std::string> column(const CsvRows& rows, const std::string& title) {
  const auto place = std::ranges::find(rows.at(0), title) - rows[0].begin();
  std::vector<std::string> cells;
  EXPECT_LT(place, std::ssize(rows[0])) << "no column " << title;
  if (place == std::ssize(rows[0])) return cells;
  for (std::size_t row = 1; row < rows.size(); ++row) {
    EXPECT_EQ(rows[row].size(), rows[0].size());
    cells.push_back(rows[row].at(static_cast<std::size_t>(place)));
  }
  return cells;
}

std::vector<double> numbers(const CsvRows& rows, const std::string& title) {
  std::vector<double> numbers;
  for (const std::string& cell : column(rows, title)) {
    numbers.push_back(cell.empty() ? std::nan("") : std::stod(cell));
  }
  return numbers;
}

namespace {

/// A document without times, which differ from run to run.
json timeless(json document) {
  if (document.is_object()) {
    for (const char* key : {"seconds", "choice_seconds"}) document.erase(key);
  }
  if (document.is_structured()) {
    for (json& part : document) part = timeless(std::move(part));
  }
  return document;
}

/// The cells of a table, but for the column of times.
CsvRows timeless(CsvRows rows) {
  const auto column = std::ranges::find(rows.at(0), "seconds") - rows[0].begin();
  if (column == std::ssize(rows[0])) return rows;
  for (auto& row : rows) row.erase(row.begin() + column);
  return rows;
}

}  // namespace

int count_evaluations(const fs::path& folder) {
  sqlite3* database = nullptr;
  sqlite3_stmt* statement = nullptr;
  EXPECT_EQ(sqlite3_open((folder / "run.sqlite").c_str(), &database), SQLITE_OK);
  const char* query = "SELECT count(*) FROM evaluations";
  EXPECT_EQ(sqlite3_prepare_v2(database, query, -1, &statement, nullptr), SQLITE_OK);
  EXPECT_EQ(sqlite3_step(statement), SQLITE_ROW);
  const int count = sqlite3_column_int(statement, 0);
  sqlite3_finalize(statement);
  sqlite3_close(database);
  return count;
}

void ComparedRuns::kill_and_end(const std::string& line, const std::string& name, int kills,
                                unsigned seed, int exit_code) const {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> seconds(0.02, 0.6);
  std::string killed = "--version >/dev/null";
  for (int i = 0; i < kills; ++i) {
    killed += fmt::format(
        "\n{{ $pleuel {} -o {} --resume & p=$!; sleep {:.3f}; kill -9 $p; wait $p; }} "
        ">/dev/null 2>&1",
        line, name, seconds(random));
  }
  run_line(folder_.path(), killed);
  run(line + " -o " + name + " --resume", exit_code);
}

json ComparedRuns::timeless_result(const std::string& name) const {
  return timeless(result(name));
}

void ComparedRuns::expect_same(const std::string& name, const std::string& other,
                               const std::string& file) const {
  EXPECT_EQ(timeless_result(name), timeless_result(other));
  EXPECT_EQ(timeless(folder_.csv(name + "/" + file)), timeless(folder_.csv(other + "/" + file)));
  EXPECT_EQ(count_evaluations(folder_ / name), count_evaluations(folder_ / other));
}

}  // namespace pleuel::test
