#include <fmt/format.h>

#include "core/base/int_size.hpp"
#include "core/scene/invariants_file.hpp"
#include "core/scene/reading/constants_check.hpp"
#include "core/scene/reading/constants_reader.hpp"
#include "core/scene/reading/surface_reader.hpp"
#include "core/scene/reading/text_file.hpp"

namespace pleuel {

namespace {

constexpr const char* format_name = "pleuel-invariants";
constexpr int format_version = 1;

void check_format(const JsonNode& root) {
  const JsonNode format = root.at("format");
  if (format.text() != format_name) {
    format.fail_with_value(fmt::format("must be \"{}\"", format_name));
  }
  const JsonNode version = root.at("version");
  if (version.number() != format_version) {
    version.fail_with_value(fmt::format("must be {}, the version that is known", format_version));
  }
  const JsonNode units = root.at("units");
  if (units.text() != "SI") units.fail_with_value("must be \"SI\"");
}

void read_heading(const JsonNode& root, InvariantsFile& file) {
  root.allow_keys({"format", "version", "body", "description", "units", "reference_condition",
                   "coordinates", "invariants", "places", "stress", "stiffening", "surface",
                   "design", "derivatives"});
  check_format(root);
  file.body = root.at("body").text();
  if (const auto description = root.find("description")) file.description = description->text();
  file.reference_condition = root.at("reference_condition").text();
  const JsonNode coordinates = root.at("coordinates");
  for (const JsonNode& name : coordinates.items()) file.coordinates.push_back(name.text());
  if (file.coordinates.empty()) coordinates.fail("must have at least one coordinate");
}

std::vector<ConstantsDerivative> read_design(const JsonNode& root) {
  std::vector<ConstantsDerivative> design;
  const auto node = root.find("design");
  if (!node) return design;
  for (const auto& [name, member] : node->members()) {
    member.allow_keys({"value", "unit"});
    design.push_back({name, member.at("value").number(), member.at("unit").text(), std::nullopt});
  }
  return design;
}

void read_derivatives(const JsonNode& root, InvariantsFile& file) {
  const auto node = root.find("derivatives");
  if (!node) return;
  std::vector<std::string> names;
  for (const ConstantsDerivative& of : file.design) names.push_back(of.variable);
  for (const auto& [name, member] : node->members()) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
      member.fail(fmt::format("must have a value in /design, the design that it belongs to"));
    }
    BodyConstants derivative = read_derivative(member, file.constants);
    check_derivative(member, derivative);
    file.design[found - names.begin()].derivative = std::move(derivative);
  }
}

}  // namespace

InvariantsFile read_invariants_text(const std::string& text, const std::string& name) {
  const Json document = parse_json(text, name);
  const JsonNode root(document, name, "", "the file of invariants");
  InvariantsFile file;
  read_heading(root, file);
  file.constants = read_constants(root, int_size(file.coordinates));
  check_constants(root, file.constants);
  file.design = read_design(root);
  read_derivatives(root, file);
  if (const auto surface = root.find("surface")) {
    file.surface = read_surface(*surface, file.constants.size());
  }
  return file;
}

InvariantsFile read_invariants(const std::filesystem::path& path) {
  return read_invariants_text(read_text_file(path), path.string());
}

}  // namespace pleuel
