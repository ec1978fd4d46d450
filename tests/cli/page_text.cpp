#include "tests/cli/page_text.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "tests/cli/program.hpp"

namespace pleuel::test {

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

namespace {

/// A reader of what our documents use of XML: elements, attributes, texts, entities.
class XmlReader {
 public:
  explicit XmlReader(const std::string& text) : text_(text) {}

  std::vector<XmlElement> read() {
    read_element();
    skip_space();
    expect(at_ == text_.size(), "something follows the root");
    return std::move(elements_);
  }

 private:
  void expect(bool is_right, const std::string& message) const {
    if (!is_right) throw std::runtime_error(message + " at " + text_.substr(at_, 60));
  }

  void skip_space() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
  }

  bool accept(const std::string& token) {
    if (text_.compare(at_, token.size(), token) != 0) return false;
    at_ += token.size();
    return true;
  }

  std::string read_name() {
    const std::size_t begin = at_;
    while (at_ < text_.size() &&
           (std::isalnum(static_cast<unsigned char>(text_[at_])) || text_[at_] == '-')) {
      ++at_;
    }
    expect(at_ > begin, "no name");
    return text_.substr(begin, at_ - begin);
  }

  /// Up to a delimiter, with entities resolved.
  std::string read_text(char delimiter) {
    static const std::map<std::string, std::string> entities = {
        {"&amp;", "&"}, {"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}};
    std::string read;
    while (at_ < text_.size() && text_[at_] != delimiter) {
      expect(text_[at_] != '<', "a bare <");
      if (text_[at_] != '&') {
        read += text_[at_++];
        continue;
      }
      bool is_known = false;
      for (const auto& [entity, character] : entities) {
        if (is_known || !accept(entity)) continue;
        read += character;
        is_known = true;
      }
      expect(is_known, "a bare &");
    }
    expect(at_ < text_.size(), "no end");
    return read;
  }

  void read_element() {
    expect(accept("<"), "no element");
    const std::size_t index = elements_.size();
    elements_.push_back({read_name(), {}, {}});
    for (skip_space(); text_[at_] != '>' && text_[at_] != '/'; skip_space()) {
      const std::string name = read_name();
      expect(accept("=\""), "no value");
      expect(elements_[index].attributes.emplace(name, read_text('"')).second, "twice");
      ++at_;
    }
    if (accept("/>")) return;
    expect(accept(">"), "no end of a tag");
    while (!accept("</")) {
      if (text_[at_] == '<') {
        read_element();
      } else {
        elements_[index].text += read_text('<');
      }
    }
    expect(read_name() == elements_[index].name, "another element is closed");
    expect(accept(">"), "no end of a tag");
  }

  const std::string& text_;
  std::size_t at_ = 0;
  std::vector<XmlElement> elements_;
};

}  // namespace

bool XmlElement::has_class(const std::string& wanted) const {
  const auto found = attributes.find("class");
  return found != attributes.end() &&
         (" " + found->second + " ").find(" " + wanted + " ") != std::string::npos;
}

std::vector<XmlElement> read_xml(const std::string& text) {
  return XmlReader(text).read();
}

ReadAxis::ReadAxis(const std::vector<XmlElement>& elements, const std::string& tick,
                   const std::string& coordinate) {
  std::vector<std::pair<double, double>> ticks;
  for (const XmlElement& element : elements) {
    if (!element.has_class(tick)) continue;
    // What stands there is what people read.
    ticks.emplace_back(element.number(coordinate), std::log10(std::stod(element.text)));
  }
  if (ticks.size() < 2) throw std::runtime_error("an axis with less than two ticks");
  pixel_ = ticks.front().first;
  logarithm_ = ticks.front().second;
  slope_ = (ticks.back().second - logarithm_) / (ticks.back().first - pixel_);
}

double ReadAxis::value(double pixel) const {
  return std::pow(10.0, logarithm_ + slope_ * (pixel - pixel_));
}

std::vector<ReadPoint> read_points(const std::string& svg) {
  const std::vector<XmlElement> elements = read_xml(svg);
  const ReadAxis x(elements, "tick-x", "x"), y(elements, "tick-y", "y");
  std::vector<ReadPoint> points;
  for (const XmlElement& element : elements) {
    if (!element.has_class("point") || element.has_class("failure")) continue;
    double pixel_x = 0.0, pixel_y = 0.0;
    if (std::sscanf(element.attributes.at("transform").c_str(), "translate(%lf %lf)", &pixel_x,
                    &pixel_y) != 2) {
      throw std::runtime_error("a mark without a place");
    }
    points.push_back({x.value(pixel_x), y.value(pixel_y)});
  }
  return points;
}

}  // namespace pleuel::test
