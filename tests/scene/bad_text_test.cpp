#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string_view>

#include "core/base/error.hpp"
#include "core/scene/material_library.hpp"
#include "core/scene/problem_reader.hpp"
#include "core/scene/reading/mistakes.hpp"
#include "core/scene/reading/other_names.hpp"
#include "core/scene/reading/suggestion.hpp"
#include "tests/scene/good_problem.hpp"
#include "tests/support/files.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::bad_text_test {
namespace {

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

TEST(BadText, SyntaxErrorsShowThePlaceInItsLine) {
  EXPECT_EQ(
      complaint_about_text("{\n  \"scene\": {],\n}"),
      "bad.json: line 2, column 13: this \"]\" stands where the \"{\" of line 2 has to be closed "
      "by \"}\"\n"
      "  2 |   \"scene\": {],\n"
      "    |             ^");
  EXPECT_THAT(complaint_about_text("{\"a\": 1} x"), StartsWith("bad.json: line 1, column 10: "));
  EXPECT_THAT(complaint_about_text("{\"\xFF\": 1}"), HasSubstr("is no UTF-8"));
}

/// What people write in place of JSON: where it stands (line:column, counted by hand), and a word of
/// the cause.
TEST(BadText, SyntaxErrorsTellTheLikelyCause) {
  struct Slip {
    const char *text, *place, *cause;
  };
  const Slip slips[] = {
      {"{\"a\": 1,}", "line 1, column 8", "the comma before this \"}\" is too many"},
      {"{\"a\": [1, 2,\n]}", "line 1, column 12", "the comma before this \"]\" is too many"},
      {"{\"a\": 1,, \"b\": 2}", "line 1, column 9", "this comma is too many"},
      {"{\"a\": 1\n \"b\": 2}", "line 1, column 8", "a comma is missing here"},
      {"{\"a\": [1 2]}", "line 1, column 9", "a comma is missing here"},
      {"{\"a\": {} \"b\": 2}", "line 1, column 9", "a comma is missing here"},
      {"{} // no comments", "line 1, column 4", "JSON has no comments"},
      {"{\"a\": 1, # one\n\"b\": 2}", "line 1, column 10", "\"$comment\""},
      {"{'a': 1}", "line 1, column 2", "double quotes"},
      {"{\"a\": 'x'}", "line 1, column 7", "double quotes"},
      {"{\"a\": \u201Cx\u201D}", "line 1, column 7", "typographic"},
      {"{a: 1}", "line 1, column 2", "names stand in double quotes"},
      {"{\"a\": 0,5}", "line 1, column 8", "decimal point, no comma"},
      {"{\"a\": 10 mm}", "line 1, column 7", "\"10 mm\""},
      {"{\"a\": 10mm}", "line 1, column 7", "\"10 mm\""},
      {"{\"a\": .5}", "line 1, column 7", "before the point"},
      {"{\"a\": 5.}", "line 1, column 8", "behind the point"},
      {"{\"a\": 007}", "line 1, column 7", "do not begin with zeros"},
      {"{\"a\": +7}", "line 1, column 7", "no plus sign"},
      {"{\"a\": nan}", "line 1, column 7", "numbers are finite"},
      {"{\"a\": True}", "line 1, column 7", "true, false and null"},
      {"{\"a\": }", "line 1, column 7", "a value is missing"},
      {"{\"a\" 1}", "line 1, column 5", "a colon is missing"},
      {"{\"a\" = 1}", "line 1, column 6", "a colon is missing"},
      {"{\"a\": [\"b\": 1]}", "line 1, column 11", "a list"},
      {"{\"a\": \"b}", "line 1, column 7", "this text is not closed"},
      {"{\"a\": \"b\n\"}", "line 1, column 7", "this text is not closed"},
      {"{\"a\": \"C:\\data\"}", "line 1, column 10", "backslash"},
      {"{\"a\": {\"b\": 1}", "line 1, column 15", "the \"{\" of line 1 is not closed"},
      {"{\"a\": 1}}", "line 1, column 9", "one too many"},
  };
  for (const Slip& slip : slips) {
    const std::string message = complaint_about_text(slip.text);
    EXPECT_THAT(message, StartsWith(std::string("bad.json: ") + slip.place + ": ")) << slip.text;
    EXPECT_THAT(message, HasSubstr(slip.cause)) << slip.text;
    // The caret stands below the place: as far behind the bar as the column says.
    const std::size_t bar = message.rfind("| ");
    const auto column = std::stoul(std::string(slip.place).substr(15));
    EXPECT_EQ(message.find('^') - bar - 1, column) << message;
  }
}

/// A decimal comma in a text with unit is told from a separator of thousands.
TEST(BadText, QuantitiesHaveADecimalPoint) {
  const auto complaint_about_step = [](const std::string& step) {
    Json document = good_json();
    document["simulation"]["step"] = step;
    return complaint(document);
  };
  EXPECT_THAT(complaint_about_step("10,5 ms"), HasSubstr("write 10.5 ms"));
  EXPECT_THAT(complaint_about_step("0,125 ms"), HasSubstr("write 0.125 ms"));
  EXPECT_THAT(complaint_about_step("1,000 ms"), HasSubstr("write 1.000 ms or 1000 ms"));
}

/// What a terminal would obey is not shown; lines that are very long are shown around the place.
TEST(BadText, LinesOfSyntaxErrorsAreSafeToShow) {
  const std::string message =
      complaint_about_text("{\"a\u202e\x1B[2J\xC2\x9B\": " + std::string(500, ' ') + "x}");
  EXPECT_EQ(message.find('\x1B'), std::string::npos);
  EXPECT_EQ(message.find("\xC2\x9B"), std::string::npos);
  EXPECT_EQ(message.find("\u202e"), std::string::npos);
  EXPECT_LT(message.size(), 400U);
}

TEST(BadText, EmptyIsCalledEmpty) {
  for (const char* text : {"", " ", "\n\t \r\n"}) {
    EXPECT_EQ(complaint_about_text(text), "bad.json: is empty; a problem file is a JSON object");
  }
}

TEST(BadText, NumbersOutOfRangeTellLineAndColumn) {
  EXPECT_EQ(complaint_about_text("{\n\"a\": 1e400}"),
            "bad.json: line 2, column 10: '1e400' is a larger number than there is\n"
            "  2 | \"a\": 1e400}\n"
            "    |          ^");
}

TEST(BadText, KeysThatAreThereTwiceAreRefused) {
  EXPECT_EQ(complaint_about_text(R"({"scene": {"x": [0, {"a/b": 1, "c": 2, "a/b": 1}]}})"),
            "bad.json: /scene/x/1/a~1b is there twice");
  EXPECT_EQ(complaint_about_text(R"({"scene": 1, "scene": 1})"), "bad.json: /scene is there twice");
}

/// A terminal obeys them: escape (C0), delete, and the control sequence introducer of C1.
TEST(BadText, ControlCharactersAreRefusedInNamesAndTexts) {
  for (const char* character : {"\\u001b", "\\u0000", "\\u0007", "\x7F", "\xC2\x9B", "\\u009b"}) {
    const std::string name = std::string("a") + character + "[2Jb";
    EXPECT_EQ(complaint_about_text(R"({"scene": {"bodies": {")" + name + R"(": 1}}})"),
              "bad.json: a name in /scene/bodies has a control character, which no name may have");
    EXPECT_EQ(complaint_about_text(R"({")" + name + R"(": 1})"),
              "bad.json: a name in the document has a control character, which no name may have");
    EXPECT_EQ(complaint_about_text(R"({"list": [1, {"name": ")" + name + R"("}]})"),
              "bad.json: the text of /list/1/name has a control character; of those texts may have "
              "tabs and line breaks");
  }
  // What turns the direction of writing (U+202E, U+2066, …) and separators of lines count as such.
  for (const char* character : {"\\u202e", "\\u202a", "\xE2\x81\xA6", "\\u2069", "\\u2028"}) {
    EXPECT_EQ(complaint_about_text(R"({"scene": {"bodies": {"a)" + std::string(character) +
                                   R"(b": 1}}})"),
              "bad.json: a name in /scene/bodies has a control character, which no name may have");
  }
  EXPECT_EQ(complaint_about_text(R"({"a\nb": 1})"),
            "bad.json: a name in the document has a control character, which no name may have");
  // Characters beside them are none: space, ~, the no-break space of U+00A0, ä, U+2027, U+202F.
  for (const char* text : {" ~", "\xC2\xA0", "\xC3\xA4", "\xE2\x80\xA7", "\xE2\x80\xAF"}) {
    Json document = good_json();
    document["name"] = text;
    document["description"] = "two\nlines,\ttabbed";
    EXPECT_EQ(read(document).name, text);
  }
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
  EXPECT_EQ(complaint_about_text("{}"),
            "2 mistakes:\nbad.json: the problem is missing the key \"scene\"\n"
            "bad.json: the problem is missing the key \"simulation\"");
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

