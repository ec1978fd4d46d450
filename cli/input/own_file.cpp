#include "cli/input/own_file.hpp"

#include <dlfcn.h>

namespace pleuel {

std::filesystem::path own_file() {
  Dl_info info{};
  const auto here = reinterpret_cast<const void*>(&own_file);
  if (::dladdr(here, &info) == 0 || info.dli_fname == nullptr) return "/proc/self/exe";
  std::error_code error;
  const std::filesystem::path file = std::filesystem::canonical(info.dli_fname, error);
  return error ? "/proc/self/exe" : file;
}

}  // namespace pleuel
