#include "core/scene/reading/key_reader.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/scene/reading/suggestion.hpp"

namespace pleuel {

namespace {

class WordList : public Keys {
 public:
  void each(const Key& key) override {
    if (std::ranges::find(words, key.word) == words.end()) words.push_back(key.word);
  }
  void refused(const char* word, const std::string& rule) override {
    refusals.emplace_back(word, rule);
  }

  std::vector<std::string_view> words;
  std::vector<std::pair<const char*, std::string>> refusals;
};

/// Fills the members of a table. Keys that are not there leave them as they are.
class KeyReader : public Keys {
 public:
  /// Both must outlive this.
  KeyReader(const JsonNode& node, NumberReader& numbers) : node_(node), numbers_(numbers) {}

  void number(const Key& key, KeyMember<Number> member, const Measure& measure,
              std::string_view) override {
    if (const auto value = given(key)) {
      member.get() = numbers_.designable(*value, measure.quantity, measure.range);
    }
  }

  void fixed(const Key& key, KeyMember<Number> member, const Measure& measure,
             std::string_view sentence) override {
    const auto value = given(key);
    if (!value) return;
    const bool is_path = value->value().is_object() && value->value().contains("path");
    if (is_path) return number(key, member, measure, sentence);
    member.get() = numbers_.fixed(*value, measure.quantity, measure.range);
  }

  void fixed(const Key& key, KeyMember<double> member, const Measure& measure,
             std::string_view) override {
    if (const auto value = given(key)) {
      member.get() = numbers_.fixed(*value, measure.quantity, measure.range);
    }
  }

  void whole(const Key& key, KeyMember<int> member, const WholeRange& range,
             std::string_view) override {
    if (const auto value = given(key)) member.get() = value->whole_number(range.least, range.most);
  }

  void plain(const Key& key, double& member, Range range, std::string_view) override {
    const auto value = given(key);
    if (!value) return;
    member = value->number();
    if (!is_within(range, member)) value->fail_with_value(rule_of(range, quantities::pure_number));
  }

  void flag(const Key& key, bool& member, std::string_view) override {
    if (const auto value = given(key)) member = value->truth();
  }

  void text(const Key& key, std::string& member, std::string_view) override {
    if (const auto value = given(key)) member = value->text();
  }

  void point(const Key& key, KeyMember<std::array<Number, 3>> member, const Quantity& quantity,
             std::string_view) override {
    if (const auto value = given(key)) member.get() = numbers_.triple(*value, quantity);
  }

  void direction(const Key& key, KeyMember<std::array<double, 3>> member,
                 std::string_view) override {
    if (const auto value = given(key)) member.get() = numbers_.direction(*value);
  }

  void unit_vector(const Key& key, std::array<double, 3>& member, std::string_view) override {
    if (const auto value = given(key)) member = numbers_.unit_vector(*value);
  }

  void chosen(const Key& key, std::size_t& index, const std::vector<std::string_view>& words,
              std::string_view) override {
    const auto value = given(key);
    if (!value) return;
    const auto is_meant = [&](std::string_view word) {
      return value->value() == std::string(word);
    };
    const auto found = std::ranges::find_if(words, is_meant);
    if (found == words.end()) fail_choice(*value, {words.begin(), words.end()});
    index = static_cast<std::size_t>(found - words.begin());
  }

  void chosen_or_vector(const Key& key, std::size_t& index,
                        const std::vector<std::string_view>& words,
                        std::optional<std::array<double, 3>>& vector,
                        std::string_view sentence) override {
    const auto value = given(key);
    if (!value || !value->value().is_array()) return chosen(key, index, words, sentence);
    vector = numbers_.unit_vector(*value);
  }

  void place(const Key& key, KeyMember<double> member, std::string_view) override {
    const auto value = given(key);
    if (!value) return;
    if (!value->value().is_number() || !is_within(Range::fraction, value->number())) {
      value->fail_with_value("must be a place along the beam from 0 to 1");
    }
    member.get() = value->number();
  }

