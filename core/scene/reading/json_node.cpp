#include "core/scene/reading/json_node.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/error.hpp"
#include "core/base/quoted.hpp"
#include "core/scene/reading/suggestion.hpp"

namespace pleuel {
namespace {

std::string shown(const Json& value) {
  return excerpt(value.dump(-1, ' ', false, Json::error_handler_t::replace), 60);
}

}  // namespace

JsonNode::JsonNode(const Json& value, const std::string& file, std::string pointer,
                   const std::string& whole)
    : value_(&value),
      file_(&file),
      pointer_(std::move(pointer)),
      place_(pointer_.empty() ? whole : pointer_) {}

std::string JsonNode::message(const std::string& rule) const {
  return fmt::format("{}: {} {}", *file_, place_, rule);
}

void JsonNode::fail(const std::string& rule) const {
  throw InputError(message(rule));
}

void JsonNode::fail_with_value(const std::string& rule, const std::string& more) const {
  fail(fmt::format("{}, got {}{}", rule, shown(*value_), more));
}

void JsonNode::expect_object() const {
  if (!value_->is_object()) fail_with_value("must be an object {…}");
}

void JsonNode::allow_keys(const std::vector<std::string_view>& known) const {
  expect_object();
  for (const auto& [key, member] : value_->items()) {
    if (std::ranges::find(known, key) != known.end()) continue;
    const std::vector<std::string> words(known.begin(), known.end());
    fail(fmt::format("has the unknown key \"{}\"{}", key, hint(key, words)));
  }
}

JsonNode JsonNode::at(const std::string& key) const {
  if (std::optional<JsonNode> child = find(key)) return *child;
  const std::string similar = closest(key, keys_of(*value_));
  fail(fmt::format("is missing the key \"{}\"{}", key,
                   similar.empty() ? "" : fmt::format("; is \"{}\" a misspelling?", similar)));
}

std::optional<JsonNode> JsonNode::find(const std::string& key) const {
  expect_object();
  const auto member = value_->find(key);
  if (member == value_->end()) return std::nullopt;
  return JsonNode(*member, *file_, child_pointer(pointer_, key));
}

JsonMembers JsonNode::members() const {
  expect_object();
  JsonMembers members;
  for (const auto& [key, member] : value_->items()) {
    if (key.empty()) fail("has a member without a name");
    members.emplace_back(key, JsonNode(member, *file_, child_pointer(pointer_, key)));
  }
  return members;
}

std::vector<JsonNode> JsonNode::items() const {
  if (!value_->is_array()) fail_with_value("must be a list […]");
  std::vector<JsonNode> items;
  for (std::size_t i = 0; i < value_->size(); ++i) {
    items.emplace_back((*value_)[i], *file_, child_pointer(pointer_, std::to_string(i)));
  }
  return items;
}

std::vector<JsonNode> JsonNode::items(std::size_t size) const {
  const bool is_right = value_->is_array() && value_->size() == size;
  if (!is_right) fail_with_value(fmt::format("must be a list of {} values", size));
  return items();
}

double JsonNode::number() const {
  if (!value_->is_number()) fail_with_value("must be a number");
  return value_->get<double>();
}

int JsonNode::whole_number(int least, int most) const {
  const double number = value_->is_number() ? value_->get<double>() : 0.5;
  if (number != std::floor(number) || number < least || number > most) {
    fail_with_value(fmt::format("must be a whole number from {} to {}", least, most));
  }
  return static_cast<int>(number);
}

std::string JsonNode::text() const {
  const bool is_text = value_->is_string() && !value_->get_ref<const std::string&>().empty();
  if (!is_text) fail_with_value("must be a text in quotes, not empty");
  return value_->get<std::string>();
}

std::filesystem::path JsonNode::named_file() const {
  namespace fs = std::filesystem;
  const fs::path path = fs::path(file()).parent_path() / text();
  std::error_code error;
  const fs::file_type type = fs::status(path, error).type();
  if (type == fs::file_type::directory) fail_with_value("must name a file, no folder");
  if (type == fs::file_type::not_found || type == fs::file_type::none) {
    fail(fmt::format("names the file {}, which is not there (names count from the folder of {} on)",
                     path.string(), fs::path(file()).filename().string()));
  }
  return path;
}

bool JsonNode::truth() const {
  if (!value_->is_boolean()) fail_with_value("must be true or false");
  return value_->get<bool>();
}

void fail_choice(const JsonNode& node, const std::vector<std::string>& words) {
  const std::string rule = fmt::format("must be {}", quoted_list(words, "or"));
  if (!node.value().is_string()) node.fail_with_value(rule);
  const std::string meant = meant_by(node.value().get<std::string>(), words);
  node.fail_with_value(rule, meant.empty() ? "" : fmt::format("; did you mean \"{}\"?", meant));
}

void fail_unknown_name(const JsonNode& node, std::string_view kind, const std::string& name,
                       const std::vector<std::string>& known) {
  const std::size_t open = name.rfind('[');
  if (kind == "response" && open != std::string::npos &&
      name.find(']', open) == std::string::npos) {
    node.fail(fmt::format(
        "has an error at column {} of \"{}\": the bracket [ of a load case is not closed; write "
        "\"name[case]\"",
        open + 1, name));
  }
  node.fail(fmt::format("names the unknown {} \"{}\"{}", kind, name, hint(name, known)));
}

std::string read_known_name(const JsonNode& node, std::string_view kind,
                            const std::vector<std::string>& known) {
  if (!node.value().is_string()) {
    const bool is_short = !known.empty() && known.size() <= 12;  // a catalogue is not
    node.fail_with_value(fmt::format("must be the name of a {}{}", kind,
                                     is_short ? ": " + quoted_list(known, "or") : ""));
  }
  const std::string name = node.text();
  if (std::ranges::find(known, name) == known.end()) {
    fail_unknown_name(node, kind, name, known);
  }
  return name;
}

}  // namespace pleuel
