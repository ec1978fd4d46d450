#include "core/scene/reading/key_schema.hpp"

#include <iterator>

#include <fmt/format.h>

#include "core/scene/grammar/response_table.hpp"
#include "core/scene/grammar/tables.hpp"
#include "core/scene/joint_kind.hpp"
#include "core/scene/response_kind.hpp"

namespace pleuel {

namespace {

Json reference(const std::string& definition) {
  return {{"$ref", "#/definitions/" + definition}};
}

Json limited(const Json& type, Range range) {
  Json schema = {{"type", type}};
  schema.update(Json::parse(kind_of(range).limits));
  return schema;
}

/// "[m], positive"
std::string measure_text(const Measure& measure) {
  std::string range = kind_of(measure.range).rule;  // "not be negative"
  range.erase(range.find("be"), 3);
  if (measure.quantity == quantities::pure_number) return range;
  return fmt::format("[{}]{}{}", measure.quantity.unit, range.empty() ? "" : ", ", range);
}

/// An object by its table.
class ObjectSchema : public Keys {
 public:
  /// @param type  what "type" says, where it has this key
  explicit ObjectSchema(std::string_view type = "") {
    schema_["type"] = "object";
    schema_["additionalProperties"] = false;
    properties_["$comment"] = reference("comment");
    if (type.empty()) return;
    required_.push_back("type");
    properties_["type"] = {{"const", type}};
  }

  Json take() {
    if (!required_.empty()) schema_["required"] = std::move(required_);
    if (!rules_.empty()) schema_["allOf"] = std::move(rules_);
    schema_["properties"] = std::move(properties_);
    return std::move(schema_);
  }

  void about(std::string_view sentence) override { schema_["description"] = sentence; }

  void number(const Key& key, KeyMember<Number> member, const Measure& measure,
              std::string_view sentence) override {
    const std::string standard = member.has_default() ? shown(member.get().constant) : "";
    add(key, reference("designable"), sentence, standard, measure);
  }
  void fixed(const Key& key, KeyMember<Number>, const Measure& measure,
             std::string_view sentence) override {
    add(key, reference("quantity"), sentence, "", measure);
  }
  void fixed(const Key& key, KeyMember<double> member, const Measure& measure,
             std::string_view sentence) override {
    const bool is_plain = measure.quantity == quantities::pure_number;
    add(key, is_plain ? limited({"number", "string"}, measure.range) : reference("quantity"),
        sentence, member.has_default() ? shown(member.get()) : "", measure);
  }
  void whole(const Key& key, KeyMember<int> member, const WholeRange& range,
             std::string_view sentence) override {
    add(key, {{"type", "integer"}, {"minimum", range.least}, {"maximum", range.most}}, sentence,
        member.has_default() ? shown(member.get()) : "");
  }
  void plain(const Key& key, double& member, Range range, std::string_view sentence) override {
    add(key, limited("number", range), sentence, shown(member), {quantities::pure_number, range});
  }
  void flag(const Key& key, bool& member, std::string_view sentence) override {
    add(key, {{"type", "boolean"}}, sentence, member ? "true" : "false");
  }
  void text(const Key& key, std::string& member, std::string_view sentence) override {
    add(key, reference("name"), sentence, member);
  }
  void point(const Key& key, KeyMember<std::array<Number, 3>>, const Quantity& quantity,
             std::string_view sentence) override {
    add(key, reference("point"), sentence, "", {quantity});
  }
  void direction(const Key& key, KeyMember<std::array<double, 3>>,
                 std::string_view sentence) override {
    add(key, reference("direction"), sentence);
  }
  void unit_vector(const Key& key, std::array<double, 3>&, std::string_view sentence) override {
    add(key, reference("direction"), sentence);
  }
  void chosen(const Key& key, std::size_t& index, const std::vector<std::string_view>& words,
              std::string_view sentence) override {
    const bool has_default = index < words.size();
    add(key, {{"enum", words}}, sentence, has_default ? std::string(words[index]) : "");
  }
  void chosen_or_vector(const Key& key, std::size_t&, const std::vector<std::string_view>& words,
                        std::optional<std::array<double, 3>>&, std::string_view sentence) override {
    const Json either = Json::array({{{"enum", words}}, reference("direction")});
    add(key, {{"anyOf", either}}, sentence);
  }
  void place(const Key& key, KeyMember<double>, std::string_view sentence) override {
    add(key, reference("place"), sentence);
  }
  void name(const Key& key, const char*, const std::vector<std::string>&, std::string&,
            std::string_view sentence) override {
    add(key, reference("name"), sentence);
  }
  void names(const Key& key, const char*, const std::vector<std::string>&,
             std::vector<std::string>&, std::string_view sentence) override {
    add(key, reference("names"), sentence);
  }
  void two_names(const Key& key, const char*, const std::vector<std::string>&,
                 std::array<std::string, 2>&, std::string_view sentence) override {
    add(key, reference("two_names"), sentence);
  }
  void object(const Key& key, const Table& table) override {
    ObjectSchema inner;
    table(inner);
    add(key, inner.take(), "");
  }
  void items(const Key& key, const char*, const ItemTable& table,
             std::string_view sentence) override {
    ObjectSchema item;
    table(0, item);
    add(key, {{"type", "array"}, {"minItems", 1}, {"items", item.take()}}, sentence);
  }
  void other(const Key& key, const char* definition, std::string_view sentence) override {
    add(key, reference(definition), sentence);
  }

