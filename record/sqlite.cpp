#include "record/sqlite.hpp"

#include <sqlite3.h>

#include "core/base/int_size.hpp"

namespace pleuel {

namespace {

constexpr int patience = 10'000;  ///< for others who read the file [ms]

}  // namespace

Database::Database(const std::filesystem::path& file) {
  if (::sqlite3_open(file.c_str(), &handle_) != SQLITE_OK) {
    const std::string reason = handle_ ? ::sqlite3_errmsg(handle_) : "no memory";
    ::sqlite3_close(handle_);
    throw DatabaseError(reason);
  }
  ::sqlite3_busy_timeout(handle_, patience);
}

Database::~Database() {
  ::sqlite3_close(handle_);
}

void Database::execute(const std::string& statements) {
  if (::sqlite3_exec(handle_, statements.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) {
    throw DatabaseError(::sqlite3_errmsg(handle_));
  }
}

Statement::Statement(Database& database, const std::string& text) : database_(database) {
  check(::sqlite3_prepare_v2(database.handle(), text.c_str(), -1, &handle_, nullptr));
}

Statement::~Statement() {
  ::sqlite3_finalize(handle_);
}

Statement& Statement::bind(int parameter, double value) {
  check(::sqlite3_bind_double(handle_, parameter, value));
  return *this;
}

Statement& Statement::bind(int parameter, std::int64_t value) {
  check(::sqlite3_bind_int64(handle_, parameter, value));
  return *this;
}

Statement& Statement::bind(int parameter, const std::string& text) {
  check(::sqlite3_bind_text(handle_, parameter, text.data(), int_size(text), SQLITE_TRANSIENT));
  return *this;
}

Statement& Statement::bind_blob(int parameter, std::string_view bytes) {
  check(::sqlite3_bind_blob64(handle_, parameter, bytes.data(), bytes.size(), SQLITE_TRANSIENT));
  return *this;
}

bool Statement::step() {
  const int code = ::sqlite3_step(handle_);
  if (code == SQLITE_ROW) return true;
  if (code == SQLITE_DONE) return false;
  const std::string reason = ::sqlite3_errmsg(database_.handle());
  ::sqlite3_reset(handle_);
  throw DatabaseError(reason);
}

void Statement::reset() {
  ::sqlite3_reset(handle_);
  ::sqlite3_clear_bindings(handle_);
}

void Statement::run() {
  step();
  reset();
}

bool Statement::is_null(int column) const {
  return ::sqlite3_column_type(handle_, column) == SQLITE_NULL;
}

double Statement::number(int column) const {
  return ::sqlite3_column_double(handle_, column);
}

std::int64_t Statement::integer(int column) const {
  return ::sqlite3_column_int64(handle_, column);
}

std::string Statement::text(int column) const {
  return blob(column);
}

std::string Statement::blob(int column) const {
  const void* data = ::sqlite3_column_blob(handle_, column);
  const int size = ::sqlite3_column_bytes(handle_, column);
  return data ? std::string(static_cast<const char*>(data), size) : std::string();
}

void Statement::check(int code) const {
  if (code != SQLITE_OK) throw DatabaseError(::sqlite3_errmsg(database_.handle()));
}

}  // namespace pleuel
