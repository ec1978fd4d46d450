/// Pleuel for programs in C++17: include/pleuel.h with values in place of pointers, and exceptions in place of statuses.
///
///     pleuel::Problem crank("slider_crank.json", {{"/simulation/step", "0.2 ms"}});
///     const auto e = crank.evaluate(crank.start(), pleuel::Derivatives::yes);
///     const std::string result = crank.optimize();        // JSON
///
/// Header-only, and all of it over the C functions: compilers and flags need not be those of the library. All numbers
/// are in SI units; matrices are row by row.
#ifndef PLEUEL_HPP
#define PLEUEL_HPP

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <functional>
#include <list>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "pleuel.h"

namespace pleuel {

using Numbers = std::vector<double>;

/// What pleuel_last_error() says.
class Error : public std::runtime_error {
 public:
  explicit Error(const pleuel_error& error)
      : std::runtime_error(error.text),
        kind(error.kind),
        file(error.file),
        pointer(error.pointer),
        rule(error.rule) {}

  pleuel_status kind;
  std::string file, pointer, rule;
};

inline void require(pleuel_status status) {
  if (status != PLEUEL_OK) throw Error(*pleuel_last_error());
}

enum class Derivatives { no, yes };

/// One design as an optimizer sees it.
struct Evaluation {
  double objective = 0.0;
  Numbers limits;    ///< one a limit
  Numbers gradient;  ///< one a variable; empty if it was not asked for
  Numbers jacobian;  ///< limits × variables; likewise
};

struct History {
  Numbers time, values;  ///< one an instant
  Numbers derivatives;   ///< instants × variables; empty if they were not asked for
};

/// Hears of each evaluation; true ends the search. What it throws ends it, too, and leaves optimize().
using Observer = std::function<bool(const pleuel_progress&)>;

/// A text that the library returned.
inline std::string taken(char* text) {
  std::string copy(text);
  pleuel_free(text);
  return copy;
}

/// Runs a command of the program, and returns what it prints with --json.
inline std::string run(const std::vector<std::string>& words, int* exit_code = nullptr) {
  std::vector<const char*> pointers;
  for (const std::string& word : words) pointers.push_back(word.c_str());
  int code = 0;
  char* document = nullptr;
  require(pleuel_run(pointers.data(), pointers.size(), &code, &document));
  if (exit_code != nullptr) *exit_code = code;
  return taken(document);
}

/// Makes a body for a design: a file of invariants (docs/invariants.md). What it throws fails the design.
using BodyFunction = std::function<std::string(const Numbers& values)>;

/// Problems that are opened have their body of this name made by a function, as long as this exists. It outlives
/// them.
class RegisteredBody {
 public:
  RegisteredBody(std::string body, BodyFunction function)
      : body_(std::move(body)), function_(std::move(function)) {
    require(pleuel_register_body(body_.c_str(), &make, this));
  }
  ~RegisteredBody() { pleuel_register_body(body_.c_str(), nullptr, nullptr); }
  RegisteredBody(const RegisteredBody&) = delete;
  RegisteredBody& operator=(const RegisteredBody&) = delete;

 private:
  /// The text stays until the next call.
  static int make(const double* values, std::size_t variables, const char** text,
                  void* user) noexcept {
    auto& self = *static_cast<RegisteredBody*>(user);
    static thread_local std::string kept;
    int code = 0;
    try {
      kept = self.function_(Numbers(values, values + variables));
    } catch (const std::exception& error) {
      kept = error.what();
      code = 1;
    } catch (...) {
      kept = "it threw what is no std::exception";
      code = 1;
    }
    *text = kept.c_str();
    return code;
  }

  std::string body_;
  BodyFunction function_;
};

/// An open problem. It is moved, not copied.
class Problem {
 public:
  using Overrides = std::vector<std::pair<std::string, std::string>>;

