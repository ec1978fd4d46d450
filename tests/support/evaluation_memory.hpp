#pragma once

#include <map>
#include <optional>
#include <string>

#include "optimization/evaluation_store.hpp"

namespace pleuel {

/// A store that keeps what it is told, and counts.
class EvaluationMemory : public EvaluationStore {
 public:
  std::optional<StoredEvaluation> find(const EvaluationKey& key) override {
    const auto found = kept_.find(text_of(key));
    if (found == kept_.end()) return std::nullopt;
    ++known;
    return found->second;
  }
  void keep(const EvaluationKey& key, const StoredEvaluation& stored) override {
    ++made;
    kept_[text_of(key)] = stored;
  }

  void confirm(const EvaluationKey& /*key*/, const StoredEvaluation& /*again*/) override {}

  int known = 0, made = 0;

 private:
  static std::string text_of(const EvaluationKey& key) {
    const auto* bytes = reinterpret_cast<const char*>(key.x.data());
    return key.setting + "|" + key.rows + "|" + key.method + "|" +
           (key.request == Request::values ? "v" : "g") +
           std::string(bytes, sizeof(double) * static_cast<std::size_t>(key.x.size()));
  }

  std::map<std::string, StoredEvaluation> kept_;
};

}  // namespace pleuel
