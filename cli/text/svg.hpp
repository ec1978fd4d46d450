#pragma once

#include <string>
#include <utility>

#include <fmt/format.h>

namespace pleuel {

/// A text as XML has it between tags and in attributes.
std::string xml_text(const std::string& text);

/// A drawing that stands for itself, element by element.
class Svg {
 public:
  /// @param style  of the classes; what has the class "paper" is the ground
  Svg(double width, double height, const std::string& title, const std::string& style);

  template <class... Values>
  void add(fmt::format_string<Values...> element, Values&&... values) {
    text_ += fmt::format(element, std::forward<Values>(values)...) + "\n";
  }

  /// @param attributes  besides the place: R"(class="small" text-anchor="end")"
  void add_text(double x, double y, const std::string& attributes, const std::string& text);

  /// The whole document.
  std::string text() const { return text_ + "</svg>\n"; }

 private:
  std::string text_;
};

/// A line through points, as the attribute "d" of a path.
class SvgPath {
 public:
  void go_to(double x, double y) {
    text_ += fmt::format("{}{:.2f} {:.2f}", text_.empty() ? "M" : "L", x, y);
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

}  // namespace pleuel
