// Calls of all functions with arguments of all kinds: they may fail, but never crash, throw, or say yes to nonsense.

#include <limits>
#include <random>
#include <thread>

#include "include/pleuel.h"
#include "tests/support/files.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::border_fuzz_test {
namespace {

constexpr int calls = 100'000;
constexpr size_t room = 64;     ///< of every array
constexpr size_t most = 8 * 4;  ///< that a call writes into one: responses × variables
constexpr double untouched = 1.2345e67;

/// Draws arguments; most of them are right, so that calls come to their ends, too.
class Arguments {
 public:
  explicit Arguments(unsigned seed) : random_(seed) {}

  int up_to(int most) { return std::uniform_int_distribution<int>(0, most)(random_); }
  bool is_rare() { return up_to(9) == 0; }

  /// Whether something was drawn since begin() that no function may take.
  bool has_drawn_nonsense() const { return has_drawn_nonsense_; }
  void begin() { has_drawn_nonsense_ = false; }

  size_t size(size_t right) {
    if (!is_rare()) return right;
    has_drawn_nonsense_ = true;
    const size_t wrong[] = {0, right + 1, right - 1, SIZE_MAX, SIZE_MAX / 8};
    return wrong[up_to(4)];
  }

  size_t index() {
    const size_t any[] = {1, 7, SIZE_MAX};
    return is_rare() ? any[up_to(2)] : 0;
  }

  pleuel_list list() {
    const pleuel_list one = is_rare() ? up_to(20) - 10 : up_to(6);
    has_drawn_nonsense_ = has_drawn_nonsense_ || one < 0 || one > PLEUEL_OBJECTIVE;
    return one;
  }

  /// Of the designs few are new: a new one is simulated.
  const double* design(const std::vector<double>& start) {
    x_ = start;
    if (is_rare()) {
      const double odd[] = {NAN, INFINITY, -INFINITY, std::numeric_limits<double>::denorm_min(),
                            -1.0};
      const double one = odd[up_to(4)];
      x_[static_cast<size_t>(up_to(3))] = one;
      has_drawn_nonsense_ = has_drawn_nonsense_ || !std::isfinite(one);
    }
    if (!is_rare()) return x_.data();
    has_drawn_nonsense_ = true;
    return nullptr;
  }

  double* array(std::vector<double>& one) { return is_rare() ? nullptr : one.data(); }

  pleuel_problem problem(const std::vector<pleuel_problem>& open) {
    const pleuel_problem none[] = {0, UINT64_MAX, open.front() + 1'000'000};
    if (!is_rare()) return open[static_cast<size_t>(up_to(static_cast<int>(open.size()) - 1))];
    has_drawn_nonsense_ = true;
    return none[up_to(2)];
  }

  std::string text() {
    std::string text;
    for (int i = up_to(30); i > 0; --i) text += "{}[]\":,/=01.eE- \n\\abc"[up_to(20)];
    return text;
  }

 private:
  std::mt19937 random_;
  std::vector<double> x_;
  bool has_drawn_nonsense_ = false;
};

int end_at_once(const pleuel_progress*, void*) {
  return 1;
}

int fail_at_once(const pleuel_search*, double*, char*, void*) {
  return 1;
}

/// Simulations of three steps.
std::vector<pleuel_problem> open_problems() {
  const std::string file = source_folder() + "/problems/slider_crank.json";
  std::vector<const char*> overrides = {"/simulation/end_time=0.3 ms", "/simulation/step=0.1 ms"};
  std::vector<pleuel_problem> open(2);
  for (pleuel_problem& one : open) {
    EXPECT_EQ(pleuel_open(file.c_str(), nullptr, overrides.data(), overrides.size(), nullptr, &one),
              PLEUEL_OK)
        << pleuel_last_error()->text;
  }
  return open;
}

class Calls {
 public:
  explicit Calls(unsigned seed) : draw_(seed), open_(open_problems()) {
    pleuel_bounds(open_.front(), start_.data(), nullptr, nullptr, 4);
  }
  ~Calls() {
    for (const pleuel_problem one : open_) pleuel_close(one);
  }
  Calls(const Calls&) = delete;
  Calls& operator=(const Calls&) = delete;

  /// Nothing is written where a call fails, nor beyond what it may write, and nonsense fails.
  pleuel_status make_one() {
    for (std::vector<double>* one : {&a_, &b_, &c_, &d_}) one->assign(room, untouched);
    draw_.begin();
    const pleuel_status status = make();
    if (draw_.has_drawn_nonsense()) {
      EXPECT_NE(status, PLEUEL_OK);
    }
    for (const std::vector<double>* one : {&a_, &b_, &c_, &d_}) {
      const auto first = one->begin() + static_cast<long>(status == PLEUEL_OK ? most : 0);
      EXPECT_TRUE(std::all_of(first, one->end(), [](double x) { return x == untouched; }));
    }
    return status;
  }

 private:
  pleuel_status make() {
    const pleuel_problem problem = draw_.problem(open_);
    switch (draw_.up_to(13)) {
      case 0:
        return pleuel_count(problem, draw_.list(), draw_.is_rare() ? nullptr : &count_);
      case 1:
        return pleuel_name(problem, draw_.list(), draw_.index(),
                           draw_.is_rare() ? nullptr : &name_);
      case 2:
        return pleuel_unit(problem, draw_.list(), draw_.index(),
                           draw_.is_rare() ? nullptr : &name_);
      case 3:
        return pleuel_bounds(problem, draw_.array(a_), draw_.array(b_), draw_.array(c_),
                             draw_.size(4));
      case 4:
        return pleuel_limits(problem, draw_.array(a_), draw_.array(b_), draw_.size(6));
      case 5:
        return open_text();
      case 6:
        return pleuel_close(problem == open_[0] || problem == open_[1] ? 0 : problem);
      case 7:
        return ask_a_search();
      case 8:
        return register_backend();
      default:
        return draw_.up_to(99) < 90 ? call_nothing(problem) : simulate(problem);
    }
  }

