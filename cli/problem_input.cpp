#include "cli/problem_input.hpp"

#include <cstdint>
#include <fstream>
#include <iterator>

#include <fmt/format.h>

#include "core/model/effect_estimates.hpp"
#include "core/scene/problem_reader.hpp"
#include "core/scene/reading/override.hpp"

namespace pleuel {

namespace {

/// Fowler, Noll & Vo, 64 bits: tells inputs apart, protects against nothing.
class Fingerprint {
 public:
  void add(const std::string& text) {
    for (const char c : text) add_byte(static_cast<unsigned char>(c));
    add_byte(0);  // so that {"a", "b"} differs from {"ab"}
  }
  std::string text() const { return fmt::format("fnv1a64:{:016x}", state_); }

 private:
  void add_byte(unsigned char byte) { state_ = (state_ ^ byte) * 0x100000001b3u; }
  std::uint64_t state_ = 0xcbf29ce484222325u;
};

std::string read_text(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

}  // namespace

ProblemInput read_input(const Arguments& arguments) {
  ProblemInput input;
  input.problem = read_problem(arguments.file, arguments.overrides);
  estimate_effects(input.problem);
  const std::string text = read_text(arguments.file);
  input.effective = parse_json(text, arguments.file.string());
  Fingerprint fingerprint;
  fingerprint.add(text);
  for (const std::string& assignment : arguments.overrides) {
    apply_override(input.effective, assignment, arguments.file.string());
    fingerprint.add(assignment);
  }
  input.hash = fingerprint.text();
  return input;
}

}  // namespace pleuel
