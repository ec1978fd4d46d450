#include "reduction/calculix_input.hpp"

#include <algorithm>
#include <fstream>
#include <optional>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/int_size.hpp"
#include "core/scene/reading/unit_scanner.hpp"
#include "reduction/element_shape.hpp"

namespace pleuel {

namespace {

namespace fs = std::filesystem;

std::string capitals(std::string text) {
  for (char& letter : text) letter = static_cast<char>(std::toupper(letter));
  return text;
}

constexpr std::string_view blanks_of_lines = " \t\r";

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    fields.push_back(trimmed(line.substr(begin, end - begin), blanks_of_lines));
    begin = end + 1;
  }
  while (!fields.empty() && fields.back().empty()) fields.pop_back();
  return fields;
}

std::optional<SolidShape> shape_of(const std::string& type) {
  static const std::map<std::string, SolidShape> shapes = {
      {"C3D4", SolidShape::tetrahedron4},   {"C3D10", SolidShape::tetrahedron10},
      {"C3D8", SolidShape::hexahedron8},    {"C3D8R", SolidShape::hexahedron8},
      {"C3D8I", SolidShape::hexahedron8},   {"C3D20", SolidShape::hexahedron20},
      {"C3D20R", SolidShape::hexahedron20}, {"C3D10T", SolidShape::tetrahedron10}};
  const auto found = shapes.find(type);
  return found == shapes.end() ? std::nullopt : std::optional(found->second);
}

/// A line that begins with "*": "*ELEMENT, TYPE=C3D20, ELSET=body".
struct Card {
  std::string name;
  std::map<std::string, std::string> parameters;

  std::string get(const std::string& key) const {
    const auto found = parameters.find(key);
    return found == parameters.end() ? "" : found->second;
  }
};

Card read_card(const std::string& line) {
  const std::vector<std::string> fields = fields_of(line);
  Card card{capitals(fields.front()), {}};
  std::erase(card.name, ' ');
  for (std::size_t i = 1; i < fields.size(); ++i) {
    const std::size_t equals = fields[i].find('=');
    const std::string key = capitals(trimmed(fields[i].substr(0, equals)));
    card.parameters[key] = equals == std::string::npos ? "" : trimmed(fields[i].substr(equals + 1));
  }
  return card;
}

/// What the lines say, with the numbers of nodes and elements as they are written.
class InputReader {
 public:
  void read(const fs::path& path) {
    std::ifstream stream(path);
    if (!stream) throw InputError(fmt::format("{}: cannot be read", path.string()));
    const fs::path outer = std::exchange(path_, path);
    const int outer_line = std::exchange(line_, 0);
    for (std::string line; std::getline(stream, line);) {
      ++line_;
      read_line(trimmed(line, blanks_of_lines));
    }
    end_element();
    path_ = outer;
    line_ = outer_line;
  }

  SolidMesh mesh() const;

 private:
  struct WrittenElement {
    int number;
    SolidShape shape;
    std::vector<int> nodes;
  };

  [[noreturn]] void fail(const std::string& rule) const {
    throw InputError(fmt::format("{}:{}: {}", path_.string(), line_, rule));
  }

  double number(const std::string& text) const {
    const std::optional<double> value = plain_number(text);
    if (!value) fail(fmt::format("\"{}\" must be a number", text));
    return *value;
  }

  int whole(const std::string& text) const { return static_cast<int>(number(text)); }

  void read_line(const std::string& line) {
    if (line.empty() || line.starts_with("**")) return;
    if (!line.starts_with("*")) return read_data(fields_of(line));
    end_element();
    card_ = read_card(line);
    if (card_.name == "*INCLUDE") return read(path_.parent_path() / card_.get("INPUT"));
    if (card_.name == "*MATERIAL") materials_.push_back({card_.get("NAME"), 0.0, 0.0, 0.0});
    if (card_.name == "*SOLIDSECTION") {
      sections_.emplace_back(capitals(card_.get("ELSET")), capitals(card_.get("MATERIAL")));
    }
    if (card_.name == "*ELEMENT") begin_elements();
  }

  void begin_elements() {
    const std::string type = capitals(card_.get("TYPE"));
    shape_ = shape_of(type);
    if (!shape_ && type.starts_with("C3D")) {
      fail(
          fmt::format("the element type {} is not known; known are C3D4, C3D8, C3D8R, C3D8I, "
                      "C3D10, C3D10T, C3D20 and C3D20R",
                      type));
    }
  }

  void read_data(const std::vector<std::string>& fields) {
    if (fields.empty()) return;
    if (card_.name == "*NODE" && fields.size() >= 4) {
      nodes_[whole(fields[0])] = {number(fields[1]), number(fields[2]), number(fields[3])};
      node_sets_[capitals(card_.get("NSET"))].push_back(whole(fields[0]));
    } else if (card_.name == "*ELEMENT" && shape_) {
      read_element(fields);
    } else if (card_.name == "*NSET") {
      read_set(fields, node_sets_, capitals(card_.get("NSET")));
    } else if (card_.name == "*ELSET") {
      read_set(fields, element_sets_, capitals(card_.get("ELSET")));
    } else if (!materials_.empty()) {
      read_material(fields);
    }
  }