TEST(BadText, WithManyMembersIsRefusedInTimeProportionalToItsSize) {
  std::string text = "{\"scene\": {";
  for (int i = 0; i < 200000; ++i) text += "\"" + std::to_string(i) + "\": 0, ";
  EXPECT_THAT(complaint_about_text(text + "\"end\": 0}}"),  // takes minutes if it is quadratic
              StartsWith("2 mistakes:\nbad.json: /scene has the unknown key \"0\""));
}

TEST(BadText, OfAMechanismTruncatedAnywhereIsRefusedByAMessage) {
  const std::string text = good_mechanism().dump();
  for (std::size_t size = 0; size < text.size(); size += 7) {
    EXPECT_THAT(complaint_about_text(text.substr(0, size)), StartsWith("bad.json: "))
        << "after " << size << " bytes";
  }
}

/// Calls back with every value below, and the pointer to it.
void for_each_place(const Json& value, const std::string& pointer,
                    const std::function<void(const std::string&)>& visit) {
  if (!pointer.empty()) visit(pointer);
  if (value.is_array()) {
    for (std::size_t i = 0; i < value.size(); ++i) {
      for_each_place(value[i], pointer + "/" + std::to_string(i), visit);
    }
  } else if (value.is_object()) {
    for (const auto& [key, member] : value.items()) {
      for_each_place(member, pointer + "/" + key, visit);
    }
  }
}

