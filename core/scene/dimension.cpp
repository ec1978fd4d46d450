#include "core/scene/dimension.hpp"

#include <mutex>
#include <set>

#include <fmt/format.h>

namespace pleuel {

namespace {

/// "m^2"
std::string factor(std::size_t base, double power) {
  const char* name = Dimension::bases[base];
  return power == 1.0 ? name : fmt::format("{}^{:.4g}", name, power);
}

void append(std::string& text, const std::string& more) {
  if (!text.empty()) text += " ";
  text += more;
}

}  // namespace

std::string base_units(const Dimension& dimension) {
  std::string above, below;
  std::size_t count_below = 0;
  for (const std::size_t base : {1U, 0U, 3U, 4U, 5U, 6U, 7U, 8U, 2U}) {
    const double power = dimension.powers[base];
    if (power > 1e-9) append(above, factor(base, power));
    if (power < -1e-9) {
      append(below, factor(base, -power));
      ++count_below;
    }
  }
  if (below.empty()) return above.empty() ? "1" : above;
  if (above.empty()) above = "1";
  if (count_below == 1) return above + "/" + below;
  // without brackets: "kg/m/s^2"
  for (std::size_t at = below.find(' '); at != std::string::npos; at = below.find(' ', at)) {
    below[at] = '/';
  }
  return above + "/" + below;
}

std::string_view kept_text(const std::string& text) {
  static std::mutex mutex;
  static std::set<std::string> texts;
  const std::lock_guard<std::mutex> lock(mutex);
  return *texts.insert(text).first;
}

}  // namespace pleuel
