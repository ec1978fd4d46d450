#include "core/scene/problem_reader.hpp"

#include "core/scene/reading/document_reader.hpp"
#include "core/scene/reading/text_file.hpp"

namespace pleuel {

ProblemFile read_problem(const std::filesystem::path& path,
                         const std::vector<std::string>& overrides) {
  ProblemFile problem = read_problem_text(read_text_file(path), path.string(), overrides);
  if (problem.name.empty()) problem.name = path.stem().string();
  return problem;
}

ProblemFile read_problem_text(const std::string& text, const std::string& file,
                              const std::vector<std::string>& overrides) {
  const UnitSystem units;
  const Json document = whole_document({text, file, overrides}, units);
  const JsonNode root(document, file);
  NumberReader numbers(units, variable_names(root));
  return read_document(root, numbers);
}

}  // namespace pleuel