// Every reading takes some ms for the units: one value at every third place.

TEST(BadValue, AnywhereInAMechanismIsReadOrRefusedByAMessage) {
  const Json good = good_mechanism();
  const std::vector<std::string> values = {"[]",     "{}",   "\"\"",      "0",
                                           "-1e308", "true", "\"nan m\"", "remove"};
  std::size_t places = 0;
  for_each_place(good, "", [&](const std::string& pointer) {
    if (places++ % 3 != 0) return;
    const std::string& value = values[places % values.size()];
    EXPECT_NO_THROW(complaint(edited(good, pointer, value))) << pointer << " = " << value;
  });
}

TEST(BadValue, OfNoKindIsRefusedEverywhereInAMechanism) {
  const Json good = good_mechanism();
  for_each_place(good, "", [&good](const std::string& pointer) {
    EXPECT_NE(complaint(edited(good, pointer, "null")), "") << pointer;
  });
}

std::string complaint_about_file(const std::filesystem::path& path) {
  return thrown<InputError>([&] { read_problem(path).complete(); });
}

TEST(BadFile, MissingIsCalledMissing) {
  EXPECT_EQ(complaint_about_file("no_such_file.json"), "no_such_file.json: there is no such file");
  EXPECT_EQ(complaint_about_file(""), ": there is no such file");
}

TEST(BadFile, DirectoryIsCalledDirectory) {
  const std::string directory = testing::TempDir();
  EXPECT_EQ(complaint_about_file(directory), directory + ": is a directory, not a problem file");
}

TEST(BadFile, InAnotherEncodingIsToldSo) {
  const std::string path = testing::TempDir() + "utf16.json";
  std::ofstream(path) << std::string("\xFF\xFE{\0}\0", 6);
  EXPECT_THAT(complaint_about_file(path), HasSubstr("save it as UTF-8"));
}

TEST(BadFile, WithoutEndIsRefused) {
  const std::filesystem::path endless = "/dev/zero";
  EXPECT_EQ(complaint_about_file(endless), "/dev/zero: is no ordinary file");
}

