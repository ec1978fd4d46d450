#include "cli/files/report_page.hpp"

#include <array>
#include <cstdlib>
#include <iterator>
#include <stdexcept>

#include <fmt/format.h>

#include "cli/input/fingerprint.hpp"
#include "cli/text/wrapped_text.hpp"

namespace pleuel {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view opening = R"(<script type="application/json" id="pleuel-data">)";
constexpr std::string_view closing = "</script>";

/// What pages show besides result.json.
constexpr std::array<const char*, 3> shown_files = {"history.csv", "uncertainty.csv",
                                                    "gradients.csv"};
constexpr std::uintmax_t largest_file = 3'000'000;  ///< [byte]

/// A document inside a script element: "</script>" or "<!--" in a name must not end it.
std::string without_tags(const std::string& json) {
  std::string text;
  for (const char letter : json) text += letter == '<' ? "\\u003c" : std::string(1, letter);
  return text;
}

/// Where it was looked for.
std::string template_place() {
  if (const char* given = std::getenv("PLEUEL_REPORT_TEMPLATE")) return given;
  return fmt::format(
      "../report/{0} or share/pleuel/{0} from {1} on (PLEUEL_REPORT_TEMPLATE may name it)",
      report_name, own_file().string());
}

}  // namespace

std::optional<fs::path> find_report_template() {
  std::error_code error;
  if (const char* given = std::getenv("PLEUEL_REPORT_TEMPLATE")) {
    return fs::is_regular_file(given, error) ? std::optional<fs::path>(given) : std::nullopt;
  }
  const fs::path folder = own_file().parent_path();
  fs::path page = folder.parent_path() / "report" / report_name;  // of a build
  for (fs::path above = folder; !fs::is_regular_file(page, error); above = above.parent_path()) {
    if (!above.has_relative_path()) return std::nullopt;
    page = above / "share" / "pleuel" / report_name;
  }
  return page;
}

std::string missing_template_text(const std::string& program, const fs::path& folder) {
  return wrapped(
      fmt::format("No report.html: its template is not built, which takes nodejs and npm "
                  "(docs/report.md), or not at {}. Afterwards: {} report {}\n",
                  template_place(), program, folder.string()),
      "  ");
}

Json report_data(const Json& card, const Json& result, const Json& picture,
                 const fs::path& folder) {
  Json files = Json::object(), left_out = Json::array();
  for (const char* name : shown_files) {
    std::error_code error;
    const std::uintmax_t size = fs::file_size(folder / name, error);
    if (folder.empty() || error) continue;
    if (size <= largest_file) {
      files[name] = whole_text(folder / name);
    } else {
      left_out.push_back(name);
    }
  }
  return {{"format", 1},        {"card", card},   {"result", result},
          {"picture", picture}, {"files", files}, {"left_out", left_out}};
}

bool write_page(const ResultFile& file, const Json& data) {
  const auto page_template = find_report_template();
  std::string page = page_template ? whole_text(*page_template) : "";
  const std::size_t begin = page.find(opening);
  const std::size_t end = begin == std::string::npos ? begin : page.find(closing, begin);
  if (end == std::string::npos) {
    throw std::runtime_error(fmt::format("the template of pages has no place for data: it is {}",
                                         page_template ? page_template->string() : "not there"));
  }
  const std::size_t inside = begin + opening.size();
  const std::string text =
      data.dump(-1, ' ', /*ensure_ascii=*/false, Json::error_handler_t::replace);
  page.replace(inside, end - inside, without_tags(text));
  return write_file(file, page);
}

void draw_page(const fs::path& page, const Json& data, Outcome& outcome) {
  make_folder_of(page);
  if (write_page({page, &outcome.unwritten}, data)) {
    outcome.document["page"] = page.string();
    outcome.text += fmt::format("Drawn in {}\n", page.string());
  }
}

}  // namespace pleuel
