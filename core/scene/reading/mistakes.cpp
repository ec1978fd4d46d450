#include "core/scene/reading/mistakes.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace pleuel {

namespace {

constexpr std::size_t most_told = 12;

std::string list_of(const std::vector<std::string>& texts) {
  std::string list = fmt::format("{} mistakes:", texts.size());
  const std::size_t told = std::min(texts.size(), most_told);
  for (std::size_t i = 0; i < told; ++i) list += "\n" + texts[i];
  if (told < texts.size()) list += fmt::format("\n… and {} more", texts.size() - told);
  return list;
}

}  // namespace

Mistakes::Mistakes(std::vector<std::string> texts)
    : InputError(list_of(texts)), texts_(std::move(texts)) {}

std::vector<std::string> mistakes_of(const InputError& error) {
  if (const auto* several = dynamic_cast<const Mistakes*>(&error)) return several->texts();
  return {error.what()};
}

void fail_with(std::vector<std::string> texts) {
  if (texts.size() == 1) throw InputError(texts.front());
  throw Mistakes(std::move(texts));
}

void MistakeCollector::fail_if_any() const {
  if (!texts_.empty()) fail_with(texts_);
}

void MistakeCollector::add(const InputError& error) {
  for (std::string& text : mistakes_of(error)) {
    const bool is_known = std::ranges::find(texts_, text) != texts_.end();
    if (!is_known) texts_.push_back(std::move(text));
  }
}

}  // namespace pleuel
