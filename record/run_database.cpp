#include "record/run_database.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/fingerprint.hpp"
#include "core/base/packed.hpp"

namespace pleuel {

namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr int application = 0x506c6575;  // "Pleu"
constexpr int layout = 2;

constexpr const char* tables = R"(
BEGIN IMMEDIATE;
CREATE TABLE run(name TEXT PRIMARY KEY, value TEXT NOT NULL, checksum INTEGER NOT NULL);
CREATE TABLE settings(setting INTEGER PRIMARY KEY, text TEXT NOT NULL UNIQUE);
CREATE TABLE evaluations(
  id INTEGER PRIMARY KEY,
  ended TEXT NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ', 'now')),
  seconds REAL NOT NULL,
  setting INTEGER NOT NULL REFERENCES settings,
  rows TEXT NOT NULL,
  request TEXT NOT NULL,
  asked_method TEXT NOT NULL,
  design BLOB NOT NULL,
  failure TEXT,
  objective REAL,
  constraints BLOB,
  objective_gradient BLOB,
  constraint_gradients BLOB,
  method TEXT NOT NULL,
  reason TEXT NOT NULL,
  checksum INTEGER NOT NULL);
CREATE UNIQUE INDEX evaluation_key
  ON evaluations(design, setting, rows, request, asked_method);
CREATE TABLE parts(
  name TEXT PRIMARY KEY,
  ended TEXT NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ', 'now')),
  content BLOB NOT NULL,
  checksum INTEGER NOT NULL);
CREATE TABLE history(
  evaluation INTEGER PRIMARY KEY,
  iteration INTEGER NOT NULL,
  purpose TEXT NOT NULL,
  request TEXT NOT NULL,
  seconds REAL NOT NULL,
  design BLOB NOT NULL,
  failure TEXT,
  objective REAL,
  constraints BLOB,
  max_violation REAL,
  step REAL NOT NULL,
  time_step REAL NOT NULL,
  elements INTEGER NOT NULL);
)";

std::string bytes_of(const double* values, Eigen::Index count) {
  return {reinterpret_cast<const char*>(values), static_cast<std::size_t>(count) * sizeof(double)};
}

Request request_of(const std::string& name) {
  return name == "values" ? Request::values : Request::values_and_gradients;
}

/// What is no number is NULL there.
double number_or_nan(const Statement& statement, int column) {
  return statement.is_null(column) ? std::numeric_limits<double>::quiet_NaN()
                                   : statement.number(column);
}

Eigen::MatrixXd matrix_of(const std::string& bytes, Eigen::Index columns) {
  const Eigen::VectorXd values = vector_of(bytes);
  const Eigen::Index rows = columns > 0 ? values.size() / columns : 0;
  return Eigen::Map<const RowMajor>(values.data(), rows, columns);
}

std::int64_t integer_of(Database& database, const std::string& question) {
  Statement statement(database, question);
  statement.step();
  return statement.integer(0);
}

constexpr const char* stored_columns =
    "failure, objective, constraints, objective_gradient, constraint_gradients, method, reason, "
    "seconds, asked_method, checksum, id";

template <class... Parts>
std::int64_t checksum_of(const Parts&... parts) {
  Fingerprint fingerprint;
  fingerprint.add(packed(parts...));
  return static_cast<std::int64_t>(fingerprint.number());
}

/// What a table holds of it: no numbers of what failed, no sign of zero and of what is no number.
StoredEvaluation as_stored(StoredEvaluation stored) {
  if (!stored.failure.empty()) stored.evaluation = {};
  double& objective = stored.evaluation.objective;
  objective = std::isnan(objective) ? std::numeric_limits<double>::quiet_NaN() : objective + 0.0;
  return stored;
}

void check_row(bool is_whole, const std::string& row, const std::string& table) {
  if (is_whole) return;
  throw DatabaseError(fmt::format(
      "row {} of the table {} does not match its checksum: the file is damaged", row, table));
}

/// What a statement about this name finds first.
std::optional<std::string> named_text(Statement& row, const std::string& name,
                                      const std::string& table) {
  row.bind(1, name);
  if (!row.step()) return std::nullopt;
  std::string text = row.blob(0);
  check_row(checksum_of(name, text) == row.integer(1), name, table);
  return text;
}

/// From a row that begins with these columns.
StoredEvaluation unchecked_in(const Statement& row, const EvaluationKey& key) {
  StoredEvaluation stored;
  stored.failure = row.text(0);
  stored.method = row.text(5);
  stored.reason = row.text(6);
  stored.seconds = row.number(7);
  if (!row.is_null(0)) return stored;
  stored.evaluation.objective = number_or_nan(row, 1);
  stored.evaluation.constraints = vector_of(row.blob(2));
  if (key.request == Request::values) return stored;
  stored.evaluation.objective_gradient = vector_of(row.blob(3));
  stored.evaluation.constraint_jacobian = matrix_of(row.blob(4), key.x.size());
  return stored;
}

