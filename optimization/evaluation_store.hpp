#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "core/base/packed.hpp"
#include "core/jobs/tasks.hpp"
#include "optimization/problem.hpp"

/// Evaluations that are kept, so that none has to be made twice.
namespace pleuel {

/// What an evaluation follows from, within one problem file; equal to the last bit or not at all.
struct EvaluationKey {
  std::string setting;  ///< what it is simulated with (setting_text())
  std::string rows;     ///< what stands for the constraints
  std::string method;   ///< how gradients are computed; empty where that is chosen with it
  Request request = Request::values;
  Eigen::VectorXd x;  ///< [SI]
};

struct StoredEvaluation {
  Evaluation evaluation;  ///< empty after a failure
  std::string failure;    ///< why there is none
  /// Of gradients: how they were computed, and why so.
  std::string method, reason;
  double seconds = 0.0;  ///< that it took
  int older_row = 0;     ///< in the record that this run goes on with; 0: it was made by this run
};

class EvaluationStore {
 public:
  virtual ~EvaluationStore() = default;
  virtual std::optional<StoredEvaluation> find(const EvaluationKey& key) = 0;
  virtual void keep(const EvaluationKey& key, const StoredEvaluation& stored) = 0;
  /// An older evaluation was made again.
  /// @throws InputError if it differs by more than round-off
  virtual void confirm(const EvaluationKey& key, const StoredEvaluation& again) = 0;
};

/// The store of the process that handed out a task, for the task.
class RemoteStore : public EvaluationStore {
 public:
  explicit RemoteStore(TaskCaller& caller) : caller_(caller) {}
  std::optional<StoredEvaluation> find(const EvaluationKey& key) override;
  void keep(const EvaluationKey& key, const StoredEvaluation& stored) override;
  void confirm(const EvaluationKey& key, const StoredEvaluation& again) override;

 private:
  TaskCaller& caller_;
};

/// What Tasks::reply() says to a RemoteStore.
std::string reply_of(EvaluationStore& store, const std::string& question);

/// Who carries out evaluations, and who keeps them.
struct Execution {
  TaskOptions tasks = {};
  EvaluationStore* store = nullptr;  ///< none: nothing is kept
};

// Tasks that any process of the program can make again from their data, with the evaluations that are
// kept. The data are a plain struct that can be packed (core/base/packed.hpp):
//
//     struct Data {
//       static constexpr const char* kind = "…";  // by which the work is made again
//       std::string run(int task, const std::string& needed, TaskCaller& caller,
//                       EvaluationStore* store) const;  // see TaskWork::run(); no store: null
//     };

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

/// Tasks of which nothing but their answers is kept, in the order of the tasks. Their data say besides:
///
///     using Answer = …;
///     int count() const;
///     std::optional<int> needed_by(int task) const;  // may be missing, see Tasks
///     Answer lost(int task, const std::string& failure) const;  // in place of one that there is none of
template <class Data>
class AnsweredTasks : public StoredTasks<Data> {
 public:
  using Answer = typename Data::Answer;

  /// @param see  hears of each answer; may be empty
  AnsweredTasks(Data data, EvaluationStore* store, std::function<void(const Answer&)> see = {})
      : StoredTasks<Data>(std::move(data), store), see_(std::move(see)) {}

  int count() const override { return this->data().count(); }
  std::optional<int> needed_by(int task) const override {
    if constexpr (requires { this->data().needed_by(task); }) return this->data().needed_by(task);
    return std::nullopt;
  }
  void take(int /*task*/, const std::string& answer) override { keep(unpacked<Answer>(answer)); }
  void fail(int task, const std::string& failure) override {
    keep(this->data().lost(task, failure));
  }

  std::vector<Answer> take_answers() { return std::move(answers_); }

 private:
  void keep(Answer answer) {
    if (see_) see_(answer);
    answers_.push_back(std::move(answer));
  }

  std::function<void(const Answer&)> see_;
  std::vector<Answer> answers_;
};

}  // namespace pleuel
