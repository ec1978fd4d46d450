#include "core/scene/reading/invariants_reader.hpp"

#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/error.hpp"
#include "core/base/int_size.hpp"
#include "core/scene/body_source.hpp"
#include "core/scene/named_quantities.hpp"
#include "core/scene/reading/constants_reader.hpp"
#include "core/scene/reading/scene_reader.hpp"
#include "core/scene/reading/syntax_error.hpp"
#include "core/scene/visit_constants.hpp"

namespace pleuel {

namespace {

namespace fs = std::filesystem;

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
    const auto found = std::ranges::find(names, name);
    if (found == names.end()) {
      member.fail(fmt::format("must have a value in /design, the design that it belongs to"));
    }
    BodyConstants derivative = read_derivative(member, file.constants);
    check_derivative(member, derivative);
    file.design[found - names.begin()].derivative = std::move(derivative);
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
  body.file = std::make_shared<const InvariantsFile>(read_invariants(file.named_file()));
  body.variables = find_variables(file, *body.file, numbers);
  return body;
}

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

namespace {

Json numbers_json(double number) {
  return number;
}

/// A list, or a list of rows.
template <class Derived>
Json numbers_json(const Eigen::MatrixBase<Derived>& matrix) {
  Json json = Json::array();
  if constexpr (Derived::IsVectorAtCompileTime) {
    for (const double number : matrix) json.push_back(number);
  } else {
    for (const auto& row : matrix.rowwise()) json.push_back(numbers_json(row));
  }
  return json;
}

/// [row, column, value] of every entry that is not zero.
Json numbers_json(const SparseMatrix& matrix) {
  Json json = Json::array();
  for (int row = 0; row < matrix.outerSize(); ++row) {
    for (SparseMatrix::InnerIterator entry(matrix, row); entry; ++entry) {
      if (entry.value() != 0.0) json.push_back({row, entry.col(), entry.value()});
    }
  }
  return json;
}

/// Writes the blocks that are visited.
auto writer_to(Json& json) {
  return [&json](const ConstantsBlock& block, const auto& numbers) {
    json[std::string(block.word)] = numbers_json(numbers);
  };
}

Json places_json(const BodyConstants& constants) {
  Json json = Json::object();
  for (const BodyPlace& place : constants.places) {
    visit_place(writer_to(json[place.name]), place);
  }
  return json;
}

Json groups_json(const StressRecovery& stress) {
  Json json = Json::object();
  for (const PointGroup& group : stress.groups) {
    json[group.name] = Json::array();
    for (const int point : group.points) json[group.name].push_back(stress.points[point]);
  }
  return json;
}

Json stress_json(const StressRecovery& stress, bool is_derivative) {
  Json json = Json::object();
  if (!is_derivative) {
    json["points"] = stress.points;
    if (!stress.groups.empty()) json["groups"] = groups_json(stress);
  }
  for (const auto& [word, member] : strength_members<double>) {
    const double strength = stress.strengths.*member;
    if (strength != 0.0) json[std::string(word)] = strength;
  }
  if (!is_derivative && stress.strengths.fatigue_exponent > 0.0) {
    json[std::string(fatigue_exponent_word)] = stress.strengths.fatigue_exponent;
  }
  json["of_coordinates"] = numbers_json(stress.of_coordinates);
  json["of_accelerations"] = numbers_json(stress.of_accelerations);
  if (stress.of_stretching.cols() > 0) {
    json["of_stretching"] = numbers_json(stress.of_stretching);
  }
  return json;
}

Json stiffening_json(const Stretching& stretching, bool is_derivative) {
  Json json = Json::object();
  json["damping"] = stretching.damping;
  if (!is_derivative) json["size"] = stretching.displacements.rows();
  json["displacements"] = numbers_json(stretching.displacements);
  json["elements"] = Json::array();
  for (const StretchedElement& element : stretching.elements) {
    Json item = Json::object();
    if (!is_derivative) {
      item["displacements"] = element.displacements;
      item["elongation"] = numbers_json(element.elongation);
    }
    visit_element(writer_to(item), element);
    json["elements"].push_back(std::move(item));
  }
  return json;
}

/// For pictures: single precision is enough.
double rounded(double number) {
  return std::stod(fmt::format("{:.7g}", number));
}

Json surface_json(const BodySurface& surface) {
  Json json = {{"young", surface.young}, {"poisson", surface.poisson}};
  const Eigen::Matrix3Xd positions = surface.positions.unaryExpr(&rounded);
  json["positions"] = numbers_json(positions.transpose());
  json["triangles"] = surface.triangles;
  const Eigen::MatrixXd displacement = surface.displacement.unaryExpr(&rounded);
  json["displacement"] = numbers_json(displacement);
  return json;
}

Json blocks_json(const BodyConstants& constants, bool is_derivative) {
  Json json;
  visit_invariants(writer_to(json["invariants"]), constants);
  json["places"] = places_json(constants);
  if (constants.stress) json["stress"] = stress_json(*constants.stress, is_derivative);
  if (constants.stretching) {
    json["stiffening"] = stiffening_json(*constants.stretching, is_derivative);
  }
  return json;
}

/// Objects over several lines, each list on one.
void write(const Json& json, const std::string& indent, std::string& text) {
  if (!json.is_object() || json.empty()) {
    text += json.dump(-1, ' ', false, Json::error_handler_t::replace);
    return;
  }
  text += "{\n";
  std::size_t left = json.size();
  for (const auto& [key, value] : json.items()) {
    text += indent + "  " + Json(key).dump(-1, ' ', false, Json::error_handler_t::replace) + ": ";
    write(value, indent + "  ", text);
    text += --left > 0 ? ",\n" : "\n";
  }
  text += indent + "}";
}

}  // namespace

Json derivative_json(const BodyConstants& change) {
  return blocks_json(change, true);
}

std::string write_invariants(const InvariantsFile& file) {
  Json json;
  json["format"] = "pleuel-invariants";
  json["version"] = 1;
  json["body"] = file.body;
  if (!file.description.empty()) json["description"] = file.description;
  json["units"] = "SI";
  json["reference_condition"] = file.reference_condition;
  json["coordinates"] = file.coordinates;
  json.update(blocks_json(file.constants, false));
  if (file.surface) json["surface"] = surface_json(*file.surface);
  json["design"] = Json::object();
  for (const ConstantsDerivative& of : file.design) {
    json["design"][of.variable] = {{"value", of.value}, {"unit", of.unit}};
  }
  json["derivatives"] = Json::object();
  for (const ConstantsDerivative& of : file.design) {
    if (of.derivative) json["derivatives"][of.variable] = derivative_json(*of.derivative);
  }
  std::string text;
  write(json, "", text);
  return text + "\n";
}

}  // namespace pleuel
