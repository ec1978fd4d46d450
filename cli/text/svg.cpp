#include "cli/text/svg.hpp"

#include <map>

namespace pleuel {

std::string xml_text(const std::string& text) {
  static const std::map<char, std::string> marks = {
      {'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}};
  std::string safe;
  for (const char c : text) safe += marks.contains(c) ? marks.at(c) : std::string(1, c);
  return safe;
}

Svg::Svg(double width, double height, const std::string& title, const std::string& style) {
  add(R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {:.0f} {:.0f}" )"
      R"(font-family="sans-serif" role="img">)",
      width, height);
  add("<title>{}</title>\n<style>{}</style>", xml_text(title), style);
  add(R"(<rect class="paper" width="{:.0f}" height="{:.0f}"/>)", width, height);
}

void Svg::add_text(double x, double y, const std::string& attributes, const std::string& text) {
  add(R"(<text x="{:.1f}" y="{:.1f}" {}>{}</text>)", x, y, attributes, xml_text(text));
}

}  // namespace pleuel
