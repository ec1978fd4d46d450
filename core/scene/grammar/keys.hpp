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
/// Whoever goes through a table is a `Keys`: the reader (reading/key_reader.hpp), and the writer of the
/// schema (reading/key_schema.hpp).
namespace pleuel {

/// A word, and whether an object may be without it: its member has its default then, or no value.
struct Key {
  constexpr Key(const char* key_word) : word(key_word) {}  // NOLINT: a word is a key
  constexpr Key(const char* key_word, bool is_needed) : word(key_word), is_required(is_needed) {}

  std::string_view word;
  bool is_required = true;
};
constexpr Key optional_key(const char* word) {
  return {word, false};
}

/// A member that a key fills, and that may have no value without it.
template <class Value>
class KeyMember {
 public:
  KeyMember(Value& member) : value_(&member) {}                    // NOLINT: a member is one
  KeyMember(std::optional<Value>& member) : optional_(&member) {}  // NOLINT

  bool has_default() const { return optional_ == nullptr; }
  /// It has a value from now on.
  Value& get() const {
    if (value_ != nullptr) return *value_;
    return *optional_ ? **optional_ : optional_->emplace();
  }

 private:
  Value* value_ = nullptr;
  std::optional<Value>* optional_ = nullptr;
};

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
  virtual void number(const Key& key, KeyMember<Number>, const Measure&, std::string_view) {
    each(key);
  }
  /// That only the choice of a whole section changes (reading/section_choices.hpp).
  virtual void fixed(const Key& key, KeyMember<Number>, const Measure&, std::string_view) {
    each(key);
  }
  virtual void fixed(const Key& key, KeyMember<double>, const Measure&, std::string_view) {
    each(key);
  }
  virtual void whole(const Key& key, KeyMember<int>, const WholeRange&, std::string_view) {
    each(key);
  }
  /// A number that is written without unit or formula.
  virtual void plain(const Key& key, double&, Range, std::string_view) { each(key); }
  virtual void flag(const Key& key, bool&, std::string_view) { each(key); }
  virtual void text(const Key& key, std::string&, std::string_view) { each(key); }
  /// Three numbers that design variables may stand for.
  virtual void point(const Key& key, KeyMember<std::array<Number, 3>>, const Quantity&,
                     std::string_view) {
    each(key);
  }
  /// Three plain numbers, not all zero.
  virtual void direction(const Key& key, KeyMember<std::array<double, 3>>, std::string_view) {
    each(key);
  }
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
  virtual void place(const Key& key, KeyMember<double>, std::string_view) { each(key); }
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
  /// @param item  what one of them is called
  virtual void items(const Key& key, const char* /*item*/, const ItemTable&, std::string_view) {
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

  template <class Member, class Meaning, std::size_t count>
  void choice(const Key& key, Member& member, const Choice<Meaning> (&choices)[count],
              std::string_view sentence) {
    std::vector<std::string_view> words;
    std::size_t index = count;
    for (const Choice<Meaning>& one : choices) {
      if (member == one.meaning) index = words.size();
      words.push_back(one.word);
    }
    chosen(key, index, words, sentence);
    if (index < count) member = choices[index].meaning;
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
  void object(const Key& key, std::optional<Struct>& member) {
    object(key, [&](Keys& keys) { describe(keys, KeyMember<Struct>(member).get()); });
  }
  template <class Struct>
  void list(const Key& key, const char* item, std::vector<Struct>& members,
            std::string_view sentence) {
    const auto table = [&](std::size_t i, Keys& keys) {
      if (i == members.size()) members.emplace_back();
      describe(keys, members[i]);
    };
    items(key, item, table, sentence);
  }
};

/// One of the kinds of an object, which its key "type" names.
template <class Variant>
struct ObjectKind {
  std::string_view word;
  Variant made;  ///< with its defaults
};

}  // namespace pleuel
