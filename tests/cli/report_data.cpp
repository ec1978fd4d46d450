#include "tests/cli/report_data.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <stdexcept>

#include "tests/cli/program.hpp"

namespace pleuel::test {

using nlohmann::json;

json data_of(const std::filesystem::path& page) {
  const std::string text = read_file(page);
  const std::string opening = R"(id="pleuel-data">)";
  const std::size_t begin = text.find(opening) + opening.size();
  return json::parse(text.substr(begin, text.find("</script>", begin) - begin));
}

std::vector<float> unpacked(const json& packed) {
  const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t group = 0;
  int count = 0;
  for (const char letter : packed.at("f32").get<std::string>()) {
    if (letter == '=') break;
    group = (group << 6) | static_cast<std::uint32_t>(letters.find(letter));
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>((group >> count) & 255u);
  }
  std::vector<float> numbers(bytes.size() / 4);
  std::memcpy(numbers.data(), bytes.data(), 4 * numbers.size());
  return numbers;
}

const json& named(const json& list, const std::string& name) {
  const auto found = std::find_if(list.begin(), list.end(),
                                  [&](const json& one) { return one.at("name") == name; });
  if (found == list.end()) throw std::runtime_error("nothing is called " + name);
  return *found;
}

}  // namespace pleuel::test
