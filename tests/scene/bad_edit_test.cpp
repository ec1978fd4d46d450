#include "tests/scene/bad_edit.hpp"

#include <ostream>
#include <sstream>

#include <fmt/format.h>

#include "tests/scene/good_problem.hpp"

namespace pleuel::test {

void PrintTo(const BadEdit& bad, std::ostream* stream) {
  *stream << bad.pointer << " = " << bad.value;
}

std::vector<BadEdit> bad_edits(const std::string& table) {
  std::istringstream lines(table);
  std::vector<BadEdit> edits;
  for (std::string line; std::getline(lines, line);) {
    if (line.empty()) continue;
    std::vector<std::string> cells;
    for (std::size_t begin = 0, end = 0; end != std::string::npos; begin = end + 3) {
      end = line.find(" | ", begin);
      cells.push_back(line.substr(begin, end - begin));
    }
    BadEdit edit{cells.at(0), cells.at(1), cells.at(2)};
    const std::string above = edit.pointer.substr(0, edit.pointer.rfind('/'));
    if (edit.message.starts_with('~')) edit.message.replace(0, 1, edit.pointer);
    if (edit.message.starts_with('^')) edit.message.replace(0, 1, above);
    if (cells.size() > 3) edit.mistakes = std::stoi(cells[3]);
    edits.push_back(edit);
  }
  return edits;
}

}  // namespace pleuel::test

namespace pleuel::test::bad_edit_test {
namespace {

void expect_refusal(const Json& document, const BadEdit& bad) {
  const std::string complaint = test::complaint(document), first = "bad.json: " + bad.message;
  if (bad.mistakes == 1) {
    EXPECT_EQ(complaint, first);
  } else {
    EXPECT_TRUE(complaint.starts_with(fmt::format("{} mistakes:\n{}\n", bad.mistakes, first)))
        << complaint;
  }
}

TEST_P(BadProblemFile, IsRefusedWithPlaceValueAndRule) {
  const BadEdit& bad = GetParam();
  expect_refusal(edited(bad.pointer, bad.value), bad);
}

TEST_P(BadMechanismFile, IsRefusedWithPlaceValueAndRule) {
  const BadEdit& bad = GetParam();
  expect_refusal(edited(good_mechanism(), bad.pointer, bad.value), bad);
}

TEST(GoodProblemFile, IsNotRefused) {
  EXPECT_EQ(complaint(good_json()), "");
}

TEST(GoodMechanismFile, IsNotRefused) {
  EXPECT_EQ(complaint(good_mechanism()), "");
}

TEST(GoodMechanismFile, MayHoldABodyByLoadsAlone) {
  Json document = edited(good_mechanism(), "/scene/joints/line", "remove");
  EXPECT_EQ(complaint(document), "");
  document["scene"]["loads"]["gust"]["value"] = document["scene"]["loads"]["pull"]["value"];
  document["scene"]["bodies"]["ball"]["velocity"][0] = 1;
  document["variables"].erase("speed");
  document["scene"]["loads"].erase("pull");
  document["scene"]["loads"].erase("strap");
  EXPECT_EQ(complaint(document),
            "bad.json: /scene/bodies/ball is not connected to anything by a joint or a load");
}

}  // namespace
}  // namespace pleuel::test::bad_edit_test
