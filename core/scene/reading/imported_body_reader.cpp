#include <filesystem>

#include <fmt/format.h>

#include "core/scene/invariants_file.hpp"
#include "core/scene/named_quantities.hpp"
#include "core/scene/reading/scene_reader.hpp"

namespace pleuel {

namespace {

namespace fs = std::filesystem;

/// In the folder of the problem file.
fs::path find_file(const JsonNode& name) {
  const fs::path path = fs::path(name.file()).parent_path() / name.text();
  std::error_code error;
  if (!fs::exists(path, error) || fs::is_directory(path, error)) {
    name.fail_with_value("must name a file, from the folder of the problem file on");
  }
  return path;
}

/// Those variables of the problem that the file has derivatives for.
std::vector<ImportedVariable> find_variables(const JsonNode& name, const InvariantsFile& file,
                                             NumberReader& numbers) {
  std::vector<ImportedVariable> variables;
  for (std::size_t i = 0; i < file.design.size(); ++i) {
    const ConstantsDerivative& of = file.design[i];
    const std::optional<int> variable = numbers.find_variable(of.variable);
    if (!variable) continue;
    if (!of.derivative) {
      name.fail(fmt::format(
          "names the file {}, which has no derivatives with respect to the variable \"{}\" of its "
          "design; write them, or rename the variable of the problem if it is another one",
          name.text(), of.variable));
    }
    if (is_zero(*of.derivative)) continue;
    const std::optional<Quantity> quantity = pleuel::find_quantity(of.unit);
    if (!quantity) {
      name.fail(fmt::format(
          "names the file {}, whose variable \"{}\" has the unit \"{}\", which is no SI "
          "unit of a design variable",
          name.text(), of.variable, of.unit));
    }
    const Number number = Number::bound(*variable);
    numbers.add_use({number, *quantity, Range::any, name});
    variables.push_back({number, *quantity, i});
  }
  return variables;
}

}  // namespace

ImportedBody read_imported_body(const JsonNode& node, NumberReader& numbers) {
  node.allow_keys({"type", "file", "from", "to", "reference", "other_designs", "velocity",
                   "angular_velocity", "initial_deflections"});
  ImportedBody body;
  const JsonNode name = node.at("file");
  body.source = name.text();
  body.file = std::make_shared<const InvariantsFile>(read_invariants(find_file(name)));
  body.variables = find_variables(name, *body.file, numbers);
  body.from = numbers.triple(node.at("from"), quantities::length);
  body.to = numbers.triple(node.at("to"), quantities::length);
  if (const auto reference = node.find("reference")) {
    body.reference = numbers.direction(*reference);
  }
  if (const auto elsewhere = node.find("other_designs")) {
    body.is_linear = read_choice<bool>(*elsewhere, {{"refuse", false}, {"linear", true}});
  }
  return body;
}

}  // namespace pleuel
