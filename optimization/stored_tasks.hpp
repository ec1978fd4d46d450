#pragma once

#include <memory>
#include <string>
#include <utility>

#include "core/base/packed.hpp"
#include "core/base/tasks.hpp"
#include "optimization/evaluation_store.hpp"

/// Tasks that any process of the program can make again from their data, with the evaluations that are
/// kept. The data are a plain struct that can be packed (core/base/packed.hpp):
///
///     struct Data {
///       static constexpr const char* kind = "…";  // by which the work is made again
///       std::string run(int task, const std::string& needed, TaskCaller& caller,
///                       EvaluationStore* store) const;  // see TaskWork::run(); no store: null
///     };
namespace pleuel {

template <class Data>
struct StoredWork : TaskWork {
  Data data;
  bool has_store = false;

  std::string run(int task, const std::string& needed, TaskCaller& caller) override {
    RemoteStore store(caller);
    return data.run(task, needed, caller, has_store ? &store : nullptr);
  }
};

/// @param content  of the packed_work() of StoredTasks
template <class Data>
std::unique_ptr<TaskWork> make_stored_work(const std::string& content) {
  auto work = std::make_unique<StoredWork<Data>>();
  unpack(content, work->data, work->has_store);
  return work;
}

template <class Data>
class StoredTasks : public Tasks {
 public:
  /// @param store  outlives this; null: nothing is kept
  StoredTasks(Data data, EvaluationStore* store) : store_(store) {
    work_.data = std::move(data);
    work_.has_store = store != nullptr;
  }

  PackedWork packed_work() const override {
    return {Data::kind, packed(work_.data, work_.has_store)};
  }

  std::string run(int task, const std::string& needed, TaskCaller& caller) override {
    return work_.run(task, needed, caller);
  }

  std::string reply(int /*task*/, const std::string& question) override {
    return reply_of(*store_, question);
  }

 protected:
  const Data& data() const { return work_.data; }

 private:
  StoredWork<Data> work_;
  EvaluationStore* store_;
};

}  // namespace pleuel