TEST(File, IsReadLikeItsTextAndGivesItsNameToAProblemWithout) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "my_problem.json";
  Json document = good_json();
  document.erase("name");
  std::ofstream(path) << document.dump();
  EXPECT_EQ(read_problem(path, {"/simulation/step=1e-3"}).complete().name, "my_problem");
  EXPECT_EQ(read_problem(path, {"/simulation/step=1e-3"}).complete().simulation.step, 1e-3);
}

std::vector<std::string> mistakes(const Json& document) {
  try {
    read(document);
  } catch (const InputError& error) {
    return mistakes_of(error);
  }
  return {};
}

TEST(Mistakes, OfOneSectionAreToldAtOnce) {
  Json document = good_json();
  document["scene"]["bodies"]["crank"]["elements"] = 0;
  document["scene"]["bodies"]["slider"]["mass"] = -1;
  document["scene"]["joints"]["pin"]["bodies"][1] = "rood";
  document["simulation"]["step"] = "1 kg";
  EXPECT_THAT(
      mistakes(document),
      ElementsAre(HasSubstr("/scene/bodies/crank/elements"), HasSubstr("/scene/bodies/slider/mass"),
                  HasSubstr("/scene/joints/pin/bodies/1"), HasSubstr("/simulation/step")));
  EXPECT_THAT(complaint(document), StartsWith("4 mistakes:\nbad.json: /scene/bodies/crank"));
}

TEST(Mistakes, OfResponsesAndConstraintsAreToldAtOnce) {
  Json document = good_json();
  document["responses"]["stress"]["body"] = "slider";
  document["responses"]["bow"]["direction"] = "w";
  EXPECT_THAT(mistakes(document), ElementsAre(HasSubstr("/responses/stress/body"),
                                              HasSubstr("/responses/bow/direction")));
  document = good_json();
  document["objective"]["minimize"] = "wait";
  document["constraints"]["strength"]["upper"] = "200 MPas";
  document["constraints"]["stiffness"]["response"] = "bough";
  EXPECT_THAT(mistakes(document), ElementsAre(HasSubstr("/objective/minimize"),
                                              HasSubstr("/constraints/strength/upper"),
                                              HasSubstr("/constraints/stiffness/response")));
}

TEST(Mistakes, OfVariablesAndOfSettingsAreToldAtOnce) {
  Json document = good_json();
  document["variables"]["width"]["lower"] = "4 kg";
  document["variables"]["load"]["upper"] = "1 m";
  EXPECT_THAT(mistakes(document),
              ElementsAre(HasSubstr("/variables/width/lower"), HasSubstr("/variables/load/upper")));
  document = good_json();
  document["optimizer"]["starts"] = 0;
  document["accuracy"]["target"] = -1;
  EXPECT_THAT(mistakes(document),
              ElementsAre(HasSubstr("/optimizer/starts"), HasSubstr("/accuracy/target")));
}

/// A body that cannot be read is still one that joints may name, and responses are not asked of it.
TEST(Mistakes, ThatFollowFromAnotherAreNotTold) {
  Json document = good_json();
  document["scene"]["bodies"]["rod"]["material"] = "stel";
  document["scene"]["bodies"]["crank"]["elements"] = 0;
  EXPECT_THAT(mistakes(document), ElementsAre(HasSubstr("/scene/bodies/crank/elements"),
                                              HasSubstr("/scene/bodies/rod/material")));
}

TEST(Mistakes, OfOneCaseAreToldWithItsName) {
  Json document = good_json();
  document["scene"]["bodies"]["crank"]["elements"] = 0;
  document["cases"] = {{"fast", {{"/simulation/step", "1 kg"}}}, {"slow", Json::object()}};
  EXPECT_THAT(
      mistakes(document),
      ElementsAre(AllOf(HasSubstr("/scene/bodies/crank/elements"), Not(HasSubstr("in the case"))),
                  AllOf(HasSubstr("/simulation/step"), HasSubstr("in the case \"fast\""))));
}

