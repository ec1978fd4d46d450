#include <fstream>
#include <ostream>

#include "core/base/error.hpp"
#include "core/scene/problem_reader.hpp"
#include "tests/scene/good_problem.hpp"
#include "tests/support/files.hpp"
#include "tests/support/parameter_name.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::bad_section_test {
namespace {

/// A section or a material of the good problem's crank, and what the reader must say of it after
/// "bad.json: /scene/bodies/crank/section".
struct BadSection {
  std::string section;
  std::string message;
};

void PrintTo(const BadSection& bad, std::ostream* stream) {
  *stream << bad.section;
}

/// The good problem with another section of the crank, and without what names the variable that
/// the old one used.
Json with_section(const std::string& section) {
  Json document = edited("/scene/bodies/crank/section", section);
  document["variables"].erase("width");
  document["constraints"].erase("slender");
  return document;
}

class BadSectionOf : public testing::TestWithParam<BadSection> {};

TEST_P(BadSectionOf, IsRefusedWithPlaceValueAndRule) {
  EXPECT_EQ(complaint(with_section(GetParam().section)),
            "bad.json: /scene/bodies/crank/section" + GetParam().message);
}

/// A general section with one value replaced.
std::string general(const std::string& key, const std::string& value) {
  Json section = Json::parse(
      R"({"type": "general", "area": 1e-4, "inertia_y": "1 cm^4", "inertia_z": 2e-8,
          "torsion": 1e-8, "points": [{"y": 0.01, "z": "5 mm", "shear": "1 1/cm^3"}]})");
  if (value == "remove") {
    section.erase(key);
  } else {
    section[Json::json_pointer("/" + key)] = Json::parse(value);
  }
  return section.dump();
}

INSTANTIATE_TEST_SUITE_P(
    Keys, BadSectionOf,
    testing::Values(
        BadSection{
            R"({"type": "hexagon"})",
            R"(/type must be "rectangle", "circle", "tube", "ellipse", "box", "i" or "general", got "hexagon")"},
        BadSection{R"({"type": "elipse", "width": 1, "height": 1})",
                   R"(/type must be "rectangle", "circle", "tube", "ellipse", "box", "i" or )"
                   R"("general", got "elipse"; did you mean "ellipse"?)"},
        BadSection{R"({"type": "ellipse", "width": 0.01})", R"( is missing the key "height")"},
        BadSection{R"({"type": "ellipse", "width": 0.01, "height": 0.02, "thickness": 0.001})",
                   R"( has the unknown key "thickness"; known are "type", "width" and "height")"},
        BadSection{R"({"type": "box", "width": 0.01, "height": 0.02})",
                   R"( is missing the key "thickness")"},
        BadSection{R"({"type": "box", "width": 0.01, "height": 0.02, "thicknes": 0.001})",
                   R"( has the unknown key "thicknes"; did you mean "thickness"?)"},
        BadSection{R"({"type": "i", "width": 0.01, "height": 0.02, "web_thickness": 0.001})",
                   R"( is missing the key "flange_thickness")"},
        BadSection{general("points", "remove"), R"( is missing the key "points")"},
        BadSection{general("points", "[]"), "/points must have at least one point"},
        BadSection{general("points", "3"), "/points must be a list […], got 3"},
        BadSection{general("points/0", "[0, 0, 0]"),
                   "/points/0 must be an object {…}, got [0,0,0]"},
        BadSection{general("points/0", R"({"y": 0, "z": 0})"),
                   R"(/points/0 is missing the key "shear")"},
        BadSection{general("torsion", "remove"), R"( is missing the key "torsion")"},
        BadSection{general("shear_area_z", "1e-5"),
                   R"( has "shear_area_z" without "shear_area_y")"}),
    named_by(&BadSection::section));

