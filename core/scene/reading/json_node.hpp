#pragma once

#include <filesystem>
#include <optional>
#include <utility>

#include "core/scene/kind_table.hpp"
#include "core/scene/reading/json_text.hpp"

namespace pleuel {

class JsonNode;
using JsonMembers = std::vector<std::pair<std::string, JsonNode>>;

/// A value of the document that knows where it is, so that every complaint can say so. Refers to
/// the document and the name of the file: both must outlive it. Everything throws InputError.
class JsonNode {
 public:
  /// @param whole  how messages name the whole document.
  JsonNode(const Json& value, const std::string& file, std::string pointer = "",
           const std::string& whole = "the problem");

  const Json& value() const { return *value_; }

  /// How messages name the file.
  const std::string& file() const { return *file_; }

  /// Where it is, for a message: the JSON pointer, or what the whole document is called.
  const std::string& place() const { return place_; }

  /// "file: pointer rule"
  std::string message(const std::string& rule) const;

  /// Ends the reading with the message.
  [[noreturn]] void fail(const std::string& rule) const;
  /// Ends the reading with "file: pointer rule, got value", and what else there is to say.
  [[noreturn]] void fail_with_value(const std::string& rule, const std::string& more = "") const;

  /// Must be an object whose keys are all among these.
  void allow_keys(const std::vector<std::string_view>& known) const;
  JsonNode at(const std::string& key) const;  ///< must be there
  std::optional<JsonNode> find(const std::string& key) const;
  JsonMembers members() const;                          ///< of an object with free, non-empty names
  std::vector<JsonNode> items() const;                  ///< of a list
  std::vector<JsonNode> items(std::size_t size) const;  ///< of a list of this length

  double number() const;
  int whole_number(int least, int most) const;
  std::string text() const;  ///< not empty
  bool truth() const;        ///< true or false
  /// Of the file that the text names, from the folder of this one on: it must be there.
  std::filesystem::path named_file() const;

 private:
  void expect_object() const;

  const Json* value_;
  const std::string* file_;
  std::string pointer_;
  std::string place_;
};

/// Ends the reading: the node's text is none of the words.
[[noreturn]] void fail_choice(const JsonNode& node, const std::vector<std::string>& words);

/// The row of a table whose word is the node's text, which must be one of them.
template <class Table>
const auto& read_row(const JsonNode& node, Table&& table) {
  std::vector<std::string> words;
  for (const auto& row : table) {
    words.emplace_back(row.word);
    if (node.value() == words.back()) return row;
  }
  fail_choice(node, words);
}

/// What the node's text, which must be one of the words, means.
template <class Meaning, std::size_t count>
Meaning read_choice(const JsonNode& node, const Choice<Meaning> (&choices)[count]) {
  return read_row(node, choices).meaning;
}

/// Ends the reading: `names the unknown material "stel"; did you mean "steel"?`
[[noreturn]] void fail_unknown_name(const JsonNode& node, std::string_view kind,
                                    const std::string& name, const std::vector<std::string>& known);

/// The node's text, which must be one of the known names of this kind of thing.
std::string read_known_name(const JsonNode& node, std::string_view kind,
                            const std::vector<std::string>& known);

}  // namespace pleuel
