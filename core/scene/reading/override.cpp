#include "core/scene/reading/override.hpp"

#include <algorithm>
#include <array>
#include <charconv>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/scene/reading/suggestion.hpp"
#include "core/scene/reading/unit_scanner.hpp"
#include "core/scene/units.hpp"

namespace pleuel {
namespace {

/// Objects that a file may leave out, and an override begin.
constexpr std::array optional_blocks = {
    "accuracy", "cases",     "constants",   "constraints", "effects",     "objective", "optimizer",
    "pareto",   "responses", "sensitivity", "simulation",  "uncertainty", "variables"};

/// The same within the scene.
constexpr std::array scene_blocks = {"joints", "loads", "materials"};

/// JSON, or a text.
Json read_value(const std::string& text) {
  try {
    return parse_json(text, "");
  } catch (const InputError&) {
    return Json(text);
  }
}

/// Of a number with a unit, "0.2 mm": "mm"; empty if the text is something else.
std::string unit_of_text(const std::string& text) {
  try {
    const std::string unit = split_quantity(text).unit;
    if (!unit.empty()) measure_unit(unit);
    return unit;
  } catch (const UnitError&) {
    return "";
  }
}

std::string shortest(double number) {
  return fmt::format("{:.6g}", number);
}

/// One assignment on its way down the document.
class Override {
 public:
  /// @param whose  how messages name the assignment
  Override(const std::string& whose, const std::string& file) : whose_(whose), file_(file) {}

  void apply(Json& document, const std::string& assignment) const {
    const std::size_t equals = assignment.find('=');
    if (equals == std::string::npos) fail("has no \"=\"; write /json/pointer=value");
    set(document, keys_to(document, assigned_place(assignment)),
        read_value(assignment.substr(equals + 1)));
  }

  void apply_at(Json& document, const std::string& pointer, const Json& value) const {
    set(document, split(pointer), value);
  }

 private:
  void set(Json& document, const std::vector<std::string>& keys, const Json& value) const {
    Json* place = &document;
    std::string pointer;
    for (std::size_t i = 0; i + 1 < keys.size(); ++i) {
      place = &child(*place, pointer, keys[i]);
      pointer = child_pointer(pointer, keys[i]);
    }
    if (place->is_object()) {
      (*place)[keys.back()] = value;
    } else {
      child(*place, pointer, keys.back()) = value;
    }
  }

  [[noreturn]] void fail(const std::string& rule) const {
    throw InputError(fmt::format("{}: {}: {}", file_, whose_, rule));
  }

  /// Of a pointer, or of the start of the design variable of this name.
  std::vector<std::string> keys_to(const Json& document, const std::string& place) const {
    if (!place.empty() && place.front() == '/') return split(place);
    const std::vector<std::string> known = keys_of(document, "variables");
    if (std::ranges::find(known, place) == known.end()) {
      const std::string rule = "must begin with a JSON pointer such as /simulation/step";
      const bool is_no_name = place.empty() || place.find('/') != std::string::npos;
      fail(is_no_name || known.empty()
               ? rule
               : rule + ", or with the name of a design variable" + hint(place, known));
    }
    return {"variables", place, "start"};
  }

  std::vector<std::string> split(const std::string& pointer) const {
    std::vector<std::string> keys;
    try {
      for (Json::json_pointer left(pointer); !left.empty(); left.pop_back()) {
        keys.insert(keys.begin(), left.back());
      }
    } catch (const Json::exception&) {
      fail("has a \"~\" that is neither ~0 (~) nor ~1 (/)");
    }
    return keys;
  }

  Json& child(Json& parent, const std::string& pointer, const std::string& key) const {
    if (parent.is_array()) return parent[index(parent.size(), pointer, key)];
    if (!parent.is_object()) fail(fmt::format("{} has no members", shown(pointer)));
    if (parent.contains(key)) return parent[key];
    const auto is_one_of = [&key](const auto& blocks) {
      return std::ranges::find(blocks, key) != blocks.end();
    };
    const bool is_block = (pointer.empty() && is_one_of(optional_blocks)) ||
                          (pointer == "/scene" && is_one_of(scene_blocks));
    if (is_block) return parent[key] = Json::object();
    fail(fmt::format("{} has no key \"{}\"{}", shown(pointer), key, hint(key, keys_of(parent))));
  }

  std::size_t index(std::size_t size, const std::string& pointer, const std::string& key) const {
    std::size_t index = 0;
    const char* end = key.data() + key.size();
    const auto [rest, status] = std::from_chars(key.data(), end, index);
    if (status != std::errc() || rest != end || index >= size) {
      fail(fmt::format("{} is a list of {} values, counted from 0, and has no \"{}\"",
                       shown(pointer), size, key));
    }
    return index;
  }

  static std::string shown(const std::string& pointer) {
    return pointer.empty() ? "the problem" : pointer;
  }

  const std::string whose_;
  const std::string& file_;
};

}  // namespace

void apply_override(Json& document, const std::string& assignment, const std::string& file) {
  Override("--set " + assignment, file).apply(document, assignment);
}

void require_unit(const Json& document, const std::string& assignment, const std::string& file) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos) return;
  const Json value = read_value(assignment.substr(equals + 1));
  if (!value.is_number() || value == 0) return;
  Json written;
  try {
    written = document.at(Json::json_pointer(assigned_pointer(assignment)));
  } catch (const Json::exception&) {
    return;  // it is not there, or no pointer: who sets it says so
  }
  const std::string unit = written.is_string() ? unit_of_text(written) : "";
  if (unit.empty()) return;
  const double number = value.get<double>(), in_unit = number / measure_unit(unit).scale;
  const std::string of_si =
      in_unit == number
          ? ""
          : fmt::format(", or \"{} {}\" if the number is in SI units", shortest(in_unit), unit);
  throw InputError(fmt::format("{}: --set {}: the file has \"{}\" there: write \"{} {}\"{}", file,
                               assignment, written.get<std::string>(), shortest(number), unit,
                               of_si));
}

void replace_at(Json& document, const std::string& pointer, const Json& value,
                const std::string& whose, const std::string& file) {
  Override(whose, file).apply_at(document, pointer, value);
}

std::string assigned_place(const std::string& assignment) {
  return trimmed(assignment.substr(0, assignment.find('=')));
}

std::string assigned_pointer(const std::string& assignment) {
  const std::string place = assigned_place(assignment);
  return place.starts_with("/") ? place : child_pointer("/variables", place) + "/start";
}

}  // namespace pleuel
