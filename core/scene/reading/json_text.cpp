#include "core/scene/reading/json_text.hpp"

#include <unordered_set>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/scene/reading/syntax_error.hpp"

namespace pleuel {
namespace {

/// A remark of the author. Objects may have one, and nobody else sees it.
constexpr const char* comment_key = "$comment";

/// Builds the document event by event; `open_` holds the objects and lists not yet closed.
class DocumentBuilder : public nlohmann::json_sax<Json> {
 public:
  DocumentBuilder(const std::string& text, const std::string& file) : text_(text), file_(file) {}

  Json take() { return std::move(document_); }

  bool null() override { return add(Json(nullptr)); }
  bool boolean(bool value) override { return add(Json(value)); }
  bool number_integer(number_integer_t value) override { return add(Json(value)); }
  bool number_unsigned(number_unsigned_t value) override { return add(Json(value)); }
  bool number_float(number_float_t value, const string_t&) override { return add(Json(value)); }
  bool string(string_t& value) override {
    if (has_control_character(value, "\t\r\n")) {
      throw InputError(
          fmt::format("{}: the text of {} has a control character; of those texts may have tabs "
                      "and line breaks",
                      file_, open_.empty() ? "the document" : pointer_of_next()));
    }
    return add(Json(value));
  }
  bool binary(binary_t&) override { return false; }  // JSON text has no such thing

  bool start_object(std::size_t) override { return open(Json::object()); }
  bool start_array(std::size_t) override { return open(Json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& key) override {
    if (has_control_character(key)) {
      throw InputError(
          fmt::format("{}: a name in {} has a control character, which no name may have", file_,
                      open_.back().pointer.empty() ? "the document" : open_.back().pointer));
    }
    if (!open_.back().keys.insert(key).second) {
      throw InputError(
          fmt::format("{}: {} is there twice", file_, child_pointer(open_.back().pointer, key)));
    }
    key_ = key;
    return true;
  }

  bool parse_error(std::size_t position, const std::string&,
                   const nlohmann::json::exception& error) override {
    throw InputError(
        fmt::format("{}: {}", file_, describe_syntax_error(text_, position, error.what())));
  }

 private:
  struct Open {
    Json* value;
    std::string pointer;
    std::unordered_set<std::string> keys = {};  ///< of an object: a look-up in it would be linear
  };

  std::string pointer_of_next() const {
    if (open_.empty()) return "";
    const Json& parent = *open_.back().value;
    return child_pointer(open_.back().pointer,
                         parent.is_array() ? std::to_string(parent.size()) : key_);
  }

  Json* place(Json&& value) {
    if (open_.empty()) return &(document_ = std::move(value));
    Json& parent = *open_.back().value;
    if (parent.is_object()) {
      auto& members = parent.get_ref<Json::object_t&>();
      return &members.std::vector<Json::object_t::value_type>::emplace_back(key_, std::move(value))
                  .second;
    }
    parent.push_back(std::move(value));
    return &parent.back();
  }

  bool add(Json&& value) {
    place(std::move(value));
    return true;
  }

  bool open(Json&& empty) {
    std::string pointer = pointer_of_next();
    if (open_.size() >= deepest_nesting) {
      throw InputError(
          fmt::format("{}: {} is nested deeper than {} levels", file_, pointer, deepest_nesting));
    }
    Json* value = place(std::move(empty));
    open_.push_back({value, std::move(pointer)});
    return true;
  }

  bool close() {
    if (open_.back().keys.count(comment_key) > 0) open_.back().value->erase(comment_key);
    open_.pop_back();
    return true;
  }

  const std::string& text_;
  const std::string& file_;
  Json document_;
  std::vector<Open> open_;
  std::string key_;
};

}  // namespace

Json parse_json(const std::string& text, const std::string& file) {
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) {
    throw InputError(fmt::format("{}: is empty; a problem file is a JSON object", file));
  }
  DocumentBuilder builder(text, file);
  Json::sax_parse(text, &builder);
  return builder.take();
}

std::vector<std::string> keys_of(const Json& object) {
  std::vector<std::string> keys;
  if (!object.is_object()) return keys;
  for (const auto& [key, member] : object.items()) keys.push_back(key);
  return keys;
}

std::vector<std::string> keys_of(const Json& parent, const char* key) {
  return parent.is_object() && parent.contains(key) ? keys_of(parent[key])
                                                    : std::vector<std::string>();
}

std::string child_pointer(const std::string& parent, const std::string& key) {
  const bool is_plain = key.find_first_of("~/") == std::string::npos;
  return parent + (is_plain ? "/" + key : (Json::json_pointer() / key).to_string());
}

}  // namespace pleuel
