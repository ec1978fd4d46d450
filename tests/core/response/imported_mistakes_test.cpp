#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "core/scene/invariants_file.hpp"
#include "tests/core/response/exchange.hpp"

/// What is said of bad files, and of what a file cannot do.
namespace pleuel::test::imported_mistakes_test {
namespace {

using testing::HasSubstr;

/// What is wrong with a file, after one edit of a good one.
struct BadFile {
  const char* pointer;
  const char* value;  ///< "remove" removes it
  const char* complaint;
};

TEST_F(Exchange, SaysWhatIsWrongWithAFile) {
  const Json document = exchanged(slider_crank());
  const Json good = Json::parse(text());
  const BadFile cases[] = {
      {"/format", "\"other\"", "/format must be \"pleuel-invariants\", got \"other\""},
      {"/version", "2", "/version must be 1"},
      {"/units", "\"mm\"", "/units must be \"SI\", got \"mm\""},
      {"/colour", "1", "has the unknown key \"colour\""},
      {"/invariants/mass", "-1", "/invariants/mass must be positive [kg], got -1"},
      {"/invariants/mass", "remove", "/invariants is missing the key \"mass\""},
      {"/invariants/first_moment", "[0, 0]", "/invariants/first_moment must be a list of 3 values"},
      {"/invariants/first_moment/0", "1",
       "/invariants/second_moment must be at least first_moment first_momentᵀ / mass"},
      {"/invariants/stiffness/0/0", "99",
       "/invariants/stiffness/0/0 must be a whole number from 0"},
      {"/invariants/stiffness/1", "[0, 0, 1.0]",
       "/invariants/stiffness/1 is a second entry in row 0, column 0"},
      {"/invariants/stiffness/1/2", "7.0", "/invariants/stiffness must be symmetric"},
      {"/invariants/stiffness", "[]", "/invariants/stiffness must be positive definite"},
      {"/invariants/moment_yy", "[]", "/invariants must have \"mass_matrix\" = \"moment_xx\" +"},
      {"/places/crank_pin/position", "[0.18, 0, 0]",
       "/places/slider_pin is where the place \"crank_pin\" is"},
      {"/stress/of_coordinates/0/2", "\"1\"", "/stress/of_coordinates/0/2 must be a number"},
      {"/stiffening/elements/0/slopes/0/1", "9.0",
       "/stiffening/elements/0/slopes must be symmetric"},
      {"/stiffening/elements/0/axial_stiffness", "0.0",
       "/stiffening/elements/0/axial_stiffness must be positive [N/m]"},
      {"/derivatives/rod_width/invariants/moment_yy", "[]",
       "/derivatives/rod_width/invariants must have \"mass_matrix\""},
      {"/derivatives/width", "{}", "/derivatives/width must have a value in /design"},
      {"/design/rod_width/unit", "\"mm\"", "has the unit \"mm\", which is no SI unit"},
  };
  for (const BadFile& bad : cases) {
    Json edited = good;
    const Json::json_pointer place(bad.pointer);
    if (std::string(bad.value) == "remove") {
      edited.at(place.parent_pointer()).erase(place.back());
    } else {
      edited[place] = Json::parse(bad.value);
    }
    write(edited.dump());
    const std::string found = complaint(document);
    EXPECT_THAT(found, HasSubstr(bad.complaint)) << bad.pointer;
    EXPECT_THAT(found, HasSubstr("rod.json")) << bad.pointer;
  }
}

TEST_F(Exchange, SaysWhatAFileCannotDo) {
  const Json document = exchanged(slider_crank());
  const std::vector<std::array<const char*, 3>> cases = {
      {"/scene/bodies/rod/file", "\"none.json\"", "/scene/bodies/rod/file must name a file"},
      {"/scene/bodies/rod/elements", "6", "/scene/bodies/rod has the unknown key \"elements\""},
      {"/scene/loads/tug/at", "[0.207, 0, 0]",
       "/scene/loads/tug/at must be at a place of the body \"rod\""},
      {"/responses/bow/at", "\"bwo\"",
       "/responses/bow/at names the unknown place \"bwo\"; did you mean \"bow\""},
      {"/responses/bow/against", "\"chord\"", "/responses/bow is missing the key \"chord\""},
      {"/responses/bow/chord", R"(["bow", "tug"])",
       "/responses/bow/chord is for imported bodies with \"against\": \"chord\""},
      {"/responses/rod_pull/part", "\"bending\"", "/responses/rod_pull/part must be"},
      {"/effects/rotary_inertia", "\"off\"", "from which nothing can be left out"},
  };
  for (const auto& [pointer, value, expected] : cases) {
    Json edited = document;
    edited[Json::json_pointer(pointer)] = Json::parse(value);
    EXPECT_THAT(complaint(edited), HasSubstr(expected));
  }
  InvariantsFile file = read_invariants(folder_.path() / "rod.json");
  file.constants.stress.reset();
  file.constants.stretching.reset();
  for (ConstantsDerivative& of : file.design) of.derivative.reset();
  file.design.clear();
  write(write_invariants(file));
  Json edited = document;
  edited["variables"].erase("rod_width");
  edited["variables"].erase("rod_height");
  EXPECT_THAT(complaint(edited), HasSubstr("has no block \"stress\""));
  for (const char* name : {"rod_stress", "rod_pull", "rod_use", "mean_stress"}) {
    edited["responses"].erase(name);
  }
  EXPECT_THAT(complaint(edited), HasSubstr("has no block \"stiffening\""));
  edited["effects"]["geometric_stiffening"] = "auto";
  EXPECT_EQ(complaint(edited), "");
}

}  // namespace
}  // namespace pleuel::test::imported_mistakes_test
