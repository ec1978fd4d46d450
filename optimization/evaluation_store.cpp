#include "optimization/evaluation_store.hpp"

#include "optimization/result.hpp"

namespace pleuel {

namespace {

enum class StoreRequest : char { find, keep, confirm };

}  // namespace

std::optional<StoredEvaluation> RemoteStore::find(const EvaluationKey& key) {
  return unpacked<std::optional<StoredEvaluation>>(caller_.ask(packed(StoreRequest::find, key)));
}

void RemoteStore::keep(const EvaluationKey& key, const StoredEvaluation& stored) {
  caller_.ask(packed(StoreRequest::keep, key, stored));
}

void RemoteStore::confirm(const EvaluationKey& key, const StoredEvaluation& again) {
  caller_.ask(packed(StoreRequest::confirm, key, again));
}

std::string reply_of(EvaluationStore& store, const std::string& question) {
  Unpacker unpacker(question);
  StoreRequest kind = StoreRequest::find;
  EvaluationKey key;
  unpacker(kind, key);
  if (kind == StoreRequest::find) return packed(store.find(key));
  StoredEvaluation stored;
  unpacker(stored);
  kind == StoreRequest::keep ? store.keep(key, stored) : store.confirm(key, stored);
  return "";
}

}  // namespace pleuel