StoredEvaluation stored_in(const Statement& row, EvaluationKey key) {
  StoredEvaluation stored = unchecked_in(row, key);
  key.method = row.text(8);
  check_row(checksum_of(key, stored) == row.integer(9), row.text(10), "evaluations");
  return stored;
}

/// Of two evaluations of a design; more than what another processor rounds otherwise.
constexpr double round_off = 1e-6;

bool is_same(const Eigen::VectorXd& one, const Eigen::VectorXd& other) {
  return one.size() == other.size() &&
         !((one - other).lpNorm<Eigen::Infinity>() >
           round_off * std::max(one.lpNorm<Eigen::Infinity>(), other.lpNorm<Eigen::Infinity>()));
}

/// Number by number, and gradients as changes by relative changes of the variables.
std::vector<Eigen::VectorXd> parts_of(const Evaluation& evaluation, const Eigen::VectorXd& x) {
  std::vector<Eigen::VectorXd> parts = {Eigen::VectorXd::Constant(1, evaluation.objective)};
  for (const double value : evaluation.constraints) {
    parts.push_back(Eigen::VectorXd::Constant(1, value));
  }
  if (!evaluation.has_gradients()) return parts;
  const Eigen::VectorXd size = x.unaryExpr([](double v) { return v == 0.0 ? 1.0 : v; });
  parts.push_back(evaluation.objective_gradient.cwiseProduct(size));
  for (const auto& row : evaluation.constraint_jacobian.rowwise()) {
    parts.push_back(row.transpose().cwiseProduct(size));
  }
  return parts;
}

void prepare(Database& database) {
  if (integer_of(database, "SELECT count(*) FROM sqlite_master") == 0) {
    // Safe against the end of the program; that of the machine may cost the last evaluations.
    database.execute("PRAGMA journal_mode = WAL; PRAGMA synchronous = NORMAL;");
    database.execute(fmt::format("{} PRAGMA application_id = {}; PRAGMA user_version = {}; COMMIT;",
                                 tables, application, layout));
    return;
  }
  if (integer_of(database, "PRAGMA application_id") != application) {
    throw DatabaseError("this is no record of a run of Pleuel");
  }
  if (integer_of(database, "PRAGMA user_version") != layout) {
    throw DatabaseError("this is the record of another version of Pleuel");
  }
  database.execute("PRAGMA synchronous = NORMAL;");
}

}  // namespace

std::string request_name(Request request) {
  return request == Request::values ? "values" : "gradients";
}

std::string bytes_of(const Eigen::VectorXd& values) {
  return bytes_of(values.data(), values.size());
}

Eigen::VectorXd vector_of(const std::string& bytes) {
  Eigen::VectorXd values(bytes.size() / sizeof(double));
  if (values.size() > 0) {
    std::memcpy(values.data(), bytes.data(),
                static_cast<std::size_t>(values.size()) * sizeof(double));
  }
  return values;
}

RunDatabase::RunDatabase(std::filesystem::path file) : database_(file), file_(std::move(file)) {
  prepare(database_);
  last_older_ = integer_of(database_, "SELECT coalesce(max(id), 0) FROM evaluations");
  find_ = std::make_unique<Statement>(database_, fmt::format(R"(
    SELECT {} FROM evaluations JOIN settings USING (setting)
    WHERE design = ?1 AND settings.text = ?2 AND rows = ?3 AND request = ?4
      AND (asked_method = ?5 OR (?5 <> '' AND method = ?5)))",
                                                             stored_columns));
  keep_ = std::make_unique<Statement>(database_, R"(
    INSERT OR IGNORE INTO evaluations(design, setting, rows, request, asked_method, failure,
      objective, constraints, objective_gradient, constraint_gradients, method, reason, seconds,
      checksum)
    VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13, ?14))");
  add_ = std::make_unique<Statement>(
      database_,
      "INSERT OR REPLACE INTO history VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, "
      "?11, ?12, ?13)");
}

void RunDatabase::check() const {
  Statement whole(database_, "PRAGMA integrity_check(1)");
  whole.step();
  if (whole.text(0) != "ok") throw DatabaseError("the file is damaged: " + whole.text(0));
  read_evaluations([](const NumberedEvaluation&) {});
  for (Statement row(database_, "SELECT name FROM run"); row.step();) description(row.text(0));
  for (Statement row(database_, "SELECT name FROM parts"); row.step();) find_part(row.text(0));
}

void RunDatabase::describe(const std::string& name, const std::string& text) {
  Statement statement(database_, "INSERT OR REPLACE INTO run VALUES (?1, ?2, ?3)");
  statement.bind(1, name).bind(2, text).bind(3, checksum_of(name, text)).run();
}

