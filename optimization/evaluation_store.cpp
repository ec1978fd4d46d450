#include "optimization/evaluation_store.hpp"

#include "optimization/packed_result.hpp"

namespace pleuel {

namespace {

enum class Question : char { find, keep };

}  // namespace

template <class Archive>
void transfer(Archive& archive, EvaluationKey& key) {
  auto& [setting, rows, method, request, x] = key;
  archive(setting, rows, method, request, x);
}

template <class Archive>
void transfer(Archive& archive, StoredEvaluation& stored) {
  auto& [evaluation, failure, method, reason, seconds] = stored;
  archive(evaluation, failure, method, reason, seconds);
}

std::optional<StoredEvaluation> RemoteStore::find(const EvaluationKey& key) {
  return unpacked<std::optional<StoredEvaluation>>(caller_.ask(packed(Question::find, key)));
}

void RemoteStore::keep(const EvaluationKey& key, const StoredEvaluation& stored) {
  caller_.ask(packed(Question::keep, key, stored));
}

std::string reply_of(EvaluationStore& store, const std::string& question) {
  Unpacker unpacker(question);
  Question kind = Question::find;
  EvaluationKey key;
  unpacker(kind, key);
  if (kind == Question::find) return packed(store.find(key));
  StoredEvaluation stored;
  unpacker(stored);
  store.keep(key, stored);
  return "";
}

}  // namespace pleuel