  void read_element(const std::vector<std::string>& fields) {
    for (const std::string& field : fields) pending_.push_back(whole(field));
    if (int_size(pending_) > node_count(*shape_)) end_element();
  }

  void end_element() {
    if (pending_.empty()) return;
    const int needed = node_count(*shape_) + 1;
    if (int_size(pending_) != needed) {
      fail(fmt::format("the element {} must have {} nodes, got {}", pending_.front(), needed - 1,
                       pending_.size() - 1));
    }
    const std::string set = capitals(card_.get("ELSET"));
    element_sets_[set].push_back(pending_.front());
    elements_.push_back({pending_.front(), *shape_, {pending_.begin() + 1, pending_.end()}});
    pending_.clear();
  }

  /// Numbers, names of other sets, or with GENERATE first, last and step.
  void read_set(const std::vector<std::string>& fields,
                std::map<std::string, std::vector<int>>& sets, const std::string& name) {
    std::vector<int>& set = sets[name];
    if (card_.parameters.contains("GENERATE")) {
      const int step = fields.size() > 2 ? whole(fields[2]) : 1;
      for (int i = whole(fields[0]); i <= whole(fields.at(1)); i += step) set.push_back(i);
      return;
    }
    for (const std::string& field : fields) {
      const auto other = sets.find(capitals(field));
      if (other == sets.end()) {
        set.push_back(whole(field));
      } else {
        const std::vector<int> members = other->second;
        set.insert(set.end(), members.begin(), members.end());
      }
    }
  }

  void read_material(const std::vector<std::string>& fields) {
    SolidMaterial& material = materials_.back();
    if (card_.name == "*ELASTIC" && fields.size() >= 2) {
      material.young = number(fields[0]);
      material.poisson = number(fields[1]);
    } else if (card_.name == "*DENSITY") {
      material.density = number(fields[0]);
    }
  }

  std::unordered_map<int, int> materials_of_elements() const;

  fs::path path_;
  int line_ = 0;
  Card card_;
  std::optional<SolidShape> shape_;
  std::vector<int> pending_;  ///< number and nodes of an element that goes on in the next line
  std::map<int, Eigen::Vector3d> nodes_;
  std::vector<WrittenElement> elements_;
  std::map<std::string, std::vector<int>> node_sets_, element_sets_;
  std::vector<SolidMaterial> materials_;
  std::vector<std::pair<std::string, std::string>> sections_;  ///< set of elements, material
};

std::unordered_map<int, int> InputReader::materials_of_elements() const {
  std::unordered_map<int, int> materials;
  for (const auto& [set, name] : sections_) {
    const auto is_it = [&, &name = name](const SolidMaterial& one) {
      return capitals(one.name) == name;
    };
    const auto material = std::find_if(materials_.begin(), materials_.end(), is_it);
    const auto elements = element_sets_.find(set);
    if (material == materials_.end() || elements == element_sets_.end()) continue;
    for (const int element : elements->second) {
      materials[element] = static_cast<int>(material - materials_.begin());
    }
  }
  return materials;
}

SolidMesh InputReader::mesh() const {
  SolidMesh mesh;
  mesh.materials = materials_;
  std::map<int, int> index;
  for (const WrittenElement& element : elements_) {
    for (const int node : element.nodes) index[node] = 0;
  }
  mesh.positions.resize(3, int_size(index));
  for (auto& [number, place] : index) {
    place = int_size(mesh.numbers);
    const auto node = nodes_.find(number);
    if (node == nodes_.end())
      fail(fmt::format("an element has the node {}, which is not there", number));
    mesh.positions.col(place) = node->second;
    mesh.numbers.push_back(number);
  }
  const std::unordered_map<int, int> materials = materials_of_elements();
  for (const WrittenElement& element : elements_) {
    const auto material = materials.find(element.number);
    mesh.elements.push_back(
        {element.shape, {}, material == materials.end() ? -1 : material->second});
    for (const int node : element.nodes) mesh.elements.back().nodes.push_back(index.at(node));
  }
  for (const auto& [name, numbers] : node_sets_) {
    std::vector<int>& set = mesh.node_sets[name];
    for (const int number : numbers) {
      if (index.contains(number)) set.push_back(index.at(number));
    }
    std::sort(set.begin(), set.end());
    set.erase(std::unique(set.begin(), set.end()), set.end());
  }
  return mesh;
}

}  // namespace

SolidMesh read_calculix_input(const fs::path& path) {
  InputReader reader;
  reader.read(path);
  SolidMesh mesh = reader.mesh();
  if (mesh.elements.empty()) {
    throw InputError(fmt::format("{}: has no solid elements (*ELEMENT, TYPE=C3D…)", path.string()));
  }
  return mesh;
}

}  // namespace pleuel