std::optional<std::string> RunDatabase::description(const std::string& name) const {
  Statement row(database_, "SELECT value, checksum FROM run WHERE name = ?1");
  return named_text(row, name, "run");
}

std::optional<StoredEvaluation> RunDatabase::find(const EvaluationKey& key) {
  Statement& row = *find_;
  row.bind_blob(1, bytes_of(key.x)).bind(2, key.setting).bind(3, key.rows);
  row.bind(4, request_name(key.request)).bind(5, key.method);
  std::optional<StoredEvaluation> stored;
  if (row.step()) {
    stored = stored_in(row, key);
    if (row.integer(10) <= last_older_) stored->older_row = static_cast<int>(row.integer(10));
  }
  row.reset();
  found_ += stored ? 1 : 0;
  return stored;
}

std::optional<std::string> RunDatabase::find_part(const std::string& name) const {
  Statement row(database_, "SELECT content, checksum FROM parts WHERE name = ?1");
  return named_text(row, name, "parts");
}

void RunDatabase::keep_part(const std::string& name, const std::string& content) {
  Statement row(database_,
                "INSERT OR REPLACE INTO parts(name, content, checksum) VALUES (?1, ?2, ?3)");
  row.bind(1, name).bind_blob(2, content).bind(3, checksum_of(name, content)).run();
}

void RunDatabase::read_evaluations(
    const std::function<void(const NumberedEvaluation&)>& see) const {
  Statement row(database_, fmt::format("SELECT {}, ended, settings.text, rows, request, "
                                       "design FROM evaluations JOIN settings USING "
                                       "(setting) ORDER BY id",
                                       stored_columns));
  NumberedEvaluation one;
  while (row.step()) {
    ++one.number;
    one.ended = row.text(11);
    one.request = row.text(14);
    one.key = {row.text(12), row.text(13), row.text(8), request_of(one.request),
               vector_of(row.blob(15))};
    one.stored = stored_in(row, one.key);
    see(one);
  }
}

void RunDatabase::keep(const EvaluationKey& key, const StoredEvaluation& stored) {
  Statement& row = *keep_;
  const StoredEvaluation kept = as_stored(stored);
  const Evaluation& evaluation = kept.evaluation;
  row.bind_blob(1, bytes_of(key.x)).bind(2, setting_number(key.setting)).bind(3, key.rows);
  row.bind(4, request_name(key.request)).bind(5, key.method);
  if (stored.failure.empty()) {
    const RowMajor gradients = evaluation.constraint_jacobian;
    row.bind(7, evaluation.objective).bind_blob(8, bytes_of(evaluation.constraints));
    row.bind_blob(9, bytes_of(evaluation.objective_gradient));
    row.bind_blob(10, bytes_of(gradients.data(), gradients.size()));
  } else {
    row.bind(6, stored.failure);
  }
  row.bind(11, stored.method).bind(12, stored.reason).bind(13, stored.seconds);
  row.bind(14, checksum_of(key, kept)).run();
}

void RunDatabase::confirm(const EvaluationKey& key, const StoredEvaluation& again) {
  const auto known = find(key);
  const bool is_confirmed =
      known && known->failure.empty() == again.failure.empty() &&
      std::ranges::equal(parts_of(known->evaluation, key.x),
                         parts_of(as_stored(again).evaluation, key.x), is_same);
  if (is_confirmed) return;
  throw InputError(fmt::format(
      "{}: row {} of the table evaluations is not what this program computes for its design: the "
      "record is damaged or was changed; {}",
      file_.string(), known ? known->older_row : 0, begin_anew));
}

int RunDatabase::evaluations() const {
  return static_cast<int>(integer_of(database_, "SELECT count(*) FROM evaluations"));
}

void RunDatabase::clear_history() {
  database_.execute("DELETE FROM history");
}

void RunDatabase::add(const EvaluationRecord& record) {
  Statement& row = *add_;
  row.bind(1, std::int64_t{record.evaluation}).bind(2, std::int64_t{record.iteration});
  row.bind(3, to_string(record.purpose)).bind(4, request_name(record.request));
  row.bind(5, record.seconds).bind_blob(6, bytes_of(record.x));
  if (record.has_failed()) {
    row.bind(7, record.failure);
  } else {
    row.bind(8, record.objective).bind_blob(9, bytes_of(record.constraints));
    row.bind(10, record.max_violation);
  }
  row.bind(11, record.step).bind(12, record.time_step).bind(13, std::int64_t{record.elements});
  row.run();
}

std::int64_t RunDatabase::setting_number(const std::string& text) {
  Statement insert(database_, "INSERT OR IGNORE INTO settings(text) VALUES (?1)");
  insert.bind(1, text).run();
  Statement select(database_, "SELECT setting FROM settings WHERE text = ?1");
  select.bind(1, text);
  select.step();
  return select.integer(0);
}

}  // namespace pleuel
