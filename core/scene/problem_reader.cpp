#include "core/scene/problem_reader.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/scene/reading/across_cases.hpp"
#include "core/scene/reading/catalogue.hpp"
#include "core/scene/reading/document_reader.hpp"
#include "core/scene/reading/mistakes.hpp"
#include "core/scene/reading/shared_by_cases.hpp"
#include "core/scene/reading/syntax_error.hpp"

namespace pleuel {

namespace {

ProblemFile read_expanded(Json document, const std::string& file) {
  expand_names(document, file);
  const JsonNode root(document, file);
  NumberReader numbers(variable_names(root));
  return read_document(root, numbers);
}

std::vector<std::string> mistakes_in(const Json& document, const std::string& file) {
  try {
    read_expanded(document, file);
  } catch (const InputError& error) {
    return mistakes_of(error);
  }
  return {};
}

/// What is wrong with a case only is told with its name.
/// @param of_case  the document of the case
ProblemFile read_case_problem(const Json& document, const Json& of_case, const CaseChanges& changes,
                              const std::string& file) {
  try {
    return read_expanded(of_case, file);
  } catch (const InputError& error) {
    const Json without = document_of_case(document, CaseChanges(), file);
    const std::vector<std::string> shared = mistakes_in(without, file);
    std::vector<std::string> mistakes = mistakes_of(error);
    for (std::string& mistake : mistakes) {
      const bool is_shared = std::ranges::find(shared, mistake) != shared.end();
      if (!is_shared) mistake += fmt::format(" (in the case \"{}\")", changes.name);
    }
    fail_with(std::move(mistakes));
  }
}

ProblemFile complete_problem(const std::string& text, const std::string& file,
                             const std::vector<std::string>& overrides) {
  const Json document = overridden_document({text, file, overrides});
  const JsonNode root(document, file);
  const std::vector<CaseChanges> changes = cases_of(document, file);
  if (changes.empty()) {
    ProblemFile problem = read_expanded(document, file);
    problem.load_case.empty() ? forbid_case_names(root, problem) : keep_case(problem);
    return problem;
  }
  std::vector<ProblemFile> cases;
  std::vector<Json> documents;
  std::vector<std::vector<Symbol>> symbols;
  for (const CaseChanges& one : changes) {
    documents.push_back(document_of_case(document, one, file));
    cases.push_back(read_case_problem(document, documents.back(), one, file));
    symbols.push_back(read_symbols(JsonNode(documents.back(), file)));
  }
  check_shared_documents(root, changes, documents, symbols);
  check_shared_numbers(root, cases);
  ProblemFile joined = join_cases(root, documents, differing_constants(symbols), std::move(cases));
  check_shared_limits(root, joined);
  read_across_cases(root, symbols, joined);
  return joined;
}

}  // namespace

UndecidedProblem read_problem(const std::filesystem::path& path,
                              const std::vector<std::string>& overrides) {
  ProblemFile problem = complete_problem(read_text_file(path), path.string(), overrides);
  if (problem.name.empty()) problem.name = path.stem().string();
  return UndecidedProblem(std::move(problem));
}

UndecidedProblem read_problem_text(const std::string& text, const std::string& file,
                                   const std::vector<std::string>& overrides) {
  return UndecidedProblem(complete_problem(text, file, overrides));
}

}  // namespace pleuel