  /// @param text  the problem as JSON; none: what the file contains
  explicit Problem(const std::string& file, const Overrides& overrides = {},
                   const std::optional<std::string>& text = std::nullopt,
                   const std::optional<std::string>& load_case = std::nullopt) {
    std::vector<std::string> assignments;
    for (const auto& [place, value] : overrides) assignments.push_back(place + "=" + value);
    std::vector<const char*> pointers;
    for (const std::string& one : assignments) pointers.push_back(one.c_str());
    require(pleuel_open(file.c_str(), text ? text->c_str() : nullptr, pointers.data(),
                        pointers.size(), load_case ? load_case->c_str() : nullptr, &number_));
  }
  ~Problem() { close(); }
  Problem(Problem&& other) noexcept : number_(std::exchange(other.number_, 0)) {}
  Problem& operator=(Problem&& other) noexcept {
    if (this != &other) {
      close();
      number_ = std::exchange(other.number_, 0);
    }
    return *this;
  }

  pleuel_problem number() const { return number_; }

  std::vector<std::string> names(pleuel_list list) const {
    std::vector<std::string> all(count(list));
    for (std::size_t i = 0; i < all.size(); ++i) {
      const char* name = nullptr;
      require(pleuel_name(number_, list, i, &name));
      all[i] = name;
    }
    return all;
  }
  std::size_t count(pleuel_list list) const {
    std::size_t count = 0;
    require(pleuel_count(number_, list, &count));
    return count;
  }

  Numbers start() const { return bounds(0); }
  Numbers lower() const { return bounds(1); }
  Numbers upper() const { return bounds(2); }

  Evaluation evaluate(const Numbers& x, Derivatives derivatives = Derivatives::no) const {
    Evaluation found;
    found.limits.resize(count(PLEUEL_LIMITS));
    if (derivatives == Derivatives::yes) {
      found.gradient.resize(x.size());
      found.jacobian.resize(found.limits.size() * x.size());
    }
    require(pleuel_evaluate(number_, x.data(), x.size(), &found.objective, found.limits.data(),
                            found.limits.size(), array(found.gradient), array(found.jacobian)));
    return found;
  }

  /// Values of all responses, and with them their Jacobian if there is a place for it.
  Numbers responses(const Numbers& x, Numbers* jacobian = nullptr) const {
    Numbers values(count(PLEUEL_RESPONSES));
    if (jacobian != nullptr) jacobian->resize(values.size() * x.size());
    require(pleuel_responses(number_, x.data(), x.size(), values.data(), values.size(),
                             jacobian != nullptr ? array(*jacobian) : nullptr));
    return values;
  }

  History history(const Numbers& x, std::size_t response,
                  Derivatives derivatives = Derivatives::no) const {
    std::size_t instants = 0;
    require(pleuel_history_size(number_, x.data(), x.size(), response, &instants));
    History found{Numbers(instants), Numbers(instants), {}};
    if (derivatives == Derivatives::yes) found.derivatives.resize(instants * x.size());
    require(pleuel_history(number_, x.data(), x.size(), response, found.time.data(),
                           found.values.data(), instants, array(found.derivatives)));
    return found;
  }

  /// JSON.
  std::string motion(const Numbers& x) const {
    char* document = nullptr;
    require(pleuel_motion(number_, x.data(), x.size(), &document));
    return taken(document);
  }

  /// Derivatives of all responses by each number of a body: JSON.
  std::string by_invariants(const Numbers& x, const std::string& body) const {
    char* document = nullptr;
    require(pleuel_by_invariants(number_, x.data(), x.size(), body.c_str(), &document));
    return taken(document);
  }

  /// @param options  JSON
  /// @returns        the document of `pleuel optimize`
  std::string optimize(const std::string& options = "{}", const Observer& observer = {}) const {
    Listener listener{observer, nullptr};
    char* result = nullptr;
    const pleuel_status status = pleuel_optimize(number_, nullptr, 0, options.c_str(),
                                                 observer ? &hear : nullptr, &listener, &result);
    if (listener.failure) {
      pleuel_free(result);
      std::rethrow_exception(listener.failure);
    }
    require(status);
    return taken(result);
  }

 private:
  struct Listener {
    const Observer& observer;
    std::exception_ptr failure;
  };

  /// Exceptions wait until the library has returned.
  static int hear(const pleuel_progress* progress, void* user) noexcept {
    auto& listener = *static_cast<Listener*>(user);
    try {
      return listener.observer(*progress) ? 1 : 0;
    } catch (...) {
      listener.failure = std::current_exception();
      return 1;
    }
  }

