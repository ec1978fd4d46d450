#pragma once

#include <optional>

#include "cli/files/output_file.hpp"
#include "cli/reports/outcome.hpp"

/// report.html: one page without network that shows what a run found (docs/report.md).
namespace pleuel {

inline constexpr const char* report_name = "report.html";

/// The page without data that is built beside the program (report/), or the file that the variable
/// PLEUEL_REPORT_TEMPLATE of the environment names; nothing if there is none.
std::optional<std::filesystem::path> find_report_template();

/// Why there is no report and what to do, as one line.
std::string missing_template_text(const std::string& program, const std::filesystem::path& folder);

/// The data of a page: {"card", "result", "picture", "files", "left_out"}; `picture` of run_picture() or
/// null, `files` the texts of the CSV and SVG files in the folder that pages show (none of no folder), `left_out` the
/// names of those that are too large for a page (beyond 3 MB).
Json report_data(const Json& card, const Json& result, const Json& picture,
                 const std::filesystem::path& folder = {});

/// What there is to say where there is no template.
inline constexpr const char* no_template =
    "the template of pages is not built, which takes nodejs and npm: see docs/report.md";

/// Writes the page with the data in place of what stands between the tags of the template.
/// @returns whether it could be written
/// @throws std::runtime_error if there is no template with such a place
bool write_page(const ResultFile& file, const Json& data);

/// The same for a page that the user asked for by its name: tells the outcome.
void draw_page(const std::filesystem::path& page, const Json& data, Outcome& outcome);

}  // namespace pleuel
