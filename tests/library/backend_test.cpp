#include <array>
#include <limits>
#include <stdexcept>
#include <utility>

#include "include/pleuel.h"
#include "include/pleuel.hpp"
#include "tests/support/files.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::backend_test {
namespace {

/// Some milliseconds of simulation: the ramp only, in coarse steps.
const Problem::Overrides quick = {{"/simulation/step", "0.2 ms"},
                                  {"/simulation/end_time", "20 ms"},
                                  {"/scene/joints/bearing/drive/ramp", "20 ms"}};
const std::string unchecked = R"({"backend": "mine", "checks": false})";

Problem crank(Problem::Overrides more = {}) {
  more.insert(more.end(), quick.begin(), quick.end());
  return Problem(source_folder() + "/problems/slider_crank.json", more);
}

/// Known as "mine" as long as it is there.
class Registered {
 public:
  explicit Registered(Backend backend, bool takes_equalities = false) {
    register_backend("mine", std::move(backend), takes_equalities);
  }
  ~Registered() { register_backend("mine", {}); }
  Registered(const Registered&) = delete;
  Registered& operator=(const Registered&) = delete;
};

constexpr const char* is_verified = "\"status\": \"verified\"";

/// How an optimization of a problem ends.
std::pair<pleuel_status, std::string> error_of(const Problem& problem,
                                               const std::string& options = unchecked) {
  try {
    problem.optimize(options);
  } catch (const Error& error) {
    return {error.kind, error.what()};
  }
  return {PLEUEL_OK, ""};
}

Numbers stay(const Search& search) {
  return search.start();
}

/// SLSQP of Pleuel finds this design; what matters here is that it is an optimum, which the audit alone decides.
Numbers known_optimum(const Problem& problem) {
  Numbers x;
  problem.optimize(R"({"backend": "nlopt-slsqp", "checks": false, "tolerance": 1e-9})",
                   [&](const pleuel_progress& progress) {
                     if (progress.max_violation < 1e-9) x.assign(progress.x, progress.x + 4);
                     return false;
                   });
  return x;
}

TEST(BackendOfTheCaller, IsJudgedAsOthersAre) {
  const Problem problem = crank();
  const Numbers x = problem.start(), best = known_optimum(problem);
  int evaluations = 0;
  const Registered knowing([&](const Search& search) {
    Numbers y = search.start();
    for (std::size_t i = 0; i < y.size(); ++i) y[i] *= best[i] / x[i];  // y = x / magnitude
    search.evaluate(y);
    ++evaluations;
    return y;
  });
  const std::string result = problem.optimize(unchecked);
  EXPECT_THAT(result, HasSubstr(is_verified));
  EXPECT_THAT(result, HasSubstr("\"backend\": \"mine\""));
  EXPECT_GE(evaluations, 1);
}

TEST(BackendOfTheCaller, IsNotBelieved) {
  const Backend lost = [](const Search& search) {
    return Numbers(search.start().size(), std::numeric_limits<double>::quiet_NaN());
  };
  for (const Backend& backend : {Backend(stay), lost}) {
    const Registered lazy(backend);
    EXPECT_THAT(crank().optimize(unchecked), Not(HasSubstr(is_verified)));
  }
}

/// Central differences of the values, in numbers of order one: errors of some h² = 1e-8 and of round-off, 1e-11 / h.
TEST(BackendOfTheCaller, SeesDerivativesOfItsFunctions) {
  const Problem problem = crank();
  const Registered differences([](const Search& search) {
    constexpr double h = 1e-4;
    const Numbers y = search.start();
    const Evaluation found = search.evaluate(y, Derivatives::yes);
    EXPECT_EQ(found.limits.size(), search.inequalities() + search.equalities());
    for (std::size_t j = 0; j < y.size(); ++j) {
      Numbers above = y, below = y;
      above[j] += h;
      below[j] -= h;
      const Evaluation plus = search.evaluate(above), minus = search.evaluate(below);
      EXPECT_NEAR((plus.objective - minus.objective) / (2 * h), found.gradient[j], 1e-6);
      for (std::size_t i = 0; i < found.limits.size(); ++i) {
        const double slope = (plus.limits[i] - minus.limits[i]) / (2 * h);
        EXPECT_NEAR(slope, found.jacobian[i * y.size() + j], 1e-5 * (1.0 + std::abs(slope)));
      }
    }
    return y;
  });
  problem.optimize(unchecked);
}

TEST(BackendOfTheCaller, ThatFailsIsAnErrorWithItsText) {
  const Backend failing = [](const Search&) -> Numbers { throw std::range_error("no way down"); };
  const Backend short_of = [](const Search&) { return Numbers(3); };
  const std::string two_starts = R"({"backend": "mine", "checks": false, "starts": 2})";
  for (const auto& [backend, options, words] :
       {std::tuple{failing, unchecked, "the backend \"mine\" failed: no way down"},
        std::tuple{failing, two_starts, "no way down"},
        std::tuple{short_of, unchecked, "3 numbers for 4 variables"}}) {
    const Registered registered(backend);
    const auto [status, text] = error_of(crank(), options);
    EXPECT_EQ(status, PLEUEL_BAD_CALL) << words;
    EXPECT_THAT(text, HasSubstr(words));
  }
}

int throw_at_once(const pleuel_search*, double*, char*, void*) {
  throw std::runtime_error("of the caller");
}

int fail_with_code(const pleuel_search*, double*, char*, void*) {
  return 7;
}

/// Without the 0 at its end, and no UTF-8.
int fill_reason(const pleuel_search*, double*, char* reason, void*) {
  std::fill_n(reason, PLEUEL_REASON_SIZE, '\xff');
  return 0;
}

TEST(BackendOfTheCaller, MayMisbehaveInC) {
  const Problem problem = crank();
  struct Case {
    pleuel_backend backend;
    const char* words;
  };
  for (const auto& [backend, words] :
       {Case{throw_at_once, "threw an exception"}, Case{fail_with_code, "it returned 7"},
        Case{fill_reason, ""}}) {
    ASSERT_EQ(pleuel_register_backend("mine", 1, backend, nullptr), PLEUEL_OK);
    const auto [status, text] = error_of(problem);
    EXPECT_EQ(status, *words == '\0' ? PLEUEL_OK : PLEUEL_BAD_CALL) << text;
    EXPECT_THAT(text, HasSubstr(words));
  }
  register_backend("mine", {});
}

TEST(BackendOfTheCaller, HasANameOfItsOwn) {
  for (const char* name : {"ipopt", "", "two words", "../x"}) {
    EXPECT_EQ(pleuel_register_backend(name, 0, throw_at_once, nullptr), PLEUEL_BAD_INPUT) << name;
  }
  EXPECT_EQ(pleuel_register_backend(nullptr, 0, throw_at_once, nullptr), PLEUEL_BAD_CALL);
  EXPECT_EQ(pleuel_register_backend("never", 0, nullptr, nullptr), PLEUEL_BAD_INPUT);
  const Problem problem = crank();
  const auto [status, text] = error_of(problem);
  EXPECT_EQ(status, PLEUEL_BAD_INPUT);
  EXPECT_THAT(text, HasSubstr("no optimizer backend \"mine\""));
}

TEST(BackendOfTheCaller, IsNamedByProblemsAndCommands) {
  int calls = 0;
  const Registered counting([&](const Search& search) {
    ++calls;
    return stay(search);
  });
  crank({{"/optimizer/backend", "mine"}}).optimize(R"({"checks": false})");
  EXPECT_GE(calls, 1);
  EXPECT_THAT(run({"backends"}), HasSubstr("\"mine\""));
}

TEST(BackendOfTheCaller, IsAskedForEqualitiesOnlyIfItTakesThem) {
  const Problem::Overrides equal = {
      {"/constraints/crank_stiffness",
       R"({"response": "crank_tip", "lower": "0.1 mm", "upper": "0.1 mm"})"}};
  const Problem problem = crank(equal);
  const Backend counting = [](const Search& search) {
    EXPECT_EQ(search.equalities(), 1u);
    return stay(search);
  };
  {
    const Registered refusing(counting, false);
    const auto [status, text] = error_of(problem);
    EXPECT_EQ(status, PLEUEL_BAD_INPUT);
    EXPECT_THAT(text, HasSubstr("crank_stiffness"));
  }
  const Registered taking(counting, true);
  EXPECT_EQ(error_of(problem).first, PLEUEL_OK);
}

TEST(BackendOfTheCaller, IsToldWhatIsWrongWithItsQuestions) {
  std::uint64_t ended = 0;
  const auto ask = [&](const pleuel_search* search, double*, char*) {
    Numbers y(search->start, search->start + search->variables);
    double objective = 0.0;
    Numbers rows(search->inequalities + search->equalities);
    const auto status = [&](std::uint64_t number, const double* at, size_t variables,
                            double* f = nullptr, size_t count = 0) {
      return pleuel_search_evaluate(number, at, variables, f, rows.data(), count, nullptr, nullptr);
    };
    ended = search->number;
    const size_t right = rows.size();
    const size_t n = y.size();
    EXPECT_EQ(status(ended, y.data(), n, &objective, right), PLEUEL_OK);
    for (const pleuel_status refused : {status(ended + 1, y.data(), n, &objective, right),
                                        status(ended, y.data(), n + 1, &objective, right),
                                        status(ended, y.data(), n, &objective, right + 1),
                                        status(ended, y.data(), n, nullptr, right),
                                        status(ended, nullptr, n, &objective, right)}) {
      EXPECT_EQ(refused, PLEUEL_BAD_CALL);
    }
    y[1] = std::numeric_limits<double>::infinity();
    EXPECT_EQ(status(ended, y.data(), y.size(), &objective, right), PLEUEL_BAD_CALL);
    return 0;
  };
  using Ask = decltype(ask);
  const pleuel_backend asking = [](const pleuel_search* search, double* y, char* reason,
                                   void* user) {
    return (*static_cast<Ask*>(user))(search, y, reason);
  };
  ASSERT_EQ(
      pleuel_register_backend("mine", 0, asking, const_cast<void*>(static_cast<const void*>(&ask))),
      PLEUEL_OK);
  crank().optimize(unchecked);
  register_backend("mine", {});
  const double y = 0.0;
  double objective = 0.0;
  EXPECT_EQ(pleuel_search_evaluate(ended, &y, 1, &objective, nullptr, 0, nullptr, nullptr),
            PLEUEL_BAD_CALL);
  EXPECT_THAT(pleuel_last_error()->text, HasSubstr("does not run"));
}

/// Asks for one design after another; returns never by itself.
Numbers wander(const Search& search) {
  for (double factor = 1.0;; factor *= 1.001) {
    Numbers y = search.start();
    for (double& one : y) one *= factor;
    search.evaluate(y, Derivatives::yes);
  }
}

TEST(BackendOfTheCaller, EndsWhenTheSearchIsToEnd) {
  const Problem problem = crank();
  const Registered endless(wander);
  const std::string ended = problem.optimize(
      unchecked, [](const pleuel_progress& progress) { return progress.evaluation == 5; });
  EXPECT_THAT(ended, HasSubstr("\"status\": \"interrupted\""));
  EXPECT_THAT(ended, HasSubstr("\"evaluations\": 5"));
  const std::string used_up =
      problem.optimize(R"({"backend": "mine", "checks": false, "max_iterations": 6})");
  EXPECT_THAT(used_up, Not(HasSubstr("interrupted")));
}

/// Functions of this process are of no use in a copy of it.
TEST(BackendOfTheCaller, SearchesFromAllStartsInThisProcess) {
  const Problem problem = crank();
  std::vector<Numbers> starts;
  const Registered remembering([&](const Search& search) {
    if (starts.empty() || starts.back() != search.start()) starts.push_back(search.start());
    return stay(search);
  });
  const std::string options = R"({"backend": "mine", "checks": false, "starts": 3, "jobs": 2})";
  int heard = 0;
  const std::string result = problem.optimize(options, [&](const pleuel_progress& progress) {
    EXPECT_EQ(progress.evaluation, ++heard);
    return false;
  });
  EXPECT_GE(starts.size(), 3u);
  EXPECT_THAT(result, HasSubstr("\"starts\""));
  const std::size_t all = starts.size();
  const std::string ended = problem.optimize(
      options, [](const pleuel_progress& progress) { return progress.evaluation == 2; });
  EXPECT_THAT(ended,
              HasSubstr("\"evaluations\": 2"));  // heard at once, not when the search is over
  EXPECT_LT(starts.size(), 2 * all);
}

}  // namespace
}  // namespace pleuel::test::backend_test
