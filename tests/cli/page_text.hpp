#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

/// The data that the program puts into pages.

namespace pleuel::test {

/// What stands between the tags of a page.
nlohmann::json data_of(const std::filesystem::path& page);

/// Numbers of a packed document, RFC 4648 and IEEE 754.
std::vector<float> unpacked(const nlohmann::json& packed);

/// An element of an XML document, without what it holds.
struct XmlElement {
  std::string name;
  std::map<std::string, std::string> attributes;
  std::string text;  ///< directly within it

  double number(const std::string& attribute) const { return std::stod(attributes.at(attribute)); }
  bool has_class(const std::string& wanted) const;
};

/// The elements of a document, in the order in which they begin.
/// @throws std::runtime_error where it is not well-formed: tags that do not close or nest,
///         attributes without quotes or twice, characters that must be escaped
std::vector<XmlElement> read_xml(const std::string& text);

/// Values of a logarithmic axis from its ticks.
class ReadAxis {
 public:
  /// @param tick       class of its ticks
  /// @param coordinate their attribute with the pixel
  ReadAxis(const std::vector<XmlElement>& elements, const std::string& tick,
           const std::string& coordinate);
  double value(double pixel) const;

 private:
  double slope_ = 0.0, pixel_ = 0.0, logarithm_ = 0.0;
};

/// A mark where it stands, as a reader of the axes sees it.
struct ReadPoint {
  double x = 0.0, y = 0.0;
};

/// Marks that did not fail, in the order of the document.
std::vector<ReadPoint> read_points(const std::string& svg);

}  // namespace pleuel::test
