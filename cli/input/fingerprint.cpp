#include "cli/input/fingerprint.hpp"

#include <fstream>
#include <iterator>

#include <dlfcn.h>
#include <fmt/format.h>

#include "cli/commit.hpp"
#include "cli/versions.hpp"
#include "core/scene/reading/document_reader.hpp"

namespace pleuel {

namespace {

void add_file(const Json& name, const std::filesystem::path& folder, Json& fingerprints) {
  if (!name.is_string()) return;
  Fingerprint fingerprint;
  fingerprint.add(whole_text(folder / name.get<std::string>()));
  fingerprints[name.get<std::string>()] = fingerprint.text();
}

/// Files of all objects and lists below.
void add_files(const Json& document, const std::filesystem::path& folder, Json& fingerprints) {
  if (document.is_object() && document.contains("file")) {
    add_file(document["file"], folder, fingerprints);
  }
  if (!document.is_structured()) return;
  for (const Json& part : document) add_files(part, folder, fingerprints);
}

void add_files_of_scene(const Json& problem, const std::filesystem::path& folder,
                        Json& fingerprints) {
  const Json scene = problem.value("scene", Json::object());
  if (!scene.is_object()) return;
  if (scene.contains("catalogue")) add_file(scene["catalogue"], folder, fingerprints);
  for (const char* part : {"bodies", "joints", "loads"}) {
    add_files(scene.value(part, Json::object()), folder, fingerprints);
  }
}

}  // namespace

std::string whole_text(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

std::filesystem::path own_file() {
  Dl_info info{};
  const auto here = reinterpret_cast<const void*>(&own_file);
  if (::dladdr(here, &info) == 0 || info.dli_fname == nullptr) return "/proc/self/exe";
  std::error_code error;
  const std::filesystem::path file = std::filesystem::canonical(info.dli_fname, error);
  return error ? "/proc/self/exe" : file;
}

std::string program_fingerprint() {
  Fingerprint fingerprint;
  fingerprint.add(whole_text(own_file()));
  return fingerprint.text();
}

Json fingerprints_of_files(const Json& problem, const std::filesystem::path& file) {
  Json fingerprints = Json::object();
  add_files_of_scene(problem, file.parent_path(), fingerprints);
  for (const CaseChanges& changes : cases_of(problem, file.string())) {
    const Json of_case = document_of_case(problem, changes, file.string());
    add_files_of_scene(of_case, file.parent_path(), fingerprints);
  }
  return fingerprints;
}

std::string version_text() {
  return fmt::format("pleuel {} (commit {}, {}, {}, {})", versions::pleuel, versions::commit,
                     versions::compiler, versions::build_type, versions::processor);
}

}  // namespace pleuel