INSTANTIATE_TEST_SUITE_P(
    Values, BadSectionOf,
    testing::Values(
        BadSection{R"({"type": "ellipse", "width": 0, "height": 0.02})",
                   "/width must be positive [m], got 0"},
        BadSection{R"({"type": "ellipse", "width": "1 kg", "height": 0.02})",
                   R"(/width must be a length [m], got "1 kg": "kg" measures something else)"},
        BadSection{R"({"type": "box", "width": 0.01, "height": 0.02, "thickness": "nan mm"})",
                   R"(/thickness must be a length [m], got "nan mm": it does not begin with a )"
                   "number"},
        BadSection{general("area", "-1"), "/area must be positive [m^2], got -1"},
        BadSection{general("area", R"("3 mm")"),
                   R"(/area must be an area [m^2], got "3 mm": "mm" measures something else)"},
        BadSection{general("inertia_y", "0"), "/inertia_y must be positive [m^4], got 0"},
        BadSection{general("torsion", "true"),
                   "/torsion must be a second moment of area [m^4]: a number in SI units, a text "
                   R"(with unit, a formula "= …" or {"variable": name}, got true)"},
        BadSection{general("points/0/shear", "-1"),
                   "/points/0/shear must not be negative [1/m^3], got -1"},
        BadSection{general("points/0/y", R"({"variable": "diameter"})"),
                   "/points/0/y must be a length [m]: a number in SI units, a text with unit or a "
                   "formula, "
                   R"(got {"variable":"diameter"})"},
        BadSection{R"({"type": "box", "width": 0.01, "height": 0.02, "thickness": "5.1 mm"})",
                   "/thickness must not exceed half the width 0.005 [m] of the box, got 0.0051"},
        BadSection{R"({"type": "box", "width": 0.02, "height": 0.01, "thickness": "5.1 mm"})",
                   "/thickness must not exceed half the height 0.005 [m] of the box, got 0.0051"},
        BadSection{
            R"({"type": "i", "width": 0.1, "height": 0.02, "flange_thickness": 0.011, "web_thickness": 0.01})",
            "/flange_thickness must not exceed half the height 0.01 [m], got 0.011"},
        BadSection{
            R"({"type": "i", "width": 0.02, "height": 0.1, "flange_thickness": 0.011, "web_thickness": 0.021})",
            "/web_thickness must not exceed the width 0.02 [m], got 0.021"},
        BadSection{
            R"({"type": "i", "width": 0.1, "height": 0.1, "flange_thickness": 0.002, "web_thickness": 0.0061})",
            "/web_thickness must not exceed three times the flange thickness 0.006 [m], got "
            "0.0061"}),
    named_by(&BadSection::section));

/// Walls may be as thick as they can be, and a rounded half is a half.
TEST(GoodSection, MayHaveTheThickestWalls) {
  EXPECT_EQ(complaint(with_section(
                R"({"type": "box", "width": "10 mm", "height": 0.02, "thickness": "5 mm"})")),
            "");
  EXPECT_EQ(
      complaint(with_section(
          R"({"type": "i", "width": "3 cm", "height": 0.1, "flange_thickness": "1 cm", "web_thickness": "30 mm"})")),
      "");
}

TEST(BadMaterial, StrengthMustBeAPositiveStress) {
  EXPECT_EQ(complaint(edited("/scene/materials/steel/strength", "0")),
            "bad.json: /scene/materials/steel/strength must be positive [Pa], got 0");
  EXPECT_EQ(complaint(edited("/scene/materials/steel/strength", R"("355 N")")),
            "bad.json: /scene/materials/steel/strength must be a stress [Pa], got \"355 N\": "
            "\"N\" measures something else");
}

TEST(BadMaterial, SuggestsThoseOfTheLibrary) {
  EXPECT_EQ(complaint(edited("/scene/bodies/crank/material", R"("titanium-Ti6AlV4")")),
            "bad.json: /scene/bodies/crank/material names the unknown material "
            "\"titanium-Ti6AlV4\"; did you mean \"titanium-Ti6Al4V\"?");
  const std::string all = complaint(edited("/scene/bodies/crank/material", R"("wood")"));
  for (const char* name : {"steel", "alloy", "pom", "stainless-steel", "cfrp-quasi-isotropic"}) {
    EXPECT_NE(all.find("\"" + std::string(name) + "\""), std::string::npos) << name;
  }
}

/// A folder with a catalogue beside a problem whose crank takes its section from it.
class BadCatalogue : public testing::Test {
 protected:
  const TemporaryFolder temporary_;
  const std::filesystem::path& folder_ = temporary_.path();

  /// What is said of the problem, with the folder taken out.
  std::string complaint_with(const std::string& catalogue, const std::string& section) {
    std::ofstream(folder_ / "sizes.json") << catalogue;
    Json document = with_section(section);
    document["scene"]["catalogue"] = "sizes.json";
    std::ofstream(folder_ / "bad.json") << document.dump();
    std::string text = thrown<InputError>([&] { read_problem(folder_ / "bad.json").complete(); });
    const std::string prefix = folder_.string() + "/";
    if (text.starts_with(prefix)) text.erase(0, prefix.size());
    return text;
  }
  std::string complaint_about(const std::string& catalogue) {
    return complaint_with(catalogue, R"({"type": "circle", "diameter": 0.01})");
  }
};

