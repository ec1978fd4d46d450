#include "core/scene/reading/section_choices.hpp"

#include <algorithm>
#include <map>
#include <numbers>

#include <fmt/format.h>

#include "core/scene/body_rules.hpp"
#include "core/scene/reading/mistakes.hpp"
#include "core/scene/reading/scene_reader.hpp"

namespace pleuel {

namespace {

/// Of a section without variables [m²].
struct Area {
  double operator()(const RectangleSection& s) const {
    return s.width.constant * s.height.constant;
  }
  double operator()(const CircleSection& s) const {
    return std::numbers::pi / 4.0 * s.diameter.constant * s.diameter.constant;
  }
  double operator()(const TubeSection& s) const {
    return std::numbers::pi * s.thickness.constant *
           (s.outer_diameter.constant - s.thickness.constant);
  }
  double operator()(const EllipseSection& s) const {
    return std::numbers::pi / 4.0 * s.width.constant * s.height.constant;
  }
  double operator()(const BoxSection& s) const {
    return 2.0 * s.thickness.constant *
           (s.width.constant + s.height.constant - 2.0 * s.thickness.constant);
  }
  double operator()(const ISection& s) const {
    return 2.0 * s.width.constant * s.flange_thickness.constant +
           (s.height.constant - 2.0 * s.flange_thickness.constant) * s.web_thickness.constant;
  }
  double operator()(const GeneralSection& s) const { return s.area.constant; }
};

/// A variable of the document whose choices are sections.
class SectionList {
 public:
  SectionList(const Json& document, const std::string& name, const std::string& file,
              const Json& catalogue)
      : name_(name), catalogue_(catalogue) {
    const JsonNode variable(document.at("variables").at(name), file,
                            child_pointer("/variables", name));
    variable.allow_keys({"start", "choices"});
    const JsonNode choices = variable.at("choices");
    for (const JsonNode& choice : choices.items()) {
      names_.push_back(read_known_name(choice, "section", keys_of(catalogue)));
    }
    if (names_.empty()) choices.fail("must have at least one choice");
    sort(file);
    check_kind(choices);
    start_ = (names_.size() - 1) / 2;
    if (const auto start = variable.find("start")) {
      const std::string first = read_known_name(*start, "choice", names_);
      start_ = static_cast<std::size_t>(std::ranges::find(names_, first) - names_.begin());
    }
  }

  Json variable() const {
    return {{"start", start_}, {"lower", 0}, {"upper", names_.size() - 1}, {"entries", names_}};
  }

  /// Numbers that all sections share stay as they are.
  Json section() const {
    Json section = at(0);
    for (auto& [key, value] : section.items()) {
      if (key == "type" || key == "$comment") continue;
      if (key == "points") {
        for (std::size_t i = 0; i < value.size(); ++i) write_point(value[i], i);
      } else {
        write(value, [name = key](const Json& one) { return one.at(name); });
      }
    }
    return section;
  }

 private:
  const Json& at(std::size_t i) const { return catalogue_.at(names_[i]); }

  void sort(const std::string& file) {
    std::map<std::string, double> areas;
    for (const std::string& name : names_) {
      NumberReader numbers({});
      const JsonNode node(catalogue_.at(name), file);
      areas[name] = std::visit(Area{}, read_section(node, numbers));
    }
    std::vector<std::string> once;
    for (const std::string& name : names_) {
      if (std::ranges::find(once, name) == once.end()) once.push_back(name);
    }
    names_ = std::move(once);
    std::ranges::stable_sort(names_, [&](const std::string& one, const std::string& other) {
      return areas.at(one) < areas.at(other);
    });
  }

  void check_kind(const JsonNode& choices) const {
    const auto kind_of = [](const Json& section) {
      const std::string type = section.at("type").get<std::string>();
      if (!section.contains("points")) return type;
      const bool has_areas = section.contains("shear_area_y");
      return fmt::format("{} with {} points{}", type, section.at("points").size(),
                         has_areas ? " and shear areas" : "");
    };
    for (std::size_t i = 1; i < names_.size(); ++i) {
      if (kind_of(at(i)) == kind_of(at(0))) continue;
      choices.fail(fmt::format(
          "must be sections of one type, but \"{}\" is of type {}, and \"{}\" of type {}: solve "
          "for each type by itself, and compare",
          names_[0], kind_of(at(0)), names_[i], kind_of(at(i))));
    }
  }

  template <class Value>
  void write(Json& place, const Value& value_of) const {
    Json path = Json::array();
    for (std::size_t i = 0; i < names_.size(); ++i) path.push_back(value_of(at(i)));
    const bool is_shared =
        std::ranges::all_of(path, [&](const Json& one) { return one == path.front(); });
    place = is_shared ? path.front() : Json{{"variable", name_}, {"path", path}};
  }

  void write_point(Json& point, std::size_t i) const {
    for (auto& [key, value] : point.items()) {
      if (key == "$comment") continue;
      write(value, [name = key, i](const Json& one) { return one.at("points").at(i).at(name); });
    }
  }

  std::string name_;
  const Json& catalogue_;
  std::vector<std::string> names_;
  std::size_t start_ = 0;
};

/// The variable that the section names. @throws InputError
std::string named_variable(const SectionReference& reference, const Json& document,
                           const std::string& file) {
  const JsonNode node(*reference.section, file, reference.pointer);
  node.allow_keys({"variable"});
  return read_known_name(node.at("variable"), "variable", keys_of(document, "variables"));
}

}  // namespace

void expand_section_choices(Json& document, const std::vector<SectionReference>& references,
                            const std::string& file, const Json& catalogue) {
  std::map<std::string, SectionList> lists;
  for (const SectionReference& reference : references) {
    const std::string name = named_variable(reference, document, file);
    if (catalogue.empty()) {
      JsonNode(*reference.section, file, reference.pointer)
          .fail("is chosen from a catalogue, but /scene names none: \"catalogue\": \"FILE\"");
    }
    const auto list = lists.try_emplace(name, document, name, file, catalogue).first;
    *reference.section = list->second.section();
  }
  for (const auto& [name, list] : lists) document["variables"][name] = list.variable();
}

void check_section(const JsonNode& node, const Section& section, const Design<double>& start) {
  for (const SectionRule& rule : section_rules(section)) {
    const auto broken = complaint(rule, start, rounding_tolerance);
    if (broken) node.at(rule.key).fail(*broken);
  }
}

}  // namespace pleuel
