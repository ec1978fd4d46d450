#pragma once

#include <string_view>
#include <vector>

#include "core/scene/grammar/tables.hpp"
#include "core/scene/reading/json_node.hpp"
#include "core/scene/reading/number_reader.hpp"

/// Reads objects by their tables of keys (grammar/keys.hpp). Everything throws InputError.
namespace pleuel {

/// Fills the members of a table. Keys that are not there leave them as they are.
class KeyReader : public Keys {
 public:
  /// Both must outlive this.
  KeyReader(const JsonNode& node, NumberReader& numbers) : node_(node), numbers_(numbers) {}

  void number(const Key& key, Number& member, const Measure& measure, std::string_view) override;
  void fixed(const Key& key, Number& member, const Measure& measure, std::string_view) override;
  void fixed(const Key& key, double& member, const Measure& measure, std::string_view) override;
  void plain(const Key& key, double& member, Range range, std::string_view) override;
  void whole(const Key& key, int& member, const WholeRange& range, std::string_view) override;
  void tolerance(const Key& key, double& member, std::string_view) override;
  void flag(const Key& key, bool& member, std::string_view) override;
  void text(const Key& key, std::string& member, std::string_view) override;
  void point(const Key& key, std::array<Number, 3>& member, const Quantity& quantity,
             std::string_view) override;
  void direction(const Key& key, std::array<double, 3>& member, std::string_view) override;
  void unit_vector(const Key& key, std::array<double, 3>& member, std::string_view) override;
  void chosen(const Key& key, std::size_t& index, const std::vector<std::string_view>& words,
              std::string_view) override;
  void chosen_or_vector(const Key& key, std::size_t& index,
                        const std::vector<std::string_view>& words,
                        std::optional<std::array<double, 3>>& vector,
                        std::string_view sentence) override;
  void place(const Key& key, double& member, std::string_view) override;
  void name(const Key& key, const char* kind, const std::vector<std::string>& known,
            std::string& member, std::string_view) override;
  void names(const Key& key, const char* kind, const std::vector<std::string>& known,
             std::vector<std::string>& members, std::string_view) override;
  void two_names(const Key& key, const char* kind, const std::vector<std::string>& known,
                 std::array<std::string, 2>& members, std::string_view) override;
  void object(const Key& key, const Table& table) override;
  void items(const Key& key, std::string_view item, std::size_t, const ItemTable& table,
             std::string_view) override;
  void other(const Key& key, const char*, std::string_view) override { given(key); }

  void exclusive(const char* one, const char* other) override;
  void one_at_least(Words words) override;
  void together(const char* one, const char* other) override;
  void needs_one(const char* word, Words others, const char* rule) override;
  void must(const char* word, bool holds, const std::string& rule,
            Shown shown = Shown::rule) override;
  void must_item(const char* word, std::size_t index, bool holds, const std::string& rule) override;
  void refused(const char* word, const std::string& rule) override { must(word, false, rule); }
  void refused_choice(const char* key, const char* word, const std::string& rule) override;

  bool gives(const Key& key, bool) override { return given(key).has_value(); }

 private:
  bool has(const char* word) const { return node_.find(word).has_value(); }
  bool has_one(Words words) const;
  std::optional<JsonNode> given(const Key& key) const;

  const JsonNode& node_;
  NumberReader& numbers_;
};

/// The node has keys of the table, and these besides, only.
void read_keys(const JsonNode& node, NumberReader& numbers, const Keys::Table& table,
               const std::vector<std::string_view>& others = {});

/// What is not given stays as it is.
template <class Struct, class... Measures>
void read_keys(const JsonNode& node, NumberReader& numbers, Struct& into,
               const Measures&... measures) {
  read_keys(node, numbers, [&](Keys& keys) { describe(keys, into, measures...); });
}

}  // namespace pleuel
