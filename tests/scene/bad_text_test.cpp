#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "core/scene/problem_reader.hpp"
#include "tests/scene/good_problem.hpp"

namespace pleuel::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

TEST(BadText, TruncatedAnywhereIsRefusedByAMessage) {
  const std::string text = good_text();
  for (std::size_t size = 0; size < text.size(); ++size) {
    EXPECT_THAT(complaint_about_text(text.substr(0, size)), StartsWith("bad.json: "))
        << "after " << size << " bytes";
  }
}

TEST(BadText, WithAnyByteReplacedIsReadOrRefusedByAMessage) {
  const std::string good = good_text();
  for (const char replacement : {'\0', '"', '}', '9', '\xFF'}) {
    for (std::size_t i = 0; i < good.size(); i += 29) {  // the units cost some ms each time
      std::string text = good;
      text[i] = replacement;
      EXPECT_NO_THROW(complaint_about_text(text)) << "byte " << i;
    }
  }
}

TEST(BadText, SyntaxErrorsTellLineAndColumn) {
  EXPECT_EQ(complaint_about_text("{\n  \"scene\": {],\n}"),
            "bad.json: line 2, column 13: syntax error while parsing object key - unexpected ']'; "
            "expected string literal");
  EXPECT_THAT(complaint_about_text("{\"a\": nan}"), StartsWith("bad.json: line 1, column 8: "));
  EXPECT_THAT(complaint_about_text("{\"a\": NaN}"), StartsWith("bad.json: line 1, column 7: "));
  EXPECT_THAT(complaint_about_text("{\"a\": 1} x"), StartsWith("bad.json: line 1, column 10: "));
  EXPECT_THAT(complaint_about_text("{} // no comments"),
              StartsWith("bad.json: line 1, column 4: "));
  EXPECT_THAT(complaint_about_text("{\"\xFF\": 1}"), HasSubstr("ill-formed UTF-8"));
}

TEST(BadText, EmptyIsCalledEmpty) {
  for (const char* text : {"", " ", "\n\t \r\n"}) {
    EXPECT_EQ(complaint_about_text(text), "bad.json: is empty; a problem file is a JSON object");
  }
}

TEST(BadText, NumbersOutOfRangeTellLineAndColumn) {
  EXPECT_EQ(complaint_about_text("{\n\"a\": 1e400}"),
            "bad.json: line 2, column 10: number overflow parsing '1e400'");
}

TEST(BadText, KeysThatAreThereTwiceAreRefused) {
  EXPECT_EQ(complaint_about_text(R"({"scene": {"x": [0, {"a/b": 1, "c": 2, "a/b": 1}]}})"),
            "bad.json: /scene/x/1/a~1b is there twice");
  EXPECT_EQ(complaint_about_text(R"({"scene": 1, "scene": 1})"), "bad.json: /scene is there twice");
}

TEST(BadText, NestedTooDeeplyIsRefusedWithoutOverflow) {
  EXPECT_THAT(complaint_about_text(std::string(1000000, '[')),
              HasSubstr("is nested deeper than 64 levels"));
  std::string objects;
  for (int i = 0; i < 100000; ++i) objects += "{\"a\":";
  EXPECT_THAT(complaint_about_text(objects), HasSubstr("is nested deeper than 64 levels"));
}

TEST(BadText, OtherThanAnObjectIsRefused) {
  EXPECT_EQ(complaint_about_text("[]"), "bad.json: the problem must be an object {…}, got []");
  EXPECT_EQ(complaint_about_text("null"), "bad.json: the problem must be an object {…}, got null");
  EXPECT_EQ(complaint_about_text("{}"), "bad.json: the problem is missing the key \"scene\"");
}

TEST(BadText, LongValuesAreShortenedBetweenCharacters) {
  Json document = good_json();
  std::string umlauts;
  for (int i = 0; i < 500; ++i) umlauts += "\xC3\xA4";
  document["scene"]["bodies"]["rod"]["frame"] = umlauts;
  const std::string message = complaint(document);
  EXPECT_LT(message.size(), 160U);
  EXPECT_NO_THROW(Json(message).dump());  // would complain about half a character
}

std::string complaint_about_file(const std::filesystem::path& path) {
  try {
    read_problem(path);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(BadFile, MissingIsCalledMissing) {
  EXPECT_EQ(complaint_about_file("no_such_file.json"), "no_such_file.json: there is no such file");
  EXPECT_EQ(complaint_about_file(""), ": there is no such file");
}

TEST(BadFile, DirectoryIsCalledDirectory) {
  const std::string directory = testing::TempDir();
  EXPECT_EQ(complaint_about_file(directory), directory + ": is a directory, not a problem file");
}

TEST(File, IsReadLikeItsTextAndGivesItsNameToAProblemWithout) {
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "my_problem.json";
  Json document = good_json();
  document.erase("name");
  std::ofstream(path) << document.dump();
  EXPECT_EQ(read_problem(path, {"/simulation/step=1e-3"}).name, "my_problem");
  EXPECT_EQ(read_problem(path, {"/simulation/step=1e-3"}).simulation.step, 1e-3);
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace pleuel::test
