#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "optimization/evaluation_store.hpp"
#include "optimization/result.hpp"
#include "record/sqlite.hpp"

namespace pleuel {

/// An evaluation of the record.
struct NumberedEvaluation {
  int number = 0;     ///< in the order of the record, from 1
  std::string ended;  ///< UTC: "2025-03-01T17:04:05.123Z"
  EvaluationKey key;
  std::string request;  ///< "values" or "gradients"
  StoredEvaluation stored;
};

/// The record of a run, run.sqlite: every evaluation with what it follows from, bit by bit, and the
/// way of the search. Each is a transaction (write-ahead log): whoever kills the program leaves all
/// evaluations that had ended, and a file that can be opened. Tables are told in
/// docs/reference/run-folder.md. Rows have checksums: damage is an error that names the row.
class RunDatabase : public EvaluationStore {
 public:
  /// Opens a record, or begins one where there is none.
  /// @throws DatabaseError if it is none of this kind, or cannot be read or written
  explicit RunDatabase(std::filesystem::path file);

  /// Reads all of it.
  /// @throws DatabaseError if something is damaged
  void check() const;

  /// What is said of the whole run: command, problem, versions …
  void describe(const std::string& name, const std::string& text);
  std::optional<std::string> description(const std::string& name) const;

  std::optional<StoredEvaluation> find(const EvaluationKey& key) override;
  void keep(const EvaluationKey& key, const StoredEvaluation& stored) override;
  void confirm(const EvaluationKey& key, const StoredEvaluation& again) override;

  std::optional<std::string> find_part(const std::string& name) const;
  void keep_part(const std::string& name, const std::string& content);

  /// Calls see() with all evaluations, in their order.
  void read_evaluations(const std::function<void(const NumberedEvaluation&)>& see) const;
  /// Evaluations that are kept.
  int evaluations() const;
  /// Evaluations that were found since it was opened.
  int found() const { return found_; }

  /// The way of the search, from the beginning.
  void clear_history();
  void add(const EvaluationRecord& record);

 private:
  std::int64_t setting_number(const std::string& text);

  mutable Database database_;
  std::unique_ptr<Statement> find_, keep_, add_;
  std::filesystem::path file_;
  std::int64_t last_older_ = 0;  ///< row that was there when it was opened
  int found_ = 0;
};

/// What to do with a record that is refused.
inline constexpr const char* begin_anew = "--overwrite begins anew, another folder keeps it";

/// "values" or "gradients"
std::string request_name(Request request);

/// Doubles as bytes, and back.
std::string bytes_of(const Eigen::VectorXd& values);
Eigen::VectorXd vector_of(const std::string& bytes);

}  // namespace pleuel