  void name(const Key& key, const char* kind, const std::vector<std::string>& known,
            std::string& member, std::string_view) override {
    if (const auto value = given(key)) member = read_known_name(*value, kind, known);
  }

  void names(const Key& key, const char* kind, const std::vector<std::string>& known,
             std::vector<std::string>& members, std::string_view) override {
    const auto list = given(key);
    if (!list) return;
    std::vector<std::string> read;
    for (const JsonNode& item : list->items()) {
      const std::string name = read_known_name(item, kind, known);
      if (std::ranges::find(read, name) != read.end()) {
        item.fail(fmt::format("names the {} \"{}\" a second time", kind, name));
      }
      read.push_back(name);
    }
    if (read.empty()) list->fail(fmt::format("must name at least one {}", kind));
    members = std::move(read);
  }

  void two_names(const Key& key, const char* kind, const std::vector<std::string>& known,
                 std::array<std::string, 2>& members, std::string_view) override {
    const auto list = given(key);
    if (!list) return;
    const std::vector<JsonNode> items = list->items(2);
    members = {read_known_name(items[0], kind, known), read_known_name(items[1], kind, known)};
  }

  void object(const Key& key, const Table& table) override {
    if (const auto value = given(key)) read_keys(*value, numbers_, table);
  }

  void items(const Key& key, const char* item, const ItemTable& table, std::string_view) override {
    const auto list = given(key);
    if (!list) return;
    const std::vector<JsonNode> nodes = list->items();
    if (nodes.empty()) list->fail(fmt::format("must have at least one {}", item));
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      read_keys(nodes[i], numbers_, [&](Keys& keys) { table(i, keys); });
    }
  }

  void other(const Key& key, const char*, std::string_view) override { given(key); }

  void exclusive(const char* one, const char* other) override {
    if (has(one) && has(other)) node_.fail(fmt::format("has both \"{}\" and \"{}\"", one, other));
  }

  void one_at_least(Words words) override {
    if (has_one(words)) return;
    node_.fail(fmt::format("needs {}", quoted_list({words.begin(), words.end()}, "or")));
  }

  void together(const char* one, const char* other) override {
    const bool has_one = has(one);
    if (has_one == has(other)) return;
    node_.fail(
        fmt::format("has \"{}\" without \"{}\"", has_one ? one : other, has_one ? other : one));
  }

  void needs_one(const char* word, Words others, const char* rule) override {
    if (has(word) && !has_one(others)) node_.at(word).fail(rule);
  }

  void must(const char* word, bool holds, const std::string& rule, Shown shown) override {
    if (holds) return;
    const auto value = node_.find(word);
    if (!value) return;
    if (shown == Shown::rule_and_value) value->fail_with_value(rule);
    value->fail(rule);
  }

  void must_item(const char* word, std::size_t index, bool holds,
                 const std::string& rule) override {
    if (holds) return;
    const auto list = node_.find(word);
    if (list) list->items().at(index).fail(rule);
  }

  void refused(const char* word, const std::string& rule) override {
    must(word, false, rule, Shown::rule);
  }
  void refused_choice(const char* key, const char* word, const std::string& rule) override {
    const auto value = node_.find(key);
    if (value && value->value() == word) value->fail_with_value(rule);
  }

 private:
  bool has(const char* word) const { return node_.find(word).has_value(); }
  bool has_one(Words words) const {
    return std::ranges::any_of(words, [&](const char* word) { return has(word); });
  }

  std::optional<JsonNode> given(const Key& key) const {
    const std::string word(key.word);
    return key.is_required ? node_.at(word) : node_.find(word);
  }

  const JsonNode& node_;
  NumberReader& numbers_;
};

}  // namespace

void read_keys(const JsonNode& node, NumberReader& numbers, const Keys::Table& table,
               const std::vector<std::string_view>& others) {
  WordList list;
  list.words = others;
  table(list);
  for (const auto& [word, rule] : list.refusals) {
    if (const auto value = node.find(word)) value->fail(rule);
  }
  node.allow_keys(list.words);
  KeyReader reader(node, numbers);
  table(reader);
}

}  // namespace pleuel
