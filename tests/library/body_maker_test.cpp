#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "include/pleuel.hpp"
#include "tests/support/source_folder.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test.hpp"

/// Bodies that functions of the caller make.
namespace pleuel::test::body_maker_test {
namespace {

const Problem::Overrides quick = {{"/simulation/end_time", "5 ms"},
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
  const Problem problem("crank.json", quick, text_of_problem());
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
    const Problem problem("crank.json", quick, text_of_problem());
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
  EXPECT_THAT([] { Problem("crank.json", quick, text_of_problem()); },
              testing::ThrowsMessage<Error>(HasSubstr("failed without a word")));
  require(pleuel_register_body("rod", nullptr, nullptr));
  EXPECT_THAT([] { Problem("crank.json", quick, text_of_problem()); },
              testing::ThrowsMessage<Error>(HasSubstr("needs a \"command\"")));
  EXPECT_EQ(pleuel_register_body(nullptr, silent, nullptr), PLEUEL_BAD_CALL);
}

}  // namespace
}  // namespace pleuel::test::body_maker_test
