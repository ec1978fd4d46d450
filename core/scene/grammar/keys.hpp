#pragma once

#include <functional>
#include <initializer_list>
#include <optional>

#include "core/scene/number.hpp"
#include "core/scene/units.hpp"

/// The keys of an object of the problem file. Each struct has one table, which says of every key its
/// word, the member it fills, what is allowed, and a sentence about it:
///
///     void describe(Keys& keys, CircleSection& section) {
///       keys.number("diameter", section.diameter, {quantities::length, Range::positive}, "{}");
///     }
///
/// Whoever goes through a table is a `Keys`: the reader (reading/key_reader.hpp), the writer of the
/// schema (reading/key_schema.hpp), the visit of all numbers (visit_numbers.hpp).
namespace pleuel {

/// A word, and whether an object may be without it: its member has its default then.
struct Key {
  constexpr Key(const char* key_word) : word(key_word) {}  // NOLINT: a word is a key
  constexpr Key(const char* key_word, bool is_needed) : word(key_word), is_required(is_needed) {}

  std::string_view word;
  bool is_required = true;
  bool has_default = true;  ///< if it is left out; else it has no value at all then
};
constexpr Key optional_key(const char* word) {
  return {word, false};
}

/// What a number measures, and what it may be.
struct Measure {
  Quantity quantity;
  Range range = Range::any;
};

/// Whole numbers from `least` to `most`.
struct WholeRange {
  int least = 0, most = 0;
};

/// Whether a message shows the value that is wrong.
enum class Shown { rule, rule_and_value };

/// In a sentence "{}" stands for unit and range of a number.
class Keys {
 public:
  using Table = std::function<void(Keys&)>;
  using ItemTable = std::function<void(std::size_t index, Keys&)>;
  using Words = std::initializer_list<const char*>;
  virtual ~Keys() = default;

  /// A sentence about the object.
  virtual void about(std::string_view) {}
  /// What is done with each key, whatever its kind.
  virtual void each(const Key&) {}

  /// That a design variable may stand for.
  virtual void number(const Key& key, Number&, const Measure&, std::string_view) { each(key); }
  /// That only the choice of a whole section changes (reading/section_choices.hpp).
  virtual void fixed(const Key& key, Number&, const Measure&, std::string_view) { each(key); }
  virtual void fixed(const Key& key, double&, const Measure&, std::string_view) { each(key); }
  virtual void whole(const Key& key, int&, const WholeRange&, std::string_view) { each(key); }
  /// A number that is written without unit or formula.
  virtual void plain(const Key& key, double&, Range, std::string_view) { each(key); }
  /// A relative error, between 0 and 1.
  virtual void tolerance(const Key& key, double&, std::string_view) { each(key); }
  virtual void flag(const Key& key, bool&, std::string_view) { each(key); }
  virtual void text(const Key& key, std::string&, std::string_view) { each(key); }
  /// Three numbers that design variables may stand for.
  virtual void point(const Key& key, std::array<Number, 3>&, const Quantity&, std::string_view) {
    each(key);
  }
  /// Three plain numbers, not all zero.
  virtual void direction(const Key& key, std::array<double, 3>&, std::string_view) { each(key); }
  virtual void unit_vector(const Key& key, std::array<double, 3>&, std::string_view) { each(key); }
  /// @param chosen  index among the words
  virtual void chosen(const Key& key, std::size_t&, const std::vector<std::string_view>&,
                      std::string_view) {
    each(key);
  }
  /// The same, or a vector that is made a unit vector.
  virtual void chosen_or_vector(const Key& key, std::size_t&, const std::vector<std::string_view>&,
                                std::optional<std::array<double, 3>>&, std::string_view) {
    each(key);
  }
  /// A place along a beam, from 0 to 1.
  virtual void place(const Key& key, double&, std::string_view) { each(key); }
  /// One of the known names.
  /// @param kind  of thing
  virtual void name(const Key& key, const char* /*kind*/, const std::vector<std::string>& /*known*/,
                    std::string&, std::string_view) {
    each(key);
  }
  /// Several of them, each once.
  virtual void names(const Key& key, const char* /*kind*/,
                     const std::vector<std::string>& /*known*/, std::vector<std::string>&,
                     std::string_view) {
    each(key);
  }
  virtual void two_names(const Key& key, const char* /*kind*/,
                         const std::vector<std::string>& /*known*/, std::array<std::string, 2>&,
                         std::string_view) {
    each(key);
  }
  virtual void object(const Key& key, const Table&) { each(key); }
  /// @param item   what one of them is called
  /// @param count  that there are before anything is read
  virtual void items(const Key& key, std::string_view /*item*/, std::size_t /*count*/,
                     const ItemTable&, std::string_view) {
    each(key);
  }
  /// That needs to know more than this object: its reader stands elsewhere.
  /// @param definition  of the schema
  virtual void other(const Key& key, const char* /*definition*/, std::string_view) { each(key); }

