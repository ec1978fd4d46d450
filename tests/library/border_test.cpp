#include <array>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <thread>

#include "include/pleuel.h"
#include "include/pleuel.hpp"
#include "tests/support/files.hpp"
#include "tests/support/test.hpp"

/// Bodies that functions of the caller make.

namespace pleuel::test::border_test {
namespace {

using Numbers = std::vector<double>;

/// Some milliseconds of simulation: the start of the motion in coarse steps.
const std::vector<const char*> quick = {"/simulation/end_time=5 ms", "/simulation/step=0.1 ms"};

std::string crank_file() {
  return source_folder() + "/problems/slider_crank.json";
}

std::string last_text() {
  return pleuel_last_error()->text;
}

/// An open problem.
class Crank {
 public:
  explicit Crank(const std::vector<const char*>& overrides = quick) {
    const pleuel_status status = pleuel_open(crank_file().c_str(), nullptr, overrides.data(),
                                             overrides.size(), nullptr, &number);
    if (status != PLEUEL_OK) throw std::runtime_error(last_text());
    pleuel_bounds(number, start.data(), nullptr, nullptr, start.size());
  }
  ~Crank() { pleuel_close(number); }
  Crank(const Crank&) = delete;
  Crank& operator=(const Crank&) = delete;

  pleuel_problem number = 0;
  Numbers start = Numbers(4);
};

struct Found {
  double objective = 0.0;
  Numbers values = Numbers(6), gradient = Numbers(4), jacobian = Numbers(24);
  bool operator==(const Found&) const = default;
};

Found evaluated(const Crank& crank, const Numbers& x) {
  Found found;
  EXPECT_EQ(pleuel_evaluate(crank.number, x.data(), x.size(), &found.objective, found.values.data(),
                            6, found.gradient.data(), found.jacobian.data()),
            PLEUEL_OK)
      << last_text();
  return found;
}

/// An optimization with an observer; its document.
std::string optimized(const Crank& crank, pleuel_observer observer, pleuel_status expected,
                      const char* options = nullptr, void* user = nullptr) {
  char* result = nullptr;
  EXPECT_EQ(pleuel_optimize(crank.number, nullptr, 0, options, observer, user, &result), expected)
      << last_text();
  const std::string text = result == nullptr ? "" : result;
  pleuel_free(result);
  return text;
}

/// The rows of responses and those of the limits on them come from two ways through the library.
TEST(Border, ResponsesAgreeWithLimitsOnThem) {
  const Crank crank;
  const Found found = evaluated(crank, crank.start);
  Numbers values(8), jacobian(32);
  ASSERT_EQ(
      pleuel_responses(crank.number, crank.start.data(), 4, values.data(), 8, jacobian.data()),
      PLEUEL_OK);
  EXPECT_DOUBLE_EQ(values[0], found.objective);  // crank_and_rod
  EXPECT_DOUBLE_EQ(values[2], found.values[1]);  // rod_stress, rod_strength
  for (int j = 0; j < 4; ++j) {  // the adjoint and direct differentiation may differ by round-off
    EXPECT_NEAR(jacobian[2 * 4 + j], found.jacobian[1 * 4 + j], 1e-8 * std::abs(values[2]) / 0.02);
  }
}

/// The peak of a response is the largest value of its history, and their derivatives are the same.
TEST(Border, HistoriesHaveThePeaksOfResponses) {
  const Crank crank;
  Numbers values(8), jacobian(32);
  pleuel_responses(crank.number, crank.start.data(), 4, values.data(), 8, jacobian.data());
  size_t instants = 0;
  ASSERT_EQ(pleuel_history_size(crank.number, crank.start.data(), 4, 2, &instants), PLEUEL_OK);
  ASSERT_EQ(instants, 51u);  // 5 ms in steps of 0.1 ms, and the start
  Numbers time(instants), history(instants), derivatives(4 * instants);
  ASSERT_EQ(pleuel_history(crank.number, crank.start.data(), 4, 2, time.data(), history.data(),
                           instants, derivatives.data()),
            PLEUEL_OK);
  EXPECT_NEAR(time.back(), 0.005, 1e-15);
  const auto peak = std::max_element(history.begin(), history.end()) - history.begin();
  // The response takes the peak of a parabola through three instants at most: a step resolves it to some percent.
  EXPECT_NEAR(history[peak], values[2], 0.05 * values[2]);
  for (int j = 0; j < 4; ++j) {
    EXPECT_NEAR(derivatives[4 * peak + j], jacobian[2 * 4 + j], 0.1 * std::abs(values[2]) / 0.02);
  }
  size_t of_mass = 1;
  EXPECT_EQ(pleuel_history_size(crank.number, crank.start.data(), 4, 0, &of_mass), PLEUEL_OK);
  EXPECT_EQ(of_mass, 0u);
}

/// Of problems of their own, and of one that they share.
TEST(Border, ThreadsFindTheSameDigits) {
  const Crank first, second;
  Numbers wide = first.start;
  wide[0] *= 1.2;
  const Found at_start = evaluated(first, first.start), at_wide = evaluated(first, wide);
  for (const Crank* other : {&second, &first}) {
    std::thread thread([&] {
      for (int i = 0; i < 5; ++i) EXPECT_EQ(evaluated(*other, wide), at_wide);
    });
    for (int i = 0; i < 5; ++i) EXPECT_EQ(evaluated(first, first.start), at_start);
    EXPECT_EQ(evaluated(first, wide), at_wide);
    thread.join();
  }
}

TEST(Border, ErrorsAreOfTheirThread) {
  pleuel_close(12345);
  const std::string mine = last_text();
  std::thread([] { pleuel_count(1, PLEUEL_CASES, nullptr); }).join();
  EXPECT_EQ(last_text(), mine);
  EXPECT_THAT(mine, HasSubstr("12345"));
}

TEST(Border, ErrorsAreTakenApart) {
  const Crank crank;
  pleuel_problem number = 0;
  const std::vector<const char*> overrides = {"/scene/bodies/slider/mass=-1"};
  EXPECT_EQ(pleuel_open(crank_file().c_str(), nullptr, overrides.data(), 1, nullptr, &number),
            PLEUEL_BAD_INPUT);
  const pleuel_error* error = pleuel_last_error();
  EXPECT_EQ(error->kind, PLEUEL_BAD_INPUT);
  EXPECT_EQ(error->file, crank_file());
  EXPECT_STREQ(error->pointer, "/scene/bodies/slider/mass");
  EXPECT_THAT(error->rule, HasSubstr("-1"));
  EXPECT_EQ(number, 0u);
}

int throw_at_once(const pleuel_progress*, void*) {
  throw std::runtime_error("of the caller");
}

TEST(Border, ObserversThatThrowAreErrors) {
  const Crank crank;
  EXPECT_EQ(optimized(crank, throw_at_once, PLEUEL_BAD_CALL), "");
  EXPECT_THAT(last_text(), HasSubstr("observer threw"));
}

int close_it(const pleuel_progress* progress, void* user) {
  EXPECT_EQ(pleuel_close(*static_cast<pleuel_problem*>(user)),
            progress->evaluation == 1 ? PLEUEL_OK : PLEUEL_BAD_CALL);
  return progress->evaluation >= 2;
}

TEST(Border, ProblemsMayBeClosedWhileTheyAreOptimized) {
  Crank crank;
  EXPECT_THAT(optimized(crank, close_it, PLEUEL_OK, nullptr, &crank.number),
              HasSubstr("interrupted"));
}

int stop_all(const pleuel_progress*, void*) {
  pleuel_stop();
  return 0;
}

TEST(Border, AStopEndsWhatRunsAndNothingElse) {
  const Crank crank;
  EXPECT_THAT(optimized(crank, stop_all, PLEUEL_OK), HasSubstr("\"status\": \"interrupted\""));
  pleuel_stop();  // nothing runs
  evaluated(crank, crank.start);
}

TEST(Border, OptionsAreChecked) {
  const Crank crank;
  for (const char* options :
       {"[]", "{", R"({"tolerance": 2})", R"({"starts": 0})", R"({"jobs": 1e9})",
        R"({"backend": 1})", R"({"backend": "x"})", R"({"backends": "x"})"}) {
    SCOPED_TRACE(options);
    optimized(crank, nullptr, PLEUEL_BAD_INPUT, options);
  }
  EXPECT_THAT(last_text(), HasSubstr("did you mean \"backend\""));
}

TEST(Border, CommandsReturnTheirDocuments) {
  const std::string file = crank_file();
  int code = -1;
  char* document = nullptr;
  const std::array<const char*, 5> words = {"check", file.c_str(), "--set", quick[0], "--no-such"};
  EXPECT_EQ(pleuel_run(words.data(), 5, &code, &document), PLEUEL_BAD_INPUT);
  EXPECT_THAT(last_text(), HasSubstr("--no-such"));
  const char* backends = "backends";
  ASSERT_EQ(pleuel_run(&backends, 1, &code, &document), PLEUEL_OK) << last_text();
  EXPECT_EQ(code, 0);
  EXPECT_THAT(document, HasSubstr("nlopt-slsqp"));
  pleuel_free(document);
}

/// The same problem with the same number of variables as the last one, one after the other: numbers are not
/// used again.
TEST(Border, ClosedProblemsStayClosed) {
  pleuel_problem closed = 0;
  {
    const Crank crank;
    closed = crank.number;
  }
  const Crank next;
  size_t count = 0;
  EXPECT_EQ(pleuel_count(closed, PLEUEL_VARIABLES, &count), PLEUEL_BAD_CALL);
  EXPECT_NE(closed, next.number);
}

const Problem::Overrides quick_overrides = {{"/simulation/end_time", "5 ms"},
                                            {"/simulation/step", "0.1 ms"},
                                            {"/responses/rod_bow/at", "node 1"}};

/// The problem of docs/invariants with a function in place of the file.
std::string text_of_problem() {
  std::ifstream stream(source_folder() + "/docs/invariants/slider_crank.json");
  std::string text(std::istreambuf_iterator<char>(stream), {});
  const auto replace = [&](const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
  };
  replace(R"("file": "rod.json",)",
          R"("generator": {"variables": {"rod_height": "m"}, "derivatives": "given"},)");
  replace(R"("to": ["300 mm", 0, 0],
        "other_designs": "linear")",
          R"("to": ["300 mm", 0, 0])");
  return text;
}

std::string rod(double height) {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "rod.json").string();
  const std::string command = "python3 '" + source_folder() + "/docs/invariants/planar_rod.py' '" +
                              file + "' --elements 2 --height " + std::to_string(height);
  if (std::system(command.c_str()) != 0) throw std::runtime_error(command);
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// @param fails  what happens at a height below 20 mm
RegisteredBody registered(const std::function<std::string()>& fails) {
  return {"rod", [fails](const Numbers& x) { return x[0] < 0.02 ? fails() : rod(x[0]); }};
}

Problem problem_of_functions() {
  return Problem("crank.json", quick_overrides, text_of_problem());
}

std::string failure_at(const Problem& problem, double height) {
  try {
    problem.responses({0.02, 0.03, height});
  } catch (const Error& error) {
    EXPECT_EQ(error.kind, PLEUEL_SIMULATION_FAILED);
    return error.what();
  }
  return "";
}

TEST(BodyMaker, MakesTheBodyOfADesign) {
  const RegisteredBody body = registered([] { return std::string(); });
  const Problem problem = problem_of_functions();
  Numbers jacobian;
  const Numbers thick = problem.responses({0.02, 0.03, 0.03}, &jacobian);
  const Numbers thin = problem.responses({0.02, 0.03, 0.025});
  // The mass is linear in the height.
  EXPECT_NEAR((thick[0] - thin[0]) / 0.005, jacobian[2], 1e-6 * jacobian[2]);
}

/// Whatever a function does instead of its work is an error of the design.
TEST(BodyMaker, FailsTheDesignWithItsWords) {
  const std::vector<std::pair<std::function<std::string()>, std::string>> failures = {
      {[]() -> std::string { throw std::runtime_error("no mesh"); }, "no mesh"},
      {[]() -> std::string { throw 3; }, "no std::exception"},
      {[] { return std::string(); }, "must write a body file"},
      {[] { return std::string("{}"); }, "must write a body file"},
      {[] { return rod(0.03); }, "wrote a body of rod_height = 0.03"}};
  for (const auto& [fails, expected] : failures) {
    const RegisteredBody body = registered(fails);
    const Problem problem = problem_of_functions();
    EXPECT_THAT(failure_at(problem, 0.015),
                AllOf(HasSubstr(expected), HasSubstr("rod_height = 0.015 m")));
    EXPECT_EQ(failure_at(problem, 0.025), "");
  }
}

int silent(const double*, std::size_t, const char**, void*) {
  return 1;
}

TEST(BodyMaker, MayFailWithoutAWord) {
  require(pleuel_register_body("rod", silent, nullptr));
  EXPECT_THAT(problem_of_functions,
              testing::ThrowsMessage<Error>(HasSubstr("failed without a word")));
  require(pleuel_register_body("rod", nullptr, nullptr));
  EXPECT_THAT(problem_of_functions,
              testing::ThrowsMessage<Error>(HasSubstr("needs a \"command\"")));
  EXPECT_EQ(pleuel_register_body(nullptr, silent, nullptr), PLEUEL_BAD_CALL);
}

}  // namespace
}  // namespace pleuel::test::border_test
