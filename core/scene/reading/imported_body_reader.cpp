#include "core/scene/reading/imported_body_reader.hpp"

#include <cmath>
#include <filesystem>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/error.hpp"
#include "core/base/int_size.hpp"
#include "core/scene/body_source.hpp"
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

std::vector<std::string> read_texts(const JsonNode& list) {
  std::vector<std::string> texts;
  for (const JsonNode& item : list.items()) texts.push_back(item.text());
  if (texts.empty()) list.fail("must not be empty");
  return texts;
}

BodyGenerator read_generator(const std::string& name, const JsonNode& node, NumberReader& numbers) {
  BodyGenerator generator;
  read_keys(node, numbers, generator);
  generator.body = name;
  generator.folder = fs::absolute(node.file()).parent_path().string();
  generator.record = fs::absolute("runs/bodies").string();
  if (const auto command = node.find("command")) generator.command = read_texts(*command);
  if (const auto files = node.find("files")) generator.files = read_texts(*files);
  const JsonNode variables = node.at("variables");
  for (const auto& [variable, unit] : variables.members()) {
    generator.variables.push_back({variable, unit.text()});
  }
  if (generator.variables.empty()) {
    variables.fail("must name a design variable; without one, use \"file\"");
  }
  return generator;
}

/// Binds the body to its variables. @returns their start [SI]
Eigen::VectorXd bind_variables(const JsonNode& node, const BodyGenerator& generator,
                               NumberReader& numbers, ImportedBody& body) {
  Eigen::VectorXd start(int_size(generator.variables));
  for (int i = 0; i < int_size(start); ++i) {
    const auto& [name, unit] = generator.variables[i];
    const JsonNode place = node.at("variables").at(name);
    const std::optional<Quantity> quantity = pleuel::find_quantity(unit);
    if (!quantity) place.fail_with_value("must be the SI unit of the variable, such as \"m\"");
    const Number number = Number::bound(numbers.variable(place, name));
    start(i) = numbers.start_of(name, *quantity);
    numbers.add_use({number, *quantity, Range::any, place});
    body.variables.push_back({number, *quantity, static_cast<std::size_t>(i)});
  }
  return start;
}

/// Has the body made at the start.
void generate(const std::string& name, const JsonNode& node, NumberReader& numbers,
              ImportedBody& body) {
  const BodyGenerator generator = read_generator(name, node, numbers);
  const Eigen::VectorXd start = bind_variables(node, generator, numbers, body);
  body.source = generator.command.empty()
                    ? "its function"
                    : fmt::format("\"{}\"", fmt::join(generator.command, " "));
  try {
    body.maker = make_body_source(generator);
    body.file = body.maker->at(start);
  } catch (const InputError& error) {
    node.fail(error.what());
  } catch (const SimulationError& error) {
    node.fail(fmt::format("could not make the body at the start: {}", error.what()));
  }
}

}  // namespace

ImportedBody read_imported_body(const std::string& name, const JsonNode& node,
                                NumberReader& numbers) {
  ImportedBody body;
  read_keys(node, numbers, [&](Keys& keys) { describe(keys, body); },
            {"type", "velocity", "angular_velocity", "initial_deflections"});
  if (const auto generator = node.find("generator")) {
    generate(name, *generator, numbers, body);
    return body;
  }
  const JsonNode file = node.at("file");
  body.source = file.text();
  body.file = std::make_shared<const InvariantsFile>(read_invariants(find_file(file)));
  body.variables = find_variables(file, *body.file, numbers);
  return body;
}

namespace {

/// Rows of so many numbers.
Eigen::MatrixXd read_table(const JsonNode& node, std::size_t columns) {
  const std::vector<JsonNode> rows = node.items();
  Eigen::MatrixXd table(int_size(rows), columns);
  for (int i = 0; i < int_size(rows); ++i) {
    int k = 0;
    for (const JsonNode& number : rows[i].items(columns)) {
      table(i, k) = number.number();
      if (!std::isfinite(table(i, k++))) number.fail_with_value("must be finite");
    }
  }
  return table;
}

std::vector<std::array<int, 3>> read_triangles(const JsonNode& node, int points) {
  std::vector<std::array<int, 3>> triangles;
  for (const JsonNode& item : node.items()) {
    const std::vector<JsonNode> corners = item.items(3);
    std::array<int, 3>& triangle = triangles.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) triangle[i] = corners[i].whole_number(0, points - 1);
  }
  return triangles;
}

}  // namespace

BodySurface read_surface(const JsonNode& node, int coordinates) {
  node.allow_keys({"positions", "triangles", "displacement", "young", "poisson"});
  BodySurface surface;
  surface.positions = read_table(node.at("positions"), 3).transpose();
  const int points = int_size(surface.positions.row(0));
  surface.triangles = read_triangles(node.at("triangles"), points);
  const JsonNode displacement = node.at("displacement");
  surface.displacement = read_table(displacement, coordinates);
  if (surface.displacement.rows() != 3 * points) {
    displacement.fail("must have three rows for each of the \"positions\"");
  }
  surface.young = node.at("young").number();
  surface.poisson = node.at("poisson").number();
  if (!(surface.young > 0.0)) node.at("young").fail_with_value("must be positive [Pa]");
  if (!(std::abs(surface.poisson) < 1.0)) {
    node.at("poisson").fail_with_value("must be between -1 and 1");
  }
  return surface;
}

}  // namespace pleuel
