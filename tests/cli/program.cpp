#include "tests/cli/program.hpp"

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>

#include <sys/wait.h>

#include "tests/support/source_folder.hpp"
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

}  // namespace pleuel::test
