#pragma once

#include <utility>

#include "cli/files/run_record.hpp"
#include "core/jobs/part_store.hpp"
#include "optimization/verdict.hpp"
#include "record/run_database.hpp"

namespace pleuel {

inline constexpr const char* database_name = "run.sqlite";

/// The record of evaluations in the folder of a run: what is known of an older run that this one
/// goes on with, and what comes. Like other results it begins with the first evaluation. One that
/// cannot be begun ends no run; one that cannot go on, as on a disk that fills up, stops it as Ctrl-C
/// does, so that what was recorded stays and --resume goes on from there.
class RunStore : public EvaluationStore, public PartStore {
 public:
  /// @param options  of the command, which have to be those of the older run
  /// @throws InputError if the run that shall go on is another one, or cannot be read
  RunStore(RunRecord& record, const Arguments& arguments, const ProblemInput& input, Json options);

  std::optional<StoredEvaluation> find(const EvaluationKey& key) override;
  void keep(const EvaluationKey& key, const StoredEvaluation& stored) override;
  void confirm(const EvaluationKey& key, const StoredEvaluation& again) override;

  std::optional<std::string> find_part(const std::string& name) override;
  void keep_part(const std::string& name, const std::string& content) override;

  /// An evaluation on the way of the search.
  void add(const EvaluationRecord& record);

  /// Keeps how the run ended; tells how to go on with one that was interrupted, and what was known of
  /// one that went on.
  void finish(Outcome& outcome);

 private:
  void open_older();
  void begin_without_record() const;
  void check_same_run() const;
  void describe_run();
  /// "34 of 50 evaluations were known from …" of a run that went on; else empty.
  std::string known_text() const;
  /// Does this on the record, if there is one that can be written.
  template <class Action>
  void attempt(const Action& action);
  void stop() const;

  RunRecord& record_;
  const Arguments& arguments_;
  Json description_;  ///< of this run
  std::optional<RunDatabase> database_;
  /// Kept with the next one: after the first one the backend may still refuse the problem.
  std::optional<std::pair<EvaluationKey, StoredEvaluation>> first_;
  bool goes_on_ = false;
  bool is_described_ = false;
  bool is_begun_ = false;  ///< something was recorded by this process
  bool has_failed_ = false;
  bool has_history_ = false;
  int known_ = 0, made_ = 0, confirmed_ = 0;
  int known_parts_ = 0, made_parts_ = 0;
};

}  // namespace pleuel