  void exclusive(const char* one, const char* other) override {
    rules_.push_back({{"not", {{"required", {one, other}}}}});
  }
  void one_at_least(Words words) override { rules_.push_back(one_of(words)); }
  void together(const char* one, const char* other) override {
    schema_["dependencies"] = {{one, Json::array({other})}, {other, Json::array({one})}};
  }
  void needs_one(const char* word, Words others, const char*) override {
    rules_.push_back({{"if", one_of({word})}, {"then", one_of(others)}});
  }

 private:
  static Json one_of(Words words) {
    Json any = Json::array();
    for (const char* word : words) any.push_back({{"required", Json::array({word})}});
    return {{"anyOf", any}};
  }
  static std::string shown(double value) { return fmt::format("{:g}", value); }

  /// The sentence with unit, range and default.
  static std::string description(std::string sentence, const Measure& measure,
                                 const std::string& standard) {
    const std::size_t place = sentence.find("{}");
    if (place != std::string::npos) sentence.replace(place, 2, measure_text(measure));
    if (standard.empty() || sentence.find("efault") != std::string::npos) return sentence;
    return fmt::format("{}{}Default {}.", sentence, sentence.empty() ? "" : " ", standard);
  }

  /// @param standard  what counts if it is left out
  void add(const Key& key, Json property, std::string_view sentence,
           const std::string& standard = "", const Measure& measure = {quantities::pure_number}) {
    const std::string word(key.word);
    const std::string text =
        description(std::string(sentence), measure, key.is_required ? "" : standard);
    if (!text.empty()) property["description"] = text;
    properties_[word] = std::move(property);
    if (key.is_required) required_.push_back(word);
  }

