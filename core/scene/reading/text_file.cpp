#include "core/scene/reading/text_file.hpp"

#include <array>
#include <fstream>

#include <fmt/format.h>

#include "core/base/error.hpp"

namespace pleuel {
namespace {

/// Far more than a mechanism needs: /dev/zero has no end.
constexpr std::size_t most_bytes = std::size_t{32} << 20U;

}  // namespace

std::string read_text_file(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) {
    throw InputError(fmt::format("{}: there is no such file", path.string()));
  }
  if (std::filesystem::is_directory(status)) {
    throw InputError(fmt::format("{}: is a directory, not a problem file", path.string()));
  }
  // A pipe has no second reader, and one without a writer would wait for ever.
  if (!std::filesystem::is_regular_file(status)) {
    throw InputError(fmt::format("{}: is no ordinary file", path.string()));
  }
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw InputError(fmt::format("{}: cannot be read", path.string()));
  std::string text;
  std::array<char, 65536> part;
  do {
    stream.read(part.data(), part.size());
    text.append(part.data(), static_cast<std::size_t>(stream.gcount()));
    if (text.size() > most_bytes) {
      throw InputError(fmt::format("{}: is larger than {} MiB, which no problem file is",
                                   path.string(), most_bytes >> 20U));
    }
  } while (stream);
  if (stream.bad()) throw InputError(fmt::format("{}: cannot be read", path.string()));
  return text;
}

}  // namespace pleuel
