#include "optimization/evaluation_store.hpp"

#include "core/base/packed.hpp"
#include "optimization/result.hpp"

namespace pleuel {

namespace {

enum class Question : char { find, keep, confirm };

}  // namespace

std::optional<StoredEvaluation> RemoteStore::find(const EvaluationKey& key) {
  return unpacked<std::optional<StoredEvaluation>>(caller_.ask(packed(Question::find, key)));
}

void RemoteStore::keep(const EvaluationKey& key, const StoredEvaluation& stored) {
  caller_.ask(packed(Question::keep, key, stored));
}

void RemoteStore::confirm(const EvaluationKey& key, const StoredEvaluation& again) {
  caller_.ask(packed(Question::confirm, key, again));
}

std::string reply_of(EvaluationStore& store, const std::string& question) {
  Unpacker unpacker(question);
  Question kind = Question::find;
  EvaluationKey key;
  unpacker(kind, key);
  if (kind == Question::find) return packed(store.find(key));
  StoredEvaluation stored;
  unpacker(stored);
  kind == Question::keep ? store.keep(key, stored) : store.confirm(key, stored);
  return "";
}

}  // namespace pleuel