  /// Rules between keys.
  virtual void exclusive(const char*, const char*) {}
  virtual void one_at_least(Words) {}
  virtual void together(const char*, const char*) {}
  /// The first is there only with one of the others.
  virtual void needs_one(const char*, Words, const char* /*rule*/) {}
  /// Of a key that is there.
  virtual void must(const char* /*word*/, bool /*holds*/, const std::string& /*rule*/,
                    Shown = Shown::rule) {}

  /// Of an item of a list that is there.
  virtual void must_item(const char* /*word*/, std::size_t /*index*/, bool /*holds*/,
                         const std::string& /*rule*/) {}
  /// A key that objects of this kind do not have, and why.
  virtual void refused(const char* /*word*/, const std::string& /*rule*/) {}
  /// A word that other objects have for a choice.
  virtual void refused_choice(const char* /*key*/, const char* /*word*/,
                              const std::string& /*rule*/) {}

  /// Whether a member that may have no value is to have one.
  virtual bool gives(const Key&, bool has_value) { return has_value; }

  // Members that may have no value.

  void number(Key key, std::optional<Number>& member, const Measure& measure,
              std::string_view sentence) {
    if (Number* value = optional_member(key, member)) number(key, *value, measure, sentence);
  }
  void fixed(Key key, std::optional<double>& member, const Measure& measure,
             std::string_view sentence) {
    if (double* value = optional_member(key, member)) fixed(key, *value, measure, sentence);
  }
  void whole(Key key, std::optional<int>& member, const WholeRange& range,
             std::string_view sentence) {
    if (int* value = optional_member(key, member)) whole(key, *value, range, sentence);
  }
  void point(Key key, std::optional<std::array<Number, 3>>& member, const Quantity& quantity,
             std::string_view sentence) {
    if (auto* value = optional_member(key, member)) point(key, *value, quantity, sentence);
  }
  void direction(Key key, std::optional<std::array<double, 3>>& member, std::string_view sentence) {
    if (auto* value = optional_member(key, member)) direction(key, *value, sentence);
  }

  void place(Key key, std::optional<double>& member, std::string_view sentence) {
    if (double* value = optional_member(key, member)) place(key, *value, sentence);
  }

  template <class Meaning, std::size_t count>
  void choice(const Key& key, Meaning& member, const Choice<Meaning> (&choices)[count],
              std::string_view sentence) {
    std::vector<std::string_view> words;
    std::size_t index = count;
    for (const Choice<Meaning>& one : choices) {
      if (one.meaning == member) index = words.size();
      words.push_back(one.word);
    }
    chosen(key, index, words, sentence);
    if (index < count) member = choices[index].meaning;
  }

  template <class Meaning, std::size_t count>
  void choice(Key key, std::optional<Meaning>& member, const Choice<Meaning> (&choices)[count],
              std::string_view sentence) {
    if (Meaning* value = optional_member(key, member)) choice(key, *value, choices, sentence);
  }
  template <class Meaning, std::size_t count>
  void choice_or_vector(const Key& key, Meaning& member, const Choice<Meaning> (&choices)[count],
                        std::optional<std::array<double, 3>>& vector, std::string_view sentence) {
    std::vector<std::string_view> words;
    for (const Choice<Meaning>& one : choices) words.push_back(one.word);
    std::size_t index = count;
    chosen_or_vector(key, index, words, vector, sentence);
    if (index < count) member = choices[index].meaning;
  }

  /// By the table of the struct.
  template <class Struct, class... Measures>
  void object(const Key& key, Struct& member, const Measures&... measures) {
    object(key, [&](Keys& keys) { describe(keys, member, measures...); });
  }
  template <class Struct>
  void object(Key key, std::optional<Struct>& member) {
    if (Struct* value = optional_member(key, member)) object(key, *value);
  }
  template <class Struct>
  void list(const Key& key, std::string_view item, std::vector<Struct>& members,
            std::string_view sentence) {
    const auto table = [&](std::size_t i, Keys& keys) {
      if (i == members.size()) members.emplace_back();
      describe(keys, members[i]);
    };
    items(key, item, members.size(), table, sentence);
  }

 private:
  template <class Value>
  Value* optional_member(Key& key, std::optional<Value>& member) {
    key.has_default = false;
    if (!gives(key, member.has_value())) return nullptr;
    if (!member) member.emplace();
    return &*member;
  }
};

/// One of the kinds of an object, which its key "type" names.
template <class Variant>
struct ObjectKind {
  std::string_view word;
  Variant made;  ///< with its defaults
};

}  // namespace pleuel