  /// Of searches that do not run.
  pleuel_status ask_a_search() {
    const uint64_t numbers[] = {0, 1, UINT64_MAX};
    const pleuel_status status = pleuel_search_evaluate(
        numbers[draw_.up_to(2)], draw_.array(a_), draw_.size(4), draw_.array(b_), draw_.array(c_),
        draw_.size(6), draw_.array(d_), nullptr);
    EXPECT_EQ(status, PLEUEL_BAD_CALL);
    return status;
  }

  pleuel_status register_backend() {
    draw_.begin();  // of no problem
    const std::string name = draw_.is_rare() ? "mine" : draw_.text();
    const pleuel_backend backend = draw_.is_rare() ? nullptr : fail_at_once;
    return pleuel_register_backend(draw_.is_rare() ? nullptr : name.c_str(), draw_.up_to(1),
                                   backend, nullptr);
  }

  /// Arguments of simulating functions that end before that.
  pleuel_status call_nothing(pleuel_problem problem) {
    const pleuel_status status = call_wrongly(problem);
    EXPECT_NE(status, PLEUEL_OK);
    return status;
  }

  pleuel_status call_wrongly(pleuel_problem problem) {
    const double* x = draw_.design(start_);
    const size_t wrong = draw_.up_to(3) == 0 ? SIZE_MAX : 3;
    switch (draw_.up_to(6)) {
      case 0:
        return pleuel_evaluate(problem, x, wrong, draw_.array(a_), draw_.array(b_), 6, nullptr,
                               nullptr);
      case 1:
        return pleuel_responses(problem, x, 4, draw_.array(a_), wrong, draw_.array(d_));
      case 2:
        return pleuel_history(problem, x, wrong, 2, draw_.array(a_), draw_.array(b_), 4, nullptr);
      case 3:
        return pleuel_history_size(problem, x, 4, wrong + 20, &count_);
      case 4:
        return pleuel_motion(problem, x, 4, nullptr);
      case 5:
        return pleuel_by_invariants(problem, x, 4, draw_.text().c_str(), nullptr);
      default:
        return pleuel_optimize(problem, nullptr, 0, ("{" + draw_.text()).c_str(), end_at_once,
                               nullptr, nullptr);
    }
  }

  pleuel_status simulate(pleuel_problem problem) {
    const double* x = draw_.design(start_);
    switch (draw_.up_to(2)) {
      case 0:
        return pleuel_evaluate(problem, x, draw_.size(4), draw_.array(a_), draw_.array(b_),
                               draw_.size(6), draw_.array(c_), draw_.array(d_));
      case 1:
        return pleuel_responses(problem, x, draw_.size(4), draw_.array(a_), draw_.size(8),
                                draw_.array(d_));
      default:
        return pleuel_history(problem, x, draw_.size(4), 2, draw_.array(a_), draw_.array(b_),
                              draw_.size(4), draw_.array(d_));
    }
  }

  pleuel_status open_text() {
    const std::string text = draw_.text(), override = draw_.text();
    const char* overrides[] = {draw_.is_rare() ? nullptr : override.c_str()};
    pleuel_problem number = 0;
    const pleuel_status status =
        pleuel_open(draw_.is_rare() ? nullptr : "text.json", text.c_str(),
                    draw_.is_rare() ? nullptr : overrides, draw_.up_to(1) == 0 ? 1 : 0,
                    draw_.is_rare() ? text.c_str() : nullptr, draw_.is_rare() ? nullptr : &number);
    EXPECT_NE(status, PLEUEL_OK) << text;
    return status;
  }

  Arguments draw_;
  std::vector<pleuel_problem> open_;
  std::vector<double> start_ = std::vector<double>(4);
  std::vector<double> a_ = std::vector<double>(room), b_ = a_, c_ = a_, d_ = a_;
  size_t count_ = 0;
  const char* name_ = nullptr;
};

/// How many calls ended with each status.
std::vector<int> statuses_of(int calls, unsigned seed) {
  Calls all(seed);
  std::vector<int> of_status(6);
  for (int i = 0; i < calls; ++i) {
    const pleuel_status status = all.make_one();
    EXPECT_TRUE(status >= PLEUEL_OK && status <= PLEUEL_BAD_CALL) << status;
    ++of_status.at(static_cast<size_t>(status));
    if (status == PLEUEL_OK) continue;
    const pleuel_error* error = pleuel_last_error();
    EXPECT_EQ(error->kind, status);
    EXPECT_STRNE(error->text, "");
    EXPECT_NE(status, PLEUEL_FAULT) << error->text;
    if (testing::Test::HasFailure()) break;
  }
  pleuel_register_backend("mine", 0, nullptr, nullptr);
  return of_status;
}

TEST(BorderFuzz, CallsOfAllKindsEndWithAStatusAndAText) {
  const std::vector<int> of_status = statuses_of(calls, 1);
  // All kinds occurred: the calls were neither all refused nor all accepted.
  EXPECT_GT(of_status[PLEUEL_OK], calls / 20);
  EXPECT_GT(of_status[PLEUEL_BAD_CALL], calls / 20);
  EXPECT_GT(of_status[PLEUEL_BAD_INPUT], calls / 20);
}

TEST(BorderFuzz, CallsOfTwoThreadsDo) {
  std::thread other([] { statuses_of(calls / 10, 2); });
  statuses_of(calls / 10, 3);
  other.join();
}

}  // namespace
}  // namespace pleuel::test::border_fuzz_test