constexpr const char* good_catalogue =
    R"({"sections": {"round 10": {"type": "circle", "diameter": "10 mm"},
                     "round 12": {"type": "circle", "diameter": "12 mm"}}})";

TEST_F(BadCatalogue, GoodOneIsNotRefused) {
  EXPECT_EQ(complaint_with(good_catalogue, R"({"catalogue": "round 12"})"), "");
}

TEST_F(BadCatalogue, UnknownNameIsAnsweredWithASuggestion) {
  EXPECT_EQ(complaint_with(good_catalogue, R"({"catalogue": "rund 12"})"),
            "bad.json: /scene/bodies/crank/section/catalogue names the unknown section \"rund "
            "12\"; did you mean \"round 12\"?");
  EXPECT_EQ(complaint_with(good_catalogue, R"({"catalogue": "IPE 80"})"),
            "bad.json: /scene/bodies/crank/section/catalogue names the unknown section \"IPE "
            "80\"; known are \"round 10\" and \"round 12\"");
  EXPECT_EQ(complaint_with(R"({"sections": {}})", R"({"catalogue": "IPE 80"})"),
            "bad.json: /scene/bodies/crank/section/catalogue names the unknown section \"IPE "
            "80\"; there are none");
}

TEST_F(BadCatalogue, NameIsATextAndStandsAlone) {
  EXPECT_EQ(complaint_with(good_catalogue, R"({"catalogue": 12})"),
            "bad.json: /scene/bodies/crank/section/catalogue must be the name of a section: "
            "\"round 10\" or \"round 12\", got 12");
  EXPECT_EQ(complaint_with(good_catalogue, R"({"catalogue": "round 12", "diameter": 0.01})"),
            "bad.json: /scene/bodies/crank/section has the unknown key \"diameter\"; known is "
            "\"catalogue\"");
}

TEST_F(BadCatalogue, FaultIsReportedInTheCatalogue) {
  EXPECT_EQ(
      complaint_about("{"),
      "sizes.json: line 1, column 2: the text ends here, but the \"{\" of line 1 is not closed: "
      "\"}\" is missing\n"
      "  1 | {\n"
      "    |  ^");
  EXPECT_EQ(complaint_about("[]"), "sizes.json: the catalogue must be an object {…}, got []");
  EXPECT_EQ(complaint_about("{}"), R"(sizes.json: the catalogue is missing the key "sections")");
  EXPECT_EQ(complaint_about(R"({"sections": {}, "units": "mm"})"),
            R"(sizes.json: the catalogue has the unknown key "units"; known are "description" and )"
            R"("sections")");
  EXPECT_EQ(complaint_about(R"({"sections": []})"),
            "sizes.json: /sections must be an object {…}, got []");
  EXPECT_EQ(complaint_about(R"({"sections": {"a/b": {"type": "circle"}}})"),
            R"(sizes.json: /sections/a~1b is missing the key "diameter")");
  EXPECT_EQ(complaint_about(R"({"sections": {"a": {"type": "circle", "diameter": -1}}})"),
            "sizes.json: /sections/a/diameter must be positive [m], got -1");
  EXPECT_EQ(complaint_about(R"({"sections": {"a": {"catalogue": "b"}}})"),
            R"(sizes.json: /sections/a is missing the key "type")");
  EXPECT_EQ(
      complaint_about(
          R"({"sections": {"a": {"type": "tube", "outer_diameter": 0.02, "thickness": 0.011}}})"),
      "sizes.json: /sections/a/thickness must not exceed the radius 0.01 [m] of the tube, got "
      "0.011");
}

TEST_F(BadCatalogue, NothingInItIsDesignable) {
  EXPECT_EQ(complaint_about(
                R"({"sections": {"a": {"type": "circle", "diameter": {"variable": "diameter"}}}})"),
            "sizes.json: /sections/a/diameter cannot be bound to a design variable");
}

TEST(MissingCatalogue, IsSaidToBeMissing) {
  EXPECT_EQ(
      complaint(edited("/scene/catalogue", R"("no_such_file.json")")),
      "bad.json: /scene/catalogue names the file no_such_file.json, which is not there (names "
      "count from the folder of bad.json on)");
  EXPECT_EQ(complaint(edited("/scene/catalogue", "7")),
            "bad.json: /scene/catalogue must be a text in quotes, not empty, got 7");
  EXPECT_EQ(complaint(with_section(R"({"catalogue": "IPE 80"})")),
            "bad.json: /scene/bodies/crank/section needs a catalogue, but /scene names none: "
            "\"catalogue\": \"FILE\"");
}

}  // namespace
}  // namespace pleuel::test::bad_section_test