  static double* array(Numbers& numbers) { return numbers.empty() ? nullptr : numbers.data(); }

  Numbers bounds(int which) const {
    Numbers numbers(count(PLEUEL_VARIABLES));
    double* const at[] = {which == 0 ? numbers.data() : nullptr,
                          which == 1 ? numbers.data() : nullptr,
                          which == 2 ? numbers.data() : nullptr};
    require(pleuel_bounds(number_, at[0], at[1], at[2], numbers.size()));
    return numbers;
  }

  void close() {
    if (number_ != 0) pleuel_close(number_);
  }

  pleuel_problem number_ = 0;
};

/// A search that a backend is to make (pleuel_search), in numbers of order one:
///
///     minimize f(y)   subject to   g(y) ≤ 0,   h(y) = 0,   lower ≤ y ≤ upper
class Search {
 public:
  explicit Search(const pleuel_search& search) : search_(search) {}

  Numbers start() const { return numbers(search_.start); }
  Numbers lower() const { return numbers(search_.lower); }
  Numbers upper() const { return numbers(search_.upper); }
  std::size_t inequalities() const { return search_.inequalities; }
  std::size_t equalities() const { return search_.equalities; }
  double tolerance() const { return search_.tolerance; }

  /// f as the objective; g and then h as limits.
  /// @throws Error  of kind PLEUEL_SIMULATION_FAILED: y has no values, another should be tried; PLEUEL_STOPPED: the
  ///                backend should return, which it does if it does not catch this
  Evaluation evaluate(const Numbers& y, Derivatives derivatives = Derivatives::no) const {
    Evaluation found;
    found.limits.resize(search_.inequalities + search_.equalities);
    if (derivatives == Derivatives::yes) {
      found.gradient.resize(y.size());
      found.jacobian.resize(found.limits.size() * y.size());
    }
    const auto array = [](Numbers& all) { return all.empty() ? nullptr : all.data(); };
    require(pleuel_search_evaluate(search_.number, y.data(), y.size(), &found.objective,
                                   array(found.limits), found.limits.size(), array(found.gradient),
                                   array(found.jacobian)));
    return found;
  }

 private:
  Numbers numbers(const double* from) const { return Numbers(from, from + search_.variables); }

  const pleuel_search& search_;
};

/// An optimizer of the caller: the y that it comes to.
using Backend = std::function<Numbers(const Search&)>;

namespace internal {

/// Exceptions are told in the error of the call that needed the backend.
inline int call_backend(const pleuel_search* search, double* y, char* reason, void* user) noexcept {
  try {
    const Numbers end = (*static_cast<const Backend*>(user))(Search(*search));
    if (end.size() != search->variables) {
      throw std::length_error("it returned " + std::to_string(end.size()) + " numbers for " +
                              std::to_string(search->variables) + " variables");
    }
    std::copy(end.begin(), end.end(), y);
    return 0;
  } catch (const Error& error) {
    std::snprintf(reason, PLEUEL_REASON_SIZE, "%s", error.what());
    return error.kind == PLEUEL_STOPPED ? 0 : 1;
  } catch (const std::exception& error) {
    std::snprintf(reason, PLEUEL_REASON_SIZE, "%s", error.what());
  } catch (...) {
    std::snprintf(reason, PLEUEL_REASON_SIZE, "it threw an exception");
  }
  return 1;
}

}  // namespace internal

/// pleuel_register_backend; an empty function forgets the one of this name. Functions are kept until the program ends.
inline void register_backend(const std::string& name, Backend backend,
                             bool takes_equalities = false) {
  static std::mutex mutex;
  static auto& kept = *new std::list<Backend>;
  if (!backend) return require(pleuel_register_backend(name.c_str(), 0, nullptr, nullptr));
  const std::lock_guard<std::mutex> lock(mutex);
  kept.push_back(std::move(backend));
  require(pleuel_register_backend(name.c_str(), takes_equalities, &internal::call_backend,
                                  &kept.back()));
}

}  // namespace pleuel

#endif
