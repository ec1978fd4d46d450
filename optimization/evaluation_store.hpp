#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

#include "core/base/tasks.hpp"
#include "optimization/problem.hpp"

/// Evaluations that are kept, so that none has to be made twice.
namespace pleuel {

/// What an evaluation follows from, within one problem file; equal to the last bit or not at all.
struct EvaluationKey {
  std::string setting;  ///< what it is simulated with (setting_text.hpp)
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

}  // namespace pleuel