TEST(Mistakes, AreCountedWhereThereAreMany) {
  const std::vector<std::string> texts(20, "a mistake");
  const Mistakes error(texts);
  EXPECT_THAT(error.what(), StartsWith("20 mistakes:\na mistake\n"));
  EXPECT_THAT(error.what(), EndsWith("\n… and 8 more"));
}

TEST(EditDistance, CountsInsertionsDeletionsReplacementsAndSwaps) {
  EXPECT_EQ(edit_distance("steel", "steel"), 0U);
  EXPECT_EQ(edit_distance("stel", "steel"), 1U);
  EXPECT_EQ(edit_distance("steeel", "steel"), 1U);
  EXPECT_EQ(edit_distance("steel", "steal"), 1U);
  EXPECT_EQ(edit_distance("setel", "steel"), 1U);
  EXPECT_EQ(edit_distance("", "steel"), 5U);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);  // the textbook example
}

TEST(EditDistance, IsSymmetric) {
  EXPECT_EQ(edit_distance("thickness", "thicknes"), edit_distance("thicknes", "thickness"));
  EXPECT_EQ(edit_distance("sitting", "kitten"), 3U);
}

TEST(Suggestion, IsTheNearestOfTheNearWords) {
  EXPECT_EQ(closest("diamter", {"type", "diameter", "outer_diameter"}), "diameter");
  EXPECT_EQ(closest("rod_2", {"rod_10", "rod_21", "crank"}), "rod_21");
}

TEST(Suggestion, IsWhatOthersCallSo) {
  EXPECT_EQ(meant_by("E", {"young", "poisson", "density"}), "young");
  EXPECT_EQ(meant_by("rho", {"young", "poisson", "density"}), "density");
  EXPECT_EQ(meant_by("hinge", {"fixed", "prismatic", "revolute"}), "revolute");
  EXPECT_EQ(meant_by("aluminum", {"steel", "aluminium-6082-T6"}), "aluminium-6082-T6");
  EXPECT_EQ(meant_by("STEEL", {"steel", "pom"}), "steel");
  EXPECT_EQ(meant_by("von_mises", {"mass", "stress"}), "stress");
  EXPECT_EQ(meant_by("hinge", {"mass", "stress"}), "");
  EXPECT_EQ(meant_by("diamter", {"type", "diameter"}), "diameter");
  EXPECT_EQ(closest("hinge", {"fixed", "prismatic", "revolute"}), "");
  EXPECT_EQ(meant_by("yields", {"height", "width"}), "");
}

/// Names that other_names.hpp leads to are words of the schema or of the materials.
TEST(Suggestion, LeadsToWordsThatThereAre) {
  std::ifstream stream(source_folder() + "/problems/problem.schema.json");
  const std::string schema{std::istreambuf_iterator<char>(stream), {}};
  ASSERT_FALSE(schema.empty());
  const std::vector<Material> library = material_library();
  for (const auto& row : other_names) {
    const std::string_view name = row.second;
    const bool is_material =
        std::any_of(library.begin(), library.end(),
                    [&](const Material& material) { return material.name.starts_with(name); });
    const bool is_word = schema.find(fmt::format("\"{}\"", name)) != std::string::npos;
    EXPECT_TRUE(is_material || is_word) << name;
  }
}

TEST(Suggestion, IsAbsentForWordsThatHaveNothingInCommon) {
  EXPECT_EQ(closest("colour", {"type", "diameter"}), "");
  EXPECT_EQ(closest("a", {"b"}), "");
  EXPECT_EQ(closest("x", {}), "");
}

TEST(Suggestion, IsAbsentForAWordOfAbsurdLength) {
  EXPECT_EQ(closest(std::string(100000, 'x'), {std::string(100001, 'x')}), "");
}

TEST(Hint, NamesTheKnownWordsIfNoneIsNear) {
  EXPECT_EQ(hint("colour", {"type", "width", "height"}),
            "; known are \"type\", \"width\" and \"height\"");
  EXPECT_EQ(hint("colour", {"type"}), "; known is \"type\"");
  EXPECT_EQ(hint("colour", {}), "; there are none");
}

}  // namespace
}  // namespace pleuel::test::bad_text_test
