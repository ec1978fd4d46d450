#include "cli/files/starters.hpp"

#include "cli/files/output_file.hpp"
#include "cli/files/run_folder.hpp"
#include "cli/given_files.hpp"
#include "core/scene/reading/json_text.hpp"
#include "core/scene/reading/syntax_error.hpp"

namespace pleuel {

std::vector<Starter> starters() {
  std::vector<Starter> all;
  for (const auto& [kind, text] : given_files::starters) {
    const Json document = parse_json(text, kind);
    all.push_back({kind, document.at("description").get<std::string>(), text});
  }
  return all;
}

std::string problem_schema() {
  std::string schema;
  for (const char* part : given_files::schema) schema += part;
  return schema;
}

void write_given_file(const fs::path& path, const std::string& text, const Arguments& arguments) {
  std::error_code error;
  const bool is_there = fs::is_regular_file(path, error) && read_text_file(path) == text;
  if (is_there && !arguments.overwrites) return;
  require_free(path, arguments);
  make_folder_of(path);
  write_file({path, nullptr}, text);
}

}  // namespace pleuel
