#include <fmt/format.h>

#include "core/scene/reading/keyed_numbers.hpp"
#include "core/scene/reading/scene_reader.hpp"

namespace pleuel {
namespace {

using Reader = Section (*)(const JsonNode& node, NumberReader& numbers);

template <class OfType>
Section read_sizes(const JsonNode& node, NumberReader& numbers) {
  const auto keys = number_keys(KeysOf<OfType>());
  node.allow_keys(words_of(keys, {"type"}));
  OfType section;
  read_numbers(node, keys, numbers, section);
  return section;
}

/// A plain number, or what sections that are chosen from a list are made (section_choices.hpp).
Number read_of_point(const JsonNode& node, const NumberKey<GeneralStressPoint>& key,
                     NumberReader& numbers) {
  const bool is_path = node.value().is_object() && node.value().contains("path");
  if (is_path) return numbers.designable(node, key.quantity, key.range);
  return numbers.fixed(node, key.quantity, key.range);
}

GeneralStressPoint read_stress_point(const JsonNode& node, NumberReader& numbers) {
  constexpr auto keys = number_keys(KeysOf<GeneralStressPoint>());
  node.allow_keys(words_of(keys));
  GeneralStressPoint point;
  for (const NumberKey<GeneralStressPoint>& key : keys) {
    point.*std::get<0>(key.member) = read_of_point(node.at(std::string(key.word)), key, numbers);
  }
  return point;
}

Section read_general(const JsonNode& node, NumberReader& numbers) {
  const auto keys = number_keys(KeysOf<GeneralSection>());
  node.allow_keys(words_of(keys, {"type", "points"}));
  GeneralSection section;
  read_numbers(node, keys, numbers, section);
  const bool has_y = section.shear_area_y.has_value();
  if (has_y != section.shear_area_z.has_value()) {
    node.fail(fmt::format("has \"shear_area_{}\" without \"shear_area_{}\"", has_y ? 'y' : 'z',
                          has_y ? 'z' : 'y'));
  }
  const JsonNode points = node.at("points");
  for (const JsonNode& point : points.items()) {
    section.points.push_back(read_stress_point(point, numbers));
  }
  if (section.points.empty()) points.fail("must have at least one point");
  return section;
}

}  // namespace

Section read_section(const JsonNode& node, NumberReader& numbers) {
  const auto read =
      read_choice<Reader>(node.at("type"), {{"rectangle", read_sizes<RectangleSection>},
                                            {"circle", read_sizes<CircleSection>},
                                            {"tube", read_sizes<TubeSection>},
                                            {"ellipse", read_sizes<EllipseSection>},
                                            {"box", read_sizes<BoxSection>},
                                            {"i", read_sizes<ISection>},
                                            {"general", read_general}});
  return read(node, numbers);
}

}  // namespace pleuel
