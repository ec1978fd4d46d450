// Calls of all functions with arguments of all kinds: they may fail, but never crash, throw, or say yes to nonsense.

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "include/pleuel.h"
#include "tests/support/source_folder.hpp"

namespace pleuel::test::border_fuzz_test {
namespace {

constexpr int calls = 100'000;
constexpr size_t room = 64;  ///< of every array, more than any call writes

/// Draws arguments; most of them are right, so that calls come to their ends, too.
class Arguments {
 public:
  explicit Arguments(unsigned seed) : random_(seed) {}

  int up_to(int most) { return std::uniform_int_distribution<int>(0, most)(random_); }
  bool is_rare() { return up_to(9) == 0; }

  size_t size(size_t right) {
    if (!is_rare()) return right;
    const size_t wrong[] = {0, right + 1, right == 0 ? 7 : right - 1, SIZE_MAX, SIZE_MAX / 8};
    return wrong[up_to(4)];
  }

  pleuel_list list() { return is_rare() ? up_to(20) - 10 : up_to(6); }

  /// Of the designs few are new: a new one is simulated.
  const double* design(const std::vector<double>& start) {
    if (is_rare()) return nullptr;
    x_ = start;
    if (is_rare()) {
      const double odd[] = {NAN, INFINITY, -INFINITY, std::numeric_limits<double>::denorm_min(),
                            -1.0};
      x_[static_cast<size_t>(up_to(3))] = odd[up_to(4)];
    }
    return x_.data();
  }

  double* array(std::vector<double>& one) { return is_rare() ? nullptr : one.data(); }

  pleuel_problem problem(const std::vector<pleuel_problem>& open) {
    const pleuel_problem none[] = {0, UINT64_MAX, open.front() + 1'000'000};
    return is_rare() ? none[up_to(2)]
                     : open[static_cast<size_t>(up_to(static_cast<int>(open.size()) - 1))];
  }

  std::string text() {
    std::string text;
    for (int i = up_to(30); i > 0; --i) text += "{}[]\":,/=01.eE- \n\\abc"[up_to(20)];
    return text;
  }

 private:
  std::mt19937 random_;
  std::vector<double> x_;
};

int end_at_once(const pleuel_progress*, void*) {
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

  pleuel_status make_one() {
    const pleuel_problem problem = draw_.problem(open_);
    switch (draw_.up_to(11)) {
      case 0:
        return pleuel_count(problem, draw_.list(), draw_.is_rare() ? nullptr : &count_);
      case 1:
        return pleuel_name(problem, draw_.list(), draw_.size(0),
                           draw_.is_rare() ? nullptr : &name_);
      case 2:
        return pleuel_unit(problem, draw_.list(), draw_.size(0),
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
      default:
        return draw_.up_to(99) < 90 ? call_nothing(problem) : simulate(problem);
    }
  }

 private:
  /// Arguments of simulating functions that end before that.
  pleuel_status call_nothing(pleuel_problem problem) {
    const double* x = draw_.design(start_);
    const size_t wrong = draw_.up_to(3) == 0 ? SIZE_MAX : 3;
    switch (draw_.up_to(4)) {
      case 0:
        return pleuel_evaluate(problem, x, wrong, draw_.array(a_), draw_.array(b_), 6, nullptr,
                               nullptr);
      case 1:
        return pleuel_responses(problem, x, 4, draw_.array(a_), wrong, draw_.array(d_));
      case 2:
        return pleuel_history(problem, x, wrong, 2, draw_.array(a_), draw_.array(b_), 4, nullptr);
      case 3:
        return pleuel_history_size(problem, x, 4, wrong + 20, &count_);
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
        return pleuel_history(problem, x, draw_.size(4), draw_.size(2), draw_.array(a_),
                              draw_.array(b_), draw_.size(4), draw_.array(d_));
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

TEST(BorderFuzz, CallsOfAllKindsEndWithAStatusAndAText) {
  Calls all(1);
  std::vector<int> of_status(6);
  for (int i = 0; i < calls; ++i) {
    const pleuel_status status = all.make_one();
    ASSERT_TRUE(status >= PLEUEL_OK && status <= PLEUEL_BAD_CALL) << status;
    ++of_status[static_cast<size_t>(status)];
    if (status == PLEUEL_OK) continue;
    const pleuel_error* error = pleuel_last_error();
    ASSERT_EQ(error->kind, status);
    ASSERT_STRNE(error->text, "");
    ASSERT_NE(status, PLEUEL_FAULT) << error->text;
  }
  // All kinds occurred: the calls were neither all refused nor all accepted.
  EXPECT_GT(of_status[PLEUEL_OK], calls / 20);
  EXPECT_GT(of_status[PLEUEL_BAD_CALL], calls / 20);
  EXPECT_GT(of_status[PLEUEL_BAD_INPUT], calls / 20);
}

}  // namespace
}  // namespace pleuel::test::border_fuzz_test