  Json schema_ = Json::object(), properties_ = Json::object();
  Json required_ = Json::array(), rules_ = Json::array();
};

template <class Struct, class... Measures>
Json schema_of(std::string_view type, Struct object, const Measures&... measures) {
  ObjectSchema schema(type);
  describe(schema, object, measures...);
  return schema.take();
}

/// What holds for objects of one type.
Json of_type(std::string_view type, Json schema) {
  schema.erase("type");
  return {{"if", {{"required", {"type"}}, {"properties", {{"type", {{"const", type}}}}}}},
          {"then", std::move(schema)}};
}

/// Schemas of the types of an object.
using TypedSchemas = std::vector<std::pair<std::string_view, Json>>;

/// Makes a definition one of objects of several types. What else it says stays.
/// @param rules  of objects without a type
void set_types(Json& definition, const TypedSchemas& types, Json rules = Json::array()) {
  Json words = Json::array();
  for (const auto& [type, schema] : types) {
    words.push_back(type);
    rules.push_back(of_type(type, schema));
  }
  definition["type"] = "object";
  definition.erase("additionalProperties");
  definition["properties"] = {{"type", definition["properties"]["type"]}};
  definition["properties"]["type"]["enum"] = words;
  definition["allOf"] = rules;
}

void take_sections(Json& definition) {
  TypedSchemas types;
  for (const ObjectKind<Section>& kind : section_kinds()) {
    types.emplace_back(kind.word, schema_of(kind.word, kind.made));
  }
  const Json by_name = definition["allOf"][0], by_variable = definition["allOf"][1];
  set_types(definition, types, Json::array({by_name, by_variable}));
}

void take_joints(Json& definition) {
  TypedSchemas types;
  for (const JointKind& kind : joint_kinds) {
    Joint joint;
    joint.type = kind.type;
    types.emplace_back(kind.word, schema_of(kind.word, joint));
  }
  definition["required"] = Json::array({"type"});
  set_types(definition, types);
}

void take_responses(Json& definition) {
  const Scene nothing;
  const ResponseScope scope{nothing, 1.0};
  TypedSchemas types;
  for (const ResponseKind& kind : response_kinds()) {
    const ResponseSettings response{.what = kind.made};
    types.emplace_back(kind.word, schema_of(kind.word, response, scope));
  }
  set_types(definition, types);
}

void take_loads(Json& definition, const AlongCoordinate& either) {
  set_types(definition, {{"force", schema_of("force", PointLoad{LoadKind::force})},
                         {"torque", schema_of("torque", PointLoad{LoadKind::torque})},
                         {"spring", schema_of("spring", SpringDamper())},
                         {"joint", schema_of("joint", JointForce(), either)}});
}

/// An elastic body with what its motion begins with.
Json moving(Json body) {
  for (const char* key : {"velocity", "angular_velocity", "initial_deflections"}) {
    body["properties"][key] = reference(key);
  }
  return body;
}

/// Units of what acts along an angle, and along a displacement.
AlongCoordinate along_either() {
  constexpr const char* name = "a quantity";
  return {{name, "rad] or [m"},
          {name, "rad/s] or [m/s"},
          {name, "N m] or [N"},
          {name, "N m/rad] or [N/m"},
          {name, "N m s/rad] or [N s/m"}};
}

}  // namespace

Json with_tables(Json schema) {
  Json& all = schema["definitions"];
  take_sections(all["section"]);
  take_joints(all["joint"]);
  take_responses(all["response"]);
  all["material"] = schema_of("", Material());
  all["damping"] = schema_of("", Damping());
  all["imported"] = moving(schema_of("invariants", ImportedBody()));
  all["generator"] = schema_of("", BodyGenerator());
  all["initial_deflections"]["items"] = schema_of("", InitialDeflection());
  const AlongCoordinate either = along_either();
  take_loads(all["load"], either);
  all["control"] = schema_of("control", MotorControl(), either);
  all["friction"] = schema_of("friction", FrictionLaw(), either);
  all["clearance"] = schema_of("clearance", ClearanceLaw(), either);
  all["half_sine"] = schema_of("half-sine", HalfSineFunction(), either.force);
  all["simulation"] = schema_of("", SimulationSettings());
  all["sensitivity"] = schema_of("", SensitivitySettings());
  all["effects"] = schema_of("", EffectSettings());
  all["optimizer"] = schema_of("", OptimizerSettings());
  all["reduction"] = schema_of("", CraigBampton());
  all["segment"] = schema_of("", Segment());
  return schema;
}

std::string schema_text(const Json& schema) {
  return schema.dump(2) + "\n";
}

}  // namespace pleuel
